#include "framework/golden/golden_render.h"

#include <algorithm>
#include <cstdlib>
#include <list>
#include <optional>
#include <set>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/batch/process_codes.h"
#include "framework/batch/worker.h"
#include "framework/capture/frame_range.h"
#include "framework/capture/sequence.h"
#include "framework/file/exr_file.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxMessages = 40;

/// Frames of the case; nothing where the capture is not there (`absent` says what) or has faults, which the
/// worker tells.
std::vector<int> frames_of(const GoldenCase& test, std::string& absent) {
    std::vector<int> frames = parse_frame_range(test.frames).value_or(std::vector<int>{});
    const bool pattern = FramePattern(test.capture.filename().string()).has_frame();
    std::error_code unreadable;
    if (!pattern && !fs::exists(test.capture, unreadable)) {
        absent = "no capture " + test.capture.string();
        return frames;
    }
    try {
        Diagnostics faults;
        const auto sequence = open_sequence(test.capture.string(), faults);
        if (!sequence || faults.has_errors()) return frames;
        if (frames.empty()) frames = sequence->frames;
        const bool in_one = !sequence->files.text().empty() && !frames.empty();
        const fs::path first = in_one ? sequence->path_of(sequence->file_number(frames.front())) : fs::path();
        if (in_one && !fs::exists(first, unreadable)) absent = "no capture " + first.string();
    } catch (const Error& error) {
        absent = error.what();
    }
    return frames;
}

/// As a word that is no option: a normal path has lost the "./" that it was named with.
std::string path_word(const fs::path& path) {
    const std::string text = path.string();
    return text.starts_with('-') ? "./" + text : text;
}

std::vector<std::string> words_of(const GoldenCase& test, const GoldenRenderOptions& options,
                                  const fs::path& work) {
    const bool inline_look = test.look.empty();
    const fs::path look = inline_look ? work / "look.json" : test.look;
    if (inline_look) write_text_file(look, test.steps + "\n");
    std::vector<std::string> words = {"aftershade",
                                      "run",
                                      path_word(look),
                                      path_word(test.capture),
                                      "-o",
                                      (work / "render" / "####.exr").string()};
    const auto add = [&](const char* flag, const std::string& value) {
        words.insert(words.end(), {flag, value});
    };
    if (inline_look) add("--look-folder", test.folder.empty() ? "." : test.folder.string());
    if (!test.frames.empty()) add("--frames", test.frames);
    std::string roles;
    for (const std::string& role : test.outputs) roles += (roles.empty() ? "" : ",") + role;
    if (!roles.empty()) add("--output-roles", roles);
    for (const std::string& set : test.sets) add("--set", set);
    for (const std::string& tap : test.taps)
        add("--tap", tap + "=" + (work / "taps" / (tap + ".####.exr")).string());
    for (const std::string& path : options.effect_paths) add("--effect-path", path);
    for (const std::string& path : options.plugin_paths) add("--plugin-path", path);
    add("--backend", options.backend);
    if (const std::string device = options.device ? options.device() : ""; !device.empty())
        add("--device", device);
    add("--progress", "none");
    words.push_back("--no-journal");
    return words;
}

void judge_end(const WorkerResult& result, std::list<std::string>& lines, RenderedCase& rendered) {
    rendered.seconds = result.seconds;
    rendered.interrupted =
        result.end == WorkerEnd::interrupted ||
        (result.end == WorkerEnd::exited && result.exit_code == int(ExitCode::interrupted));
    if (result.succeeded() && result.ended_in_order()) {
        std::erase_if(lines, [](const std::string& line) { return line.find("warning") == line.npos; });
        return;
    }
    const auto code = ExitCode(result.exit_code);
    const bool files = result.end == WorkerEnd::exited &&
                       (code == ExitCode::capture || code == ExitCode::gl || code == ExitCode::output);
    rendered.verdict = files ? Verdict::file_error : Verdict::failure;
    if (!result.ended_in_order()) lines.push_back("rendering: " + describe(result));
    else if (lines.empty()) lines.push_back("rendering ended with code " + std::to_string(result.exit_code));
}

/// A worker that a signal ends is started once more: drivers crash by accidents of their threads, and the
/// same picture is expected of every run.
void run_look(const GoldenCase& test, const GoldenRenderOptions& options, const fs::path& work,
              const std::atomic<bool>& interrupt, RenderedCase& rendered) {
    WorkerCommand command;
    command.arguments = words_of(test, options, work);
    rendered.command = printed_command(command.arguments);
    command.arguments[0] = "/proc/self/exe";
    command.limits.wall_time = options.timeout;
    if (!std::getenv("LP_NUM_THREADS"))
        command.environment["LP_NUM_THREADS"] = std::to_string(options.threads);
    std::list<std::string> lines;
    WorkerListener listener;
    listener.on_stderr = [&](std::string_view line) {
        lines.emplace_back(line);
        if (lines.size() > kMaxMessages) lines.pop_front();
    };
    WorkerResult result = run_worker(command, listener, &interrupt);
    std::string crash;
    if (result.end == WorkerEnd::signalled && !interrupt) {
        crash = "rendering: " + describe(result) + "; it was run once more";
        lines.clear();
        result = run_worker(command, listener, &interrupt);
    }
    judge_end(result, lines, rendered);
    if (!crash.empty()) {
        lines.push_front(crash);
        rendered.verdict = std::max(rendered.verdict, Verdict::warning);
    }
    rendered.messages.assign(lines.begin(), lines.end());
}

/// Whether a channel of a file with several roles is of this one.
bool is_of_role(const std::string& channel, const std::string& role) {
    if (const auto contract = find_role(role))
        return std::ranges::find(contract->native_channels, channel) != contract->native_channels.end();
    const std::string layer = role.substr(role.find(':') + 1);
    return channel == layer || channel.starts_with(layer + ".");
}

/// One role of a file ("" for all channels) as a file of its own, bit for bit.
void extract(const fs::path& from, const std::string& role, const fs::path& to) {
    const ExrFile file(from);
    const ExrPart& part = file.parts().front();
    std::list<Image> images;
    std::vector<ExrOutputChannel> channels;
    for (const ExrChannel& channel : part.channels) {
        if (!role.empty() && !is_of_role(channel.name, role)) continue;
        const std::vector<std::string> one{channel.name};
        images.push_back(channel.type == PixelType::uint32 ? file.read_uints(0, one)
                                                           : file.read_floats(0, one));
        channels.push_back({channel.name, channel.type, &images.back(), 0});
    }
    if (channels.empty())
        throw Error(ErrorKind::capture,
                    from.string() + ": no channel of the role '" + role + "' was written");
    ExrWriteOptions options;
    options.data_window = part.data_window;
    options.display_window = part.display_window;
    options.pixel_aspect = part.pixel_aspect;
    if (const auto primaries = part.metadata.value("chromaticities"))
        options.attributes["chromaticities"] = *primaries;
    write_exr(to, channels, options);
}

void take_images(const GoldenCase& test, const std::vector<int>& frames, const fs::path& work,
                 RenderedCase& rendered) {
    const std::vector<std::string> stems = test.image_stems();
    std::set<fs::path> expected;
    for (const int frame : frames) {
        const fs::path file = work / "render" / FramePattern("####.exr").path(frame);
        expected.insert(file);
        for (std::size_t i = 0; i < stems.size(); ++i) {
            const bool tap = i >= test.outputs.size();
            const std::string output = tap ? test.taps[i - test.outputs.size()] : test.outputs[i];
            const std::string name = golden_image_name(stems[i], frame);
            const fs::path to = work / "images" / (name + ".exr");
            const fs::path from = tap ? work / "taps" / FramePattern(output + ".####.exr").path(frame) : file;
            if (tap) expected.insert(from);
            extract(from, tap || test.outputs.size() == 1 ? "" : output, to);
            rendered.images.push_back({name, output, frame, to});
        }
    }
    for (const char* folder : {"render", "taps"})
        for (const auto& entry : fs::directory_iterator(work / folder)) {
            if (expected.contains(entry.path())) continue;
            rendered.verdict = Verdict::failure;
            rendered.messages.push_back("an output that the case does not name: " +
                                        entry.path().filename().string());
        }
}

}  // namespace

RenderedCase render_case(const GoldenCase& test, const GoldenRenderOptions& options, const fs::path& work,
                         const std::atomic<bool>& interrupt) {
    RenderedCase rendered;
    const std::vector<int> frames = frames_of(test, rendered.absent);
    if (!rendered.absent.empty() && !test.optional) {
        rendered.verdict = Verdict::file_error;
        rendered.messages.push_back(rendered.absent +
                                    " (set \"optional\": true in the case if its capture may be missing)");
        rendered.absent.clear();
        return rendered;
    }
    if (!rendered.absent.empty()) return rendered;
    for (const char* folder : {"render", "taps", "images"}) fs::create_directories(work / folder);
    run_look(test, options, work, interrupt, rendered);
    if (rendered.verdict > Verdict::warning || rendered.interrupted) return rendered;
    try {
        take_images(test, frames, work, rendered);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::output) throw;
        rendered.verdict = Verdict::failure;
        rendered.messages.emplace_back(error.what());
        rendered.images.clear();
    }
    return rendered;
}

}  // namespace aftershade
