#include "cli/stream_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <utility>

#include "cli/run_arguments.h"
#include "cli/video_output.h"
#include "framework/capture/capture_window.h"
#include "framework/capture/frame_range.h"
#include "framework/file/frame_stream.h"
#include "framework/run/frame_run.h"

namespace aftershade::cli {

void add_stream_options(CLI::App& app, StreamArguments& arguments) {
    app.add_option("--format", arguments.format,
                   "Format of the frames of -o -: rgb24, rgba, rgb48le or rgba64le (ffmpeg's rawvideo), or "
                   "png (its image2pipe)")
        ->check(CLI::IsMember(stream_format_names()));
    app.add_flag("--print-ffmpeg", arguments.print_ffmpeg,
                 "Print the start of the ffmpeg command that reads the frames of -o -, and run nothing");
}

bool is_stream(const std::string& output) {
    return output == kStandardOutput || video_stream_format(output);
}

void check_stream_options(const RunArguments& arguments, Diagnostics& diagnostics) {
    const StreamArguments& stream = arguments.stream;
    const std::string output = arguments.stream_output();
    const bool to_standard_output = output == kStandardOutput;
    if (!to_standard_output) {
        for (const auto& [is_given, option] : {std::pair(!stream.format.empty(), "--format"),
                                               std::pair(stream.print_ffmpeg, "--print-ffmpeg")})
            if (is_given) diagnostics.error({option}, "is for frames on standard output; add -o -");
        if (output.empty()) return;
    }
    const Place place{"-o " + output};
    if (std::ranges::count_if(arguments.outputs, is_stream) > 1)
        diagnostics.error(place, to_standard_output
                                     ? "standard output takes one stream of frames; write -o - once"
                                     : "a run makes one video; make the other in another run");
    if (!to_standard_output && FramePattern(output).has_frame())
        diagnostics.error(place, "a video is one file; leave the frame's number out of its name");
    if (to_standard_output && stream.format.empty())
        diagnostics.error(place,
                          "add the format of the frames: --format " + list_of_names(stream_format_names()));
    const auto refuse = [&](bool is_given, const char* option, const std::string& why) {
        if (is_given) diagnostics.error({option}, why);
    };
    refuse(arguments.watch, "--watch",
           "does not go with -o " + output + ", whose reader expects each frame once");
    refuse(arguments.resume.resume, "--resume",
           "does not go with -o " + output + ": a stream begins with its first frame");
    refuse(arguments.resume.dry_run, "--dry-run",
           "does not go with -o " + output + ", which renders every frame; leave one of them out");
    refuse(to_standard_output && arguments.progress == "openjd", "--progress openjd",
           "writes to standard output, which -o - fills with frames; choose plain or json");
}

std::string ffmpeg_input(const CaptureReader& reader, const Sequence& sequence, const RunOptions& run,
                         const OutputOptions& outputs) {
    if (!outputs.stream_format) return "";
    const CaptureHeader header = reader.read_header(sequence.file_number(run.frames.front()));
    const Window& display = header.display_window;
    const Window window = intersection(written_window(display, run),
                                       scaled_window(whole_picture(header), display, run.scale_divisor));
    return ffmpeg_input_options(*outputs.stream_format, window.width(), window.height(), sequence.fps);
}

}  // namespace aftershade::cli
