// Outputs of `run`: EXR of color and other roles, PNG of display, taps as EXR or as PNG in false colour.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/base/input_files.h"
#include "framework/capture/capture.h"
#include "framework/capture/frame_range.h"
#include "framework/render/renderer.h"
#include "framework/run/run_options.h"

namespace aftershade {

/// Makes the folders of every file of every frame (framework/base/atomic_file.h: prepare_output_folder).
void prepare_output_folders(const OutputOptions& options, const Sequence& sequence);

/// Faults that show before any work: an unknown extension, several frames for one file, an output that is an
/// input or another output. `inputs` has what the run reads, and notes the outputs.
void check_outputs(const OutputOptions& options, const Sequence& sequence, InputFiles& inputs,
                   Diagnostics& diagnostics);

/// Roles that the options need from the pipeline: those of EXR, and display where a PNG is an output, or
/// color where the pipeline may make no display.
std::vector<std::string> wanted_roles(const OutputOptions& options, bool makes_display = false);

/// Roles of the options that go into half channels of EXR alone.
std::vector<std::string> roles_written_as_halfs(const OutputOptions& options);

/// The files that write_outputs makes of a frame, in its order.
std::vector<std::filesystem::path> output_files(const OutputOptions& options, const std::vector<Tap>& taps,
                                                int frame);

/// The bytes of the PNG that write_outputs writes of the frame.
std::string encode_display(const std::string& name, const OutputOptions& options, const FrameResult& result,
                           const Capture& capture);

struct WrittenFiles {
    std::vector<std::filesystem::path> paths;
    std::vector<std::string> warnings;  ///< values that a format could not hold, with the remedy
    double share_cut = 0;  ///< of a PNG's pixels: those of colour above 1, which no step mapped to display
};

/// Writes one frame, each file by rename. A role that no step made is taken from the capture. PNG takes
/// `display`, else color encoded as sRGB, over the display window; so does the stream, if there is one.
/// Throws Error(ErrorKind::output).
WrittenFiles write_outputs(const OutputOptions& options, const FrameResult& result, const Capture& capture,
                           const CaptureReader& reader);

}  // namespace aftershade
