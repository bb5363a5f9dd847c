// The EXR files of `run`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "framework/capture/capture.h"
#include "framework/render/renderer.h"
#include "framework/run/run_options.h"

namespace aftershade {

/// The image of a role: what a step made, else the capture's; nullptr where neither has it.
const Image* find_image(const std::string& role, const FrameResult& result, const Capture& capture);

/// Windows and attributes of a frame's outputs.
ExrWriteOptions exr_write_options(const OutputOptions& options, const CaptureHeader& header,
                                  const std::optional<ColorEncoding>& color = std::nullopt);

/// The roles asked for, under native names. With `options.keep_channels`, all channels of the source under
/// their own names instead, those of roles that a step changed re-encoded to the source's conventions, and
/// beside them the roles asked for that the source does not have. Throws Error(ErrorKind::capture) for a role
/// that is nowhere, Error(ErrorKind::output). Returns what a half could not hold, as a message with the
/// remedy;
/// "" where nothing was lost.
std::string write_exr_output(const std::filesystem::path& path, const OutputOptions& options,
                             const FrameResult& result, const Capture& capture, const CaptureReader& reader);

}  // namespace aftershade
