// Options by id: each front end spells them as its users write them.
#pragma once

#include <string>
#include <string_view>

namespace aftershade {

#define AFTERSHADE_OPTIONS                                                                                   \
    allow_path, alpha, audit, checkpoint, color_space, compression, cryptomatte, deep, effect_path,          \
        history_out, jitter, keep_channels, layer, layers, list_nodes, max_image_bytes, missing, no_journal, \
        object, on_nan, output, output_roles, pass_timeout, pixel, pixel_type, plugin_memory, plugin_path,   \
        plugin_timeout, port, print_ffmpeg, profile, read_ahead, read_only, region, role, samples, scale,    \
        set, shading_rate, size, subframes, tap, telemetry, texture_size, truth, truth_only, verbose, view,  \
        visibility, visibility_on, warmup

enum class Option { AFTERSHADE_OPTIONS };

/// "color_space", as the enumerator is called.
std::string_view option_name(Option option);

/// How a front end says an option with a value; "" where its users have no such option.
using OptionSpeller = std::string (*)(Option option, std::string_view value);
/// At the start of main, before the first message. Without it options are said as the library's callers have
/// them.
void spell_options_by(OptionSpeller speller);

/// "--color-space" or "color_space".
std::string spelled(Option option, std::string_view value = "");
/// spelled() between two texts; "" where the front end has no such option, which is not a remedy then.
std::string advice(std::string_view before, Option option, std::string_view value, std::string_view after);

}  // namespace aftershade
