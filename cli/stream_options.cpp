#include "cli/stream_options.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/run_arguments.h"
#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
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

namespace {

struct VideoKind {
    const char* extension;
    StreamFormat format;
    const char* options;  // for ffmpeg
};

// Half the resolution of colour needs an even size: a last row or column goes. Players take Rec. 709 for
// granted; sRGB's curve is what display-referred pictures have.
constexpr const char* kEven =
    "-vf crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,scale=out_color_matrix=bt709:out_range=tv";
constexpr const char* kTagged =
    "-colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1 -color_range tv";

const VideoKind* kind_of(const std::string& name) {
    static const std::vector<VideoKind> kinds{
        {".mp4", StreamFormat::rgb24, "-c:v libx264 -crf 18 -pix_fmt yuv420p -movflags +faststart -f mp4"},
        {".mov", StreamFormat::rgb48le, "-c:v prores_ks -profile:v hq -pix_fmt yuv422p10le -f mov"},
        {".mkv", StreamFormat::rgb48le, "-c:v ffv1 -level 3 -f matroska"},
        {".webm", StreamFormat::rgb24, "-c:v libvpx-vp9 -crf 24 -b:v 0 -pix_fmt yuv420p -f webm"}};
    const std::string extension = lower_case(std::filesystem::path(name).extension().string());
    for (const VideoKind& kind : kinds)
        if (kind.extension == extension) return &kind;
    return nullptr;
}

}  // namespace

std::optional<StreamFormat> video_stream_format(const std::string& name) {
    const VideoKind* kind = kind_of(name);
    return kind ? std::optional(kind->format) : std::nullopt;
}

VideoEncoder::VideoEncoder(const std::string& file, const std::string& input) : name_(file), file_(file) {
    const std::string program = program_on_path("ffmpeg");
    if (program.empty())
        throw Error(ErrorKind::output,
                    "-o " + name_ +
                        ": a video needs ffmpeg on PATH (Debian package ffmpeg); write out_####.png instead");
    const VideoKind& kind = *kind_of(file);
    ChildCommand command;
    command.arguments = {program, "-nostdin", "-loglevel", "error", "-y"};
    std::string options = input + " -i - ";
    if (kind.format == StreamFormat::rgb24 || lower_case(name_).ends_with(".mov"))
        options += std::string(kEven) + " " + kTagged + " ";
    options += kind.options;
    for (const std::string_view word : split(options, ' '))
        if (!word.empty()) command.arguments.emplace_back(word);
    // A name that begins with "-" is no option.
    command.arguments.push_back("file:" + file_.temporary_path().string());
    for (char** entry = environ; *entry; ++entry) command.environment.emplace_back(*entry);
    Pipe pipe = make_pipe();
    command.descriptors = {pipe.read.get(), -1, STDERR_FILENO};
    command.leads_group = true;  // Ctrl-C ends the run, which then ends the video
    process_ = spawn_child(command);
    frames_.emplace(FrameStream::into(std::move(pipe.write), kind.format, "-o " + name_));
}

VideoEncoder::~VideoEncoder() {
    if (process_ < 0) return;
    kill(process_, SIGKILL);
    frames_.reset();
    reap(process_);
}

void VideoEncoder::finish() {
    frames_.reset();
    const int status = reap(std::exchange(process_, -1));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Error(ErrorKind::output,
                    fmt::format("-o {}: ffmpeg made no video ({}); its own messages have the reason", name_,
                                WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                                                  : signal_text(WTERMSIG(status))));
    file_.commit();
}

}  // namespace aftershade::cli
