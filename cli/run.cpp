#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/batch_report.h"
#include "cli/bound_look.h"
#include "cli/capture_options.h"
#include "cli/exit_code.h"
#include "cli/gl_options.h"
#include "cli/graph_file.h"
#include "cli/interrupt.h"
#include "cli/run_arguments.h"
#include "cli/run_continuation.h"
#include "cli/run_session.h"
#include "cli/run_workers.h"
#include "cli/stream_options.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/cores.h"
#include "framework/base/data_path.h"
#include "framework/base/text.h"
#include "framework/batch/process_codes.h"
#include "framework/capture/frame_range.h"
#include "framework/file/frame_stream.h"
#include "framework/look/pixel_shape.h"
#include "framework/render/frame_drive.h"
#include "framework/run/output.h"

namespace aftershade::cli {

namespace {

// The file of --report while a run has not come as far as to write it.

bool begins_frames(const RunArguments& options) {
    return !options.jobs.report.empty() && !options.explain && !options.stream.print_ffmpeg &&
           !options.resume.dry_run;
}

bool is_report(const std::filesystem::path& path) {
    constexpr std::size_t kHead_bytes = 64;
    std::string head(kHead_bytes, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(head.data(), std::streamsize(head.size()));
    return head.starts_with('{') && head.find("\"aftershade_report\"") != std::string::npos;
}

/// Removes the report of an earlier run, which would pass for the report of this one. Other files stay: the
/// checks of the outputs refuse them.
void remove_old_report(const RunArguments& options) {
    std::error_code failure;
    if (begins_frames(options) && std::filesystem::is_regular_file(options.jobs.report, failure) &&
        is_report(options.jobs.report))
        std::filesystem::remove(options.jobs.report, failure);
}

/// A report without frames, of a run that ended before its first one; keeps a file that is there.
void write_early_report(const RunArguments& options, ExitCode code, const std::string& message) {
    std::error_code failure;
    if (!begins_frames(options) || std::filesystem::exists(options.jobs.report, failure)) return;
    try {
        write_text_file(options.jobs.report,
                        report_json({options.look, options.capture.capture, {}, 0, code, {}, message}));
    } catch (const Error& error) {
        if (code == ExitCode::done) throw;
        std::cerr << printable_lines(error.what()) << "\n";
    }
}

/// Documents of the profiles that a frame may be read by: of the one that was chosen, else of all.
std::vector<std::filesystem::path> documents_of(const std::vector<Profile>& profiles,
                                                const Sequence& sequence) {
    std::vector<std::filesystem::path> documents;
    for (const Profile& profile : profiles)
        if (sequence.profile == "auto" || sequence.profile == profile.id) documents.push_back(profile.file);
    return documents;
}

void require_first_frame(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline) {
    if (sequence.frames.size() == 1)
        require_capture_roles(pipeline, reader.read_header(sequence.file_number(sequence.frames.front())),
                              &reader);
}

ExitCode explain(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline) {
    const Capture capture =
        reader.read(sequence.file_number(sequence.frames.front()), pipeline.capture_roles());
    std::cout << printable_lines("color space: " + capture.header.stored_colors.text() + "\n");
    for (const std::string& warning : capture.header.warnings)
        std::cout << "warning: " << printable_lines(warning) << "\n";
    const CaptureHeader& header = capture.header;
    if (const auto note = SquareSteps(pipeline, header.pixel_aspect).note(pipeline, header); !note.empty())
        std::cout << printable_lines(note + "\n");
    std::cout << printable_lines(explain_params(pipeline, FrameSetting{}.inputs(capture)));
    return ExitCode::done;
}

/// What would fail after the frames fails before them.
void prepare_outputs(const RunArguments& options, const OutputOptions& outputs, const Sequence& sequence) {
    require_graph_writer(options.graph);
    prepare_output_folders(outputs, sequence);
    for (const std::string* file : {&options.history_out, &options.graph, &options.telemetry_plot,
                                    &options.trace, &options.jobs.report})
        prepare_output_folder(*file);
}

/// The frames of this process and its workers.
struct FrameShare {
    JobFrames run;
    int workers = 1;
};

FrameShare share_of_frames(const RunArguments& options, const Pipeline& pipeline, const Sequence& sequence,
                           Diagnostics& diagnostics) {
    FrameShare share;
    if (options.jobs.is_worker()) {
        share.run.frames = parse_frame_range(options.jobs.worker_frames).value_or(std::vector<int>{});
        share.run.lead_frames = options.jobs.worker_warmup_frames;
        return share;
    }
    share.run = job_frames(options.jobs, pipeline, sequence, !options.history_in.empty(), diagnostics);
    if (!options.jobs.chunk.empty()) {
        const auto chunk = parse_chunk(
            options.jobs.chunk, [](const char* name) { return std::getenv(name); }, diagnostics);
        JobPiece piece = chunk_of(share.run, chunk.value_or(Chunk{}).index, chunk.value_or(Chunk{}).count);
        share.run.frames = std::move(piece.frames);
        share.run.lead_frames = piece.warmup_frames;
    }
    share.workers = worker_count(options.jobs, share.run, diagnostics);
    return share;
}

/// Which device of --device all this process draws on.
std::optional<int> part_of(const RunArguments& options) {
    if (options.jobs.wants_workers()) return 0;  // each worker has its own
    Diagnostics faults;
    const auto chunk =
        options.jobs.chunk.empty()
            ? std::nullopt
            : parse_chunk(
                  options.jobs.chunk, [](const char* name) { return std::getenv(name); }, faults);
    return chunk ? std::optional(chunk->index) : std::nullopt;
}

/// What the user wrote, without a fault.
struct CheckedRun {
    std::optional<WatchedLook> watched;
    std::unique_ptr<BoundLook> bound;
    std::vector<Profile> profiles;
    Sequence sequence;
    OutputOptions outputs;
    RunOptions settings;
    FrameShare share;
};

/// Lists every fault before any work starts.
CheckedRun checked_run(const RunArguments& options) {
    CheckedRun run;
    Diagnostics diagnostics;
    if (Diagnostics faults; options.watch && (run.watched = bind_watched(options, faults)))
        diagnostics = faults;
    run.bound = run.watched ? std::move(run.watched->bound) : bind_look(options, diagnostics);
    run.profiles = load_profiles(options.capture.profile_paths, diagnostics);
    std::optional<Sequence> sequence = find_sequence(options.capture, run.profiles, diagnostics);
    run.outputs = output_options(options);
    run.settings = run_options(options, diagnostics);
    if (sequence && !sequence->layers.empty() && run.outputs.keep_channels)
        diagnostics.error({"--keep-channels"},
                          "keeps the channels of one file, and the capture's " +
                              std::to_string(sequence->layers.size()) +
                              " layers are several pictures; choose roles with --output-roles");
    if (sequence) {
        sequence->object_names = run.bound->pipeline.object_names();
        add_missing_frames(options.capture, run.settings.missing, *sequence, diagnostics);
        run.share = share_of_frames(options, run.bound->pipeline, *sequence, diagnostics);
    }
    if (sequence && !diagnostics.has_errors()) require_some_file(*sequence);
    const Sequence checked = sequence.value_or(Sequence{});
    InputFiles inputs = run_inputs(*run.bound, checked, diagnostics);
    const bool may_report = check_run_outputs(options, run.outputs, checked, inputs, diagnostics);
    check_worker_options(options, diagnostics);
    check_stream_options(options, diagnostics);
    stop_at_errors(diagnostics, !may_report);
    diagnostics.print(std::cerr);
    run.sequence = std::move(*sequence);
    run.settings.frames = run.share.run.frames;
    run.settings.warmup_frames = run.share.run.lead_frames;
    return run;
}

/// Warns of what the pieces of a run lack: history where they begin in the middle of a shot, changes of color
/// in layers.
void print_lacks(const CheckedRun& run, const CaptureReader& reader, const std::vector<JobPiece>& pieces) {
    const Pipeline& pipeline = run.bound->pipeline;
    std::vector<std::string> texts = stale_layers_texts(pipeline, run.sequence, reader);
    for (const JobPiece& piece : pieces) {
        if (!pipeline.has_history() || !run.settings.history_in.empty() || piece.warmup_frames > 0 ||
            piece.frames.empty())
            continue;
        const int first = piece.frames.front();
        const std::string before = std::to_string(first - 1);
        texts.push_back(
            lost_history_text(pipeline, run.sequence, reader, first,
                              first == run.share.run.frames.front()
                                  ? "run the frames up to " + before +
                                        " with --history-out FILE, and these with --history-in FILE"
                                  : "leave --jobs out, or set --warmup"));
    }
    for (const std::string& text : texts)
        if (!text.empty()) std::cerr << "aftershade: warning: " << printable(text) << "\n";
}

/// Renders in this process.
ExitCode run_here(const RunArguments& options, CheckedRun& run, const CaptureReader& reader,
                  const std::vector<std::filesystem::path>& profile_documents,
                  const std::atomic<bool>& stop) {
    std::optional<FrameStream> stream;
    std::optional<VideoEncoder> video;
    if (run.outputs.stream_format) {
        const std::string input = ffmpeg_input(reader, run.sequence, run.settings, run.outputs);
        if (options.stream_output() != kStandardOutput) {
            prepare_output_folder(options.stream_output());
            run.outputs.stream = &video.emplace(options.stream_output(), input).frames();
        } else {
            if (options.progress != "none" && options.progress != "json")
                std::cerr << kStandardOutput << ": " << options.stream.format
                          << "; to read the frames: ffmpeg " << input << " -i - OUTPUT\n";
            run.outputs.stream = &stream.emplace(FrameStream::of_standard_output(*run.outputs.stream_format));
        }
    }
    const int cores = options.jobs.worker_threads > 0 ? options.jobs.worker_threads : allotted_cores();
    set_exr_threads(cores);
    run.settings.drawing.compile_threads = cores - 1;
    StatusWriter status;
    NativeRegistry natives = native_registry(options.plugins, &status);
    std::optional<gpu::Context> made;
    const auto context = [&]() -> gpu::Context& {
        return made ? *made
                    : made.emplace(chosen_gl(options.gl, part_of(options)), gpu::SelfTest::at_first_use);
    };
    run.settings.natives = {&natives, &status};
    const Pipeline& pipeline = run.bound->pipeline;
    if (!options.jobs.is_worker())
        print_lacks(run, reader, {{run.settings.frames, run.settings.warmup_frames}});
    const auto end_context = options.watch ? std::function<void()>() : [&] { made.reset(); };
    const RunSession session{options,          status,      run.sequence,
                             reader,           context,     end_context,
                             run.settings,     run.outputs, parse_progress(options.progress),
                             profile_documents};
    const bool resumes =
        !options.watch && !run.outputs.stream && options.resume.keeps_journal(run.settings.frames.size());
    if (resumes || options.resume.dry_run) return render_stale(session, *run.bound, stop);
    const ExitCode code = render(session, session.run, pipeline, stop);
    if (video) {
        if (code != ExitCode::done)
            std::cerr << "-o " << options.stream_output() << ": not written, since the run is not whole\n";
        else {
            video->finish();
            std::cout << options.stream_output() << "\n";
        }
    }
    if (!options.watch) return code;
    run.watched->bound = std::move(run.bound);
    return watch(session, std::move(*run.watched), stop);
}

/// No thread where the system starts none.
std::jthread load_library_ahead(gpu::Backend backend) {
    try {
        return std::jthread([backend] { gpu::load_ahead(backend); });
    } catch (const std::system_error&) {
        return {};
    }
}

}  // namespace

ExitCode run(const RunArguments& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();
    const gpu::Backend backend = chosen_gl(options.gl, part_of(options)).backend;
    const bool draws = !options.explain && !options.stream.print_ffmpeg && !options.jobs.wants_workers();
    const std::jthread library = draws ? load_library_ahead(backend) : std::jthread();
    const ProgressStyle progress = parse_progress(options.progress);
    CheckedRun run = checked_run(options);
    const auto profile_documents = documents_of(run.profiles, run.sequence);
    const CaptureReader reader(run.sequence, run.profiles, options.capture.limits);
    if (options.explain) return explain(run.sequence, reader, run.bound->pipeline);
    if (options.stream.print_ffmpeg) {
        std::cout << "ffmpeg " << ffmpeg_input(reader, run.sequence, run.settings, run.outputs) << " -i -\n";
        return ExitCode::done;
    }
    // A lone frame that cannot be read is reported before a context is made.
    require_first_frame(run.sequence, reader, run.bound->pipeline);
    if (!options.jobs.chunk.empty() && run.share.run.count() == 0) {
        std::cerr << "--chunk " << options.jobs.chunk
                  << ": no frames; the sequence has fewer frames than chunks\n";
        return ExitCode::done;
    }
    prepare_outputs(options, run.outputs, run.sequence);
    if (options.jobs.wants_workers()) {
        print_lacks(run, reader, plan_jobs(run.share.run, run.share.workers));
        return run_by_workers(options, run.share.run, run.share.workers, run.bound->pipeline, progress, stop);
    }
    if (const auto code = run_in_worker(options.plugins, run.bound->pipeline.has_foreign())) return *code;
    return run_here(options, run, reader, profile_documents, stop);
}

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunArguments>();
    add_run_options(app, *options);
    return [options] {
        remove_old_report(*options);
        try {
            const ExitCode code = run(*options);
            write_early_report(*options, code, "");  // where there was no frame to run
            return code;
        } catch (const FaultyDocuments& faults) {
            if (!faults.refuses_report) write_early_report(*options, exit_code_of(faults), faults.details);
            throw;
        } catch (const Error& error) {
            write_early_report(*options, exit_code_of(error), error.what());
            throw;
        }
    };
}

}  // namespace aftershade::cli
