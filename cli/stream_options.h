// `run -o -` and `run -o film.mp4`: frames into a pipe.
#pragma once

#include <string>

#include "framework/base/diagnostics.h"
#include "framework/capture/capture.h"
#include "framework/look/pipeline.h"
#include "framework/run/output_options.h"
#include "framework/run/run_options.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

struct RunArguments;

/// What -o names for standard output.
inline constexpr const char* kStandardOutput = "-";

/// Whether -o names that or a video.
bool is_stream(const std::string& output);

struct StreamArguments {
    std::string format;  ///< one of stream_format_names(); "" where nothing is streamed
    bool print_ffmpeg = false;
};

void add_stream_options(CLI::App& app, StreamArguments& arguments);

/// What cannot go with `-o -` or a video, and options that are for `-o -` alone.
void check_stream_options(const RunArguments& arguments, Diagnostics& diagnostics);

/// "-f rawvideo ...": how ffmpeg reads the frames from -i -. "" where nothing is streamed.
std::string ffmpeg_input(const CaptureReader& reader, const Sequence& sequence, const RunOptions& run,
                         const OutputOptions& outputs);

}  // namespace aftershade::cli
