// Which frames a run renders, which part of each at which size, and the files that it writes for each.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "framework/file/frame_stream.h"
#include "framework/image/image.h"
#include "framework/render/native_steps.h"
#include "framework/render/renderer_options.h"
#include "framework/render/trace.h"

namespace aftershade {

/// Handling of a missing frame's file.
enum class MissingFrame {
    error,  ///< the frame has failed
    skip,   ///< leave it out
    hold    ///< run the last frame that was there again, under this frame's number
};

/// Handling of a capture or an output with pixels that are NaN or infinite. They are always counted.
enum class NanPolicy {
    warn,  ///< say so
    fail,  ///< the frame has failed, and nothing of it is written
    mend   ///< replace them (framework/image/non_finite.h), in captures before the effects see them, and say
           ///< so
};

struct RunOptions {
    std::vector<int> frames;
    int warmup_frames = 0;  ///< of these, the first ones are rendered for their history and not written
    MissingFrame missing = MissingFrame::error;
    NanPolicy on_nan = NanPolicy::warn;
    bool stop_on_error = false;  ///< the first frame that fails ends the run
    RendererOptions drawing{};
    int frames_ahead = 0;   ///< that are read, and that are written, while one is worked on; 0: a quarter of
                            ///< the cores, 8 at most, as far as memory has room
    int scale_divisor = 1;  ///< frames are rendered at 1/this of their size
    std::optional<Window> region;         ///< px of the display window at full scale, from its top left
    std::optional<int> region_margin_px;  ///< rendered around the region, and not written; nullopt: what it
                                          ///< needs (framework/look/reach.h)
    std::filesystem::path history_in;     ///< "" for none
    std::filesystem::path history_out;    ///< "" for none
    NativeSources natives{};
    Trace* trace = nullptr;  ///< gets what the run does and when; nullptr for none
};

/// The attribute of EXR outputs, and the text of PNG outputs, with the fingerprint.
inline constexpr const char* kFingerprintName = "aftershade/fingerprint";

struct OutputOptions {
    std::vector<std::string> patterns;        ///< "out.exr", "out_####.png": format by extension
    std::vector<std::string> roles{"color"};  ///< in EXR files
    PixelType color_type = PixelType::half;   ///< of roles that are half by default
    bool keep_channels = false;               ///< EXR: every channel of the source too, under its own name
    bool crop_to_display = false;     ///< EXR: the display window's pixels only; PNG always has just these
    std::string compression = "zip";  ///< EXR
    int png_bits = 0;                 ///< of a sample of PNG: 8 or 16; 0: 16 of PQ and HLG, else 8
    std::string look{};               ///< written as attribute aftershade/look
    std::string renderer{};           ///< GL_RENDERER, written as attribute aftershade/renderer
    std::string fingerprint{};        ///< of what the frame is made of: kFingerprintName; "" for none
    std::string telemetry{};          ///< "stats_####.json": numbers of each frame; "" for none
    std::optional<StreamFormat> stream_format{};        ///< of frames that go into a pipe, too
    FrameStream* stream = nullptr;                      ///< that pipe, once it is open
    std::vector<std::string> taps{};                    ///< "step.texture": files beside the first pattern
    std::map<std::string, std::string> tap_patterns{};  ///< by "step.texture": names of their own
};

}  // namespace aftershade
