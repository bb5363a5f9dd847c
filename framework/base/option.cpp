#include "framework/base/option.h"

#include <map>
#include <vector>

#include "framework/base/text.h"

namespace aftershade {

namespace {

#define AFTERSHADE_TEXT(...) #__VA_ARGS__
#define AFTERSHADE_TEXT_OF(...) AFTERSHADE_TEXT(__VA_ARGS__)
constexpr std::string_view kNames = AFTERSHADE_TEXT_OF(AFTERSHADE_OPTIONS);
#undef AFTERSHADE_TEXT_OF
#undef AFTERSHADE_TEXT

/// What the callers of the library have: members and functions of the API, and arguments in Python.
std::string library_spelling(Option option, std::string_view value) {
    static const std::map<Option, std::string_view> own = {{Option::allow_path, "AFTERSHADE_ALLOW_PATH"},
                                                           {Option::alpha, "alpha_is_opaque"},
                                                           {Option::color_space, "color_space"},
                                                           {Option::compression, "compression"},
                                                           {Option::effect_path, "effect_paths"},
                                                           {Option::history_out, "save_history()"},
                                                           {Option::layer, "layer"},
                                                           {Option::max_image_bytes, "max_image_bytes"},
                                                           {Option::on_nan, "non_finite={}"},
                                                           {Option::output, "path={}"},
                                                           {Option::output_roles, "roles"},
                                                           {Option::pixel_type, "half=false"},
                                                           {Option::plugin_path, "plugin_paths"},
                                                           {Option::profile, "profile"},
                                                           {Option::scale, "scale_divisor"},
                                                           {Option::set, "set"},
                                                           {Option::tap, "taps"},
                                                           {Option::telemetry, "telemetry"},
                                                           {Option::view, "view"}};
    const auto found = own.find(option);
    std::string text(found == own.end() ? "" : found->second);
    if (const std::size_t at = text.find("={}"); at != text.npos)
        text.replace(at, 3, value.empty() ? "" : "=" + std::string(value));
    return text;
}

OptionSpeller g_speller = library_spelling;

}  // namespace

std::string_view option_name(Option option) {
    static const std::vector<std::string_view> names = split(kNames, ',');
    return trimmed(names.at(std::size_t(option)));
}

void spell_options_by(OptionSpeller speller) {
    g_speller = speller;
}

std::string spelled(Option option, std::string_view value) {
    const std::string text = g_speller(option, value);
    if (!text.empty()) return text;
    return std::string(option_name(option)) + (value.empty() ? "" : " " + std::string(value));
}

std::string advice(std::string_view before, Option option, std::string_view value, std::string_view after) {
    const std::string text = g_speller(option, value);
    return text.empty() ? "" : std::string(before) + text + std::string(after);
}

}  // namespace aftershade
