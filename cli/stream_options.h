// `run -o -` and `run -o film.mp4`: frames into a pipe.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "cli/cli11.h"
#include "framework/base/atomic_file.h"
#include "framework/base/diagnostics.h"
#include "framework/capture/capture.h"
#include "framework/file/frame_stream.h"
#include "framework/look/pipeline.h"
#include "framework/run/run_options.h"

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

/// How frames go into a video, by its name: .mp4 (H.264, 8 bits), .mov (ProRes 422 HQ, 10 bits), .mkv (FFV1,
/// 16 bits, lossless), .webm (VP9, 8 bits). nullopt where the name is of no video.
std::optional<StreamFormat> video_stream_format(const std::string& name);

/// One video. Its file appears whole, at finish(), or not at all. [one thread at a time]
class VideoEncoder {
public:
    /// `input`: ffmpeg_input_options(). Throws Error(ErrorKind::output) where ffmpeg is not on PATH.
    VideoEncoder(const std::string& file, const std::string& input);
    /// Ends ffmpeg where finish() has not.
    ~VideoEncoder();
    VideoEncoder(const VideoEncoder&) = delete;
    VideoEncoder& operator=(const VideoEncoder&) = delete;

    FrameStream& frames() { return *frames_; }
    /// Waits for ffmpeg. Throws Error(ErrorKind::output) where it failed; its own messages have the reason.
    void finish();

private:
    std::string name_;
    AtomicFile file_;
    std::optional<FrameStream> frames_;
    pid_t process_ = -1;
};

}  // namespace aftershade::cli
