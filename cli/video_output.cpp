#include "cli/video_output.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/base/text.h"

extern char** environ;

namespace aftershade::cli {

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
