#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/effect_options.h"
#include "cli/frame_gaps.h"
#include "cli/gl_options.h"
#include "cli/graph_file.h"
#include "cli/interrupt.h"
#include "cli/run_continuation.h"
#include "cli/run_options.h"
#include "cli/run_session.h"
#include "cli/run_workers.h"
#include "cli/verbs.h"
#include "framework/capture/frame_range.h"
#include "framework/core/atomic_file.h"
#include "framework/core/cores.h"
#include "framework/core/data_path.h"
#include "framework/pipeline/look.h"
#include "framework/pipeline/output.h"

namespace aftershade::cli {

namespace {

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
        require_capture_roles(pipeline, reader.read_header(sequence.file_number(sequence.frames.front())));
}

ExitCode explain(const Sequence& sequence, const CaptureReader& reader, const Pipeline& pipeline) {
    const Capture capture =
        reader.read(sequence.file_number(sequence.frames.front()), pipeline.capture_roles());
    FrameInputs frame;
    frame.capture = &capture;
    std::cout << explain_params(pipeline, frame);
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

/// Renders in this process.
ExitCode run_here(const RunArguments& options, const RunSession& session, std::unique_ptr<BoundLook> bound,
                  std::optional<WatchedLook> watched, const std::atomic<bool>& stop) {
    const std::string lost =
        session.run.warmup_frames > 0 || options.jobs.is_worker()
            ? ""
            : lost_history_text(bound->pipeline, session.sequence, session.reader, session.run);
    if (!lost.empty()) std::cerr << "aftershade: warning: " << lost << "\n";
    const bool resumes = !options.watch && options.resume.keeps_journal(session.run.frames.size());
    if (resumes || options.resume.dry_run) return render_stale(session, *bound, stop);
    const ExitCode code = render(session, session.run, bound->pipeline, stop);
    if (!options.watch) return code;
    watched->bound = std::move(bound);
    return watch(session, std::move(*watched), stop);
}

ExitCode run(const RunArguments& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();

    // Everything that the user wrote is checked, and every fault listed, before any work starts.
    Diagnostics diagnostics;
    const gpu::Backend backend = chosen_backend(options.backend);
    const ProgressStyle progress = parse_progress(options.progress);
    std::optional<WatchedLook> watched;
    if (Diagnostics faults; options.watch && (watched = bind_watched(options, faults))) diagnostics = faults;
    auto bound = watched ? std::move(watched->bound) : bind_look(options, diagnostics);
    std::vector<Profile> profiles = load_profiles(options.capture.profile_paths, diagnostics);
    std::optional<Sequence> sequence = find_sequence(options.capture, profiles, diagnostics);
    if (sequence) sequence->object_names = bound->pipeline.object_names();
    OutputOptions outputs = output_options(options);
    RunOptions settings = run_options(options, diagnostics);
    if (sequence) add_missing_frames(options.capture, settings.missing, *sequence, diagnostics);
    check_outputs(outputs, sequence.value_or(Sequence{}), diagnostics);
    check_worker_options(options, diagnostics);
    const FrameShare share =
        sequence ? share_of_frames(options, bound->pipeline, *sequence, diagnostics) : FrameShare{};
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    const auto profile_documents = documents_of(profiles, *sequence);
    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    if (options.explain) return explain(*sequence, reader, bound->pipeline);
    // A lone frame that cannot be read is reported before a context is made.
    require_first_frame(*sequence, reader, bound->pipeline);
    if (share.run.count() == 0) {
        std::cerr << "--chunk " << options.jobs.chunk
                  << ": no frames; the sequence has fewer frames than chunks\n";
        return ExitCode::done;
    }

    prepare_outputs(options, outputs, *sequence);
    if (options.jobs.wants_workers())
        return run_by_workers(options, share.run, share.workers, progress, stop);
    if (const auto code = run_in_worker(options.plugins, bound->pipeline, stop)) return *code;

    set_exr_threads(options.jobs.worker_threads > 0 ? options.jobs.worker_threads : allotted_cores());
    StatusWriter status;
    NativeRegistry natives(native_search_path({options.plugins.paths.begin(), options.plugins.paths.end()}),
                           shipped_native_libraries(), &status);
    gpu::Context context(backend);
    outputs.renderer = context.info().renderer;
    settings.frames = share.run.frames;
    settings.warmup_frames = share.run.lead_frames;
    settings.natives = {&natives, &status};
    const RunSession session{options,  status,  *sequence, reader,           context,
                             settings, outputs, progress,  profile_documents};
    return run_here(options, session, std::move(bound), std::move(watched), stop);
}

}  // namespace

Verb add_run(CLI::App& app) {
    auto options = std::make_shared<RunArguments>();
    add_run_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
