// Options of the files that `run` writes for each frame.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "framework/file/frame_stream.h"

namespace aftershade {

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
