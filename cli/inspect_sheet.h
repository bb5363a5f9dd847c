// `inspect --contact-sheet` of several frames.
#pragma once

#include <string>

#include "framework/base/error.h"
#include "framework/batch/process_codes.h"
#include "framework/capture/capture.h"
#include "framework/file/exr_file.h"

namespace aftershade::cli {

/// Thumbnails of the color of every frame of the sequence, or of the pictures of a pattern of PNG files.
/// Reads one frame at a time. `columns` 0: as many as fit. ExitCode::partial where frames could not be read,
/// which the sheet and stderr name. Throws Error(ErrorKind::capture) where none could be.
ExitCode write_frame_sheet(const std::string& path, int columns, const Sequence& sequence,
                           const CaptureReader& reader);

}  // namespace aftershade::cli
