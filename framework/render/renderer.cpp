#include "framework/render/renderer.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "framework/base/error.h"
#include "framework/gpu/timer.h"
#include "framework/look/pipeline.h"
#include "framework/look/pixel_shape.h"
#include "framework/render/draw_with.h"
#include "framework/render/graph_builder.h"
#include "framework/render/history_file.h"

namespace aftershade {

PipelineRenderer::PipelineRenderer(gpu::Context& context, const Pipeline& pipeline,
                                   const std::filesystem::path& data_folder, NativeSources natives,
                                   const RendererOptions& options)
    : PipelineRenderer(context, pipeline, std::make_shared<ProgramCache>(context, data_folder / "glsl"),
                       natives, options) {}

PipelineRenderer::PipelineRenderer(gpu::Context& context, const Pipeline& pipeline,
                                   std::shared_ptr<ProgramCache> programs, NativeSources natives,
                                   const RendererOptions& options)
    : context_(context),
      pipeline_(pipeline),
      programs_(std::move(programs)),
      status_(natives.status),
      natives_(natives),
      options_(options) {
    options_.draw_with = chosen_draw_with(context_, options.draw_with, *programs_);
    options_.compile_threads =
        options.plain ? 0 : CompileAhead::useful_threads(context_, options.compile_threads);
    const bool guards = options.guards_loops || options.audits;
    if (!guards || context_.info().renderer.find("llvmpipe") == std::string::npos) return;
    loop_guard_.emplace(context_, sizeof(std::uint32_t), "loop guard");
    programs_->guard_loops();
}

PipelineRenderer::~PipelineRenderer() = default;

void PipelineRenderer::resolve(const FrameInputs& frame) {
    params_.clear();
    for (const PipelineStep& step : pipeline_.steps) params_.push_back(resolve_params(step, frame));
}

void PipelineRenderer::prepare(const FrameInputs& frame, const std::vector<std::string>& roles) {
    resolve(frame);
    const bool valid = frame.subframe > 0 || frame_fault_.empty();
    if (!valid) natives_.reset();
    natives_.prepare(pipeline_, frame, params_, valid);
    const GraphFrame graph_frame{pipeline_, frame, params_, natives_, roles};
    const bool is_stale = std::exchange(is_stale_, false);
    if (built_ && !is_stale && built_->key.holds(graph_frame)) return;
    // The old textures go before the new ones come, unless what they hold lives on.
    std::unique_ptr<BuiltGraph> old = std::move(built_);
    if (!pipeline_.has_history()) old.reset();
    build(frame, roles, false);
    if (old) built_->executor->take_history_from(*old->executor);
}

namespace {

void require_room(const Pipeline& pipeline, const CaptureHeader& header, int most_px) {
    const SquareSteps steps(pipeline, header.pixel_aspect);
    const Window window = stretched(header.data_window, header.display_window, steps.stretch());
    if (steps.stretch().is_none() || std::max(window.width(), window.height()) <= most_px) return;
    throw Error(ErrorKind::capture,
                header.path.string() + ": " + steps.note(pipeline, header) +
                    ", and a side may have at most " + std::to_string(most_px) +
                    " with this renderer (correct pixelAspectRatio, or resample the frame to square pixels)");
}

}  // namespace

void PipelineRenderer::build(const FrameInputs& frame, const std::vector<std::string>& roles, bool primes) {
    require_room(pipeline_, frame.capture->header, context_.info().texture_side_px);
    built_ = build_graph({context_, *programs_, files_, options_, status_, primes},
                         {pipeline_, frame, params_, natives_, roles});
    ++graphs_built_;
    set_hooks();
}

bool PipelineRenderer::can_build_ahead() const {
    const bool reports = status_ && status_->active();
    return !built_ && !reports && !options_.plain &&
           std::ranges::none_of(pipeline_.steps, [](const PipelineStep& step) {
               return step.manifest->native || std::ranges::any_of(step.values, [](const auto& value) {
                          return !roles_of(value.second).empty();
                      });
           });
}

void PipelineRenderer::build_ahead(const FrameInputs& frame, const std::vector<std::string>& roles) {
    // Of a role that is missing, rendering says what to do.
    if (!can_build_ahead() || !find_missing_roles(pipeline_, frame.capture->header).empty()) return;
    try {
        resolve(frame);
        build(frame, roles, true);
    } catch (const Error& error) {
        built_.reset();
        if (error.kind() == ErrorKind::memory) throw;
    }
}

void PipelineRenderer::feed(const GraphFeed& feed, PendingFrame& pending) {
    gpu::Timer timer(context_);
    if (pending.is_timed) timer.start();
    built_->feed(feed);
    if (pending.is_timed) pending.uploads.push_back(timer.stop());
}

int PipelineRenderer::programs_compiled_ahead() const {
    return built_ && built_->ahead ? built_->ahead->programs_made() : 0;
}

namespace {

/// The step of a pass of the graph, "step.pass" or "step.pass[2]"; nullptr for the host's own passes.
const PipelineStep* step_of(const Pipeline& pipeline, const std::string& pass) {
    for (const PipelineStep& step : pipeline.steps)
        if (pass.starts_with(step.name + ".")) return &step;
    return nullptr;
}

}  // namespace

void PipelineRenderer::set_hooks() {
    graph::Executor::PassHooks hooks;
    const bool reports = status_ && status_->active();
    hooks.waits = reports;  // the status names the pass that the GPU draws
    if (reports || built_->ahead)
        hooks.begins = [this, reports](const std::string& pass) {
            const PipelineStep* step = reports ? step_of(pipeline_, pass) : nullptr;
            if (step)
                status_->write(status_of_pass(*step, pass.substr(step->name.size() + 1), "draw", status_));
            if (built_->ahead) built_->ahead->take(pass);
        };
    if (loop_guard_) {
        hooks.storage = {&*loop_guard_, kLoopGuardBinding};
        hooks.ended = [this](const std::string& pass) { require_whole_loops(pass); };
    }
    built_->executor->set_hooks(std::move(hooks));
}

void PipelineRenderer::require_whole_loops(const std::string& pass) {
    const std::vector<std::byte> word = loop_guard_->read();
    if (std::ranges::all_of(word, [](std::byte byte) { return byte == std::byte{0}; })) return;
    loop_guard_->clear(0);
    throw Error(ErrorKind::effect,
                "pass '" + pass +
                    "': llvmpipe ended its loops after 65,535 iterations, so the picture is wrong; end the "
                    "loops earlier, or split the work over a pass with \"repeat\"");
}

void PipelineRenderer::issue_passes(graph::PassRange range, PendingFrame& pending) {
    const auto observer =
        options_.audits ? auditor(pipeline_, pending.result.audit) : graph::Executor::PassObserver{};
    auto times = built_->executor->issue(pending.is_timed, observer, range);
    std::ranges::move(times, std::back_inserter(pending.passes));
    if (!status_ || !status_->active()) return;
    WorkStatus between;
    between.frame = status_->current().frame;
    status_->write(between);
}

FrameResult PipelineRenderer::render(const FrameInputs& frame, const std::vector<std::string>& roles,
                                     bool timed) {
    return begin(frame, roles, timed).finish();
}

PendingFrame PipelineRenderer::begin(const FrameInputs& frame, const std::vector<std::string>& roles,
                                     bool timed) {
    const bool is_first = frame.subframe == 0;
    mixes_drawn_.clear();
    if (saved_) begin_from_saved(frame);
    if (is_first) frame_fault_ = history_fault(frame);
    prepare(frame, roles);
    if (saved_) restore(*std::exchange(saved_, nullptr));
    if (is_first && !frame_fault_.empty()) built_->executor->clear_history();
    PendingFrame pending(context_);
    pending.is_timed = timed;
    FrameResult& result = pending.result;
    result.messages = natives_.take_messages();
    const float aspect = frame.capture->header.pixel_aspect;
    if (aspect != std::exchange(aspect_, aspect))
        if (std::string note = SquareSteps(pipeline_, aspect).note(pipeline_, frame.capture->header);
            !note.empty())
            result.messages.push_back("note: " + std::move(note));
    for (const std::string& warning : programs_->take_warnings())
        result.messages.push_back("warning: " + warning);
    if (pipeline_.has_history() && is_first) result.history_reset = frame_fault_;

    const bool accumulates = built_->first_single_pass > 0 && frame.subframe_count > 1;
    const auto graph_frame = [&](const FrameInputs& inputs) {
        return GraphFrame{pipeline_, inputs, params_, natives_, roles};
    };
    if (accumulates) {
        const bool valid = !is_first || frame_fault_.empty();
        const auto before = valid && last_ ? std::optional(last_->camera) : std::nullopt;
        feed({graph_frame(frame), {valid, before}, files_, 0}, pending);
        issue_passes({0, built_->first_single_pass}, pending);
    }
    const CaptureHeader& header = frame.capture->header;
    last_ = {header.frame, header.data_window, header.camera, header.pixel_aspect};
    is_partial_ = accumulates && frame.subframe + 1 < frame.subframe_count;
    pending.is_partial = is_partial_;
    if (is_partial_) return pending;

    FrameInputs once = frame;
    if (accumulates && frame.centre) {
        once.capture = frame.centre;
        resolve(once);
    }
    const bool valid = frame_fault_.empty();
    const int first_pass = accumulates ? built_->first_single_pass : 0;
    const auto before = valid ? camera_before_ : std::nullopt;
    feed({graph_frame(once), {valid, before}, files_, first_pass}, pending);
    camera_before_ = once.capture->header.camera;
    if (options_.audits)
        for (const GraphBinding& binding : built_->bindings)
            if (const auto* input = std::get_if<CaptureBinding>(&binding))
                audit_image(input->role, once.at(input->offset)->images.at(input->role), "capture",
                            "capture." + input->role.name(), result.audit);
    issue_passes({first_pass, -1}, pending);
    begin_reads(roles, pending);
    set_encodings(result);
    if (options_.telemetry) result.telemetry = read_telemetry(header.frame);
    steps_drawn_ = int(pipeline_.steps.size());
    mixes_drawn_ = mixes();
    return pending;
}

std::vector<std::string> PipelineRenderer::mixes() const {
    std::vector<std::string> mixes;
    for (const PipelineStep& step : pipeline_.steps) mixes.push_back(format_source(step.mix));
    return mixes;
}

int PipelineRenderer::first_changed_step(const std::vector<ParamSet>& before,
                                         const std::vector<std::string>& mixes_before) const {
    const std::vector<std::string> now = mixes();
    const std::size_t count = std::min({before.size(), params_.size(), now.size(), mixes_before.size()});
    std::size_t step = 0;
    while (step < count && before[step] == params_[step] && now[step] == mixes_before[step]) ++step;
    return int(step);
}

FrameResult PipelineRenderer::render_again(const FrameInputs& frame, const std::vector<std::string>& roles,
                                           bool timed) {
    const bool may_keep = options_.keeps_steps && built_ && !is_stale_ && !saved_ && !options_.audits &&
                          !pipeline_.has_history() && frame.subframe_count == 1 &&
                          params_.size() == pipeline_.steps.size() && !mixes_drawn_.empty();
    if (!may_keep) return render(frame, roles, timed);
    const std::vector<ParamSet> before = params_;
    resolve(frame);
    natives_.reset();
    natives_.prepare(pipeline_, frame, params_, false);
    const GraphFrame graph_frame{pipeline_, frame, params_, natives_, roles};
    if (!built_->key.holds(graph_frame)) return render(frame, roles, timed);

    const int first = first_changed_step(before, mixes_drawn_);
    const bool is_same = first == int(pipeline_.steps.size());
    const int first_pass =
        is_same ? built_->executor->graph().pass_count() : built_->first_pass_of_step[std::size_t(first)];
    // Until it is drawn, nothing stands for these values.
    mixes_drawn_.clear();
    PendingFrame pending(context_);
    pending.is_timed = timed;
    pending.result.messages = natives_.take_messages();
    feed({graph_frame, {false, std::nullopt}, files_, first_pass, true}, pending);
    issue_passes({first_pass, -1}, pending);
    begin_reads(roles, pending);
    steps_drawn_ = int(pipeline_.steps.size()) - first;
    mixes_drawn_ = mixes();
    return pending.finish();
}

std::string PipelineRenderer::graph_dot() const {
    return built_ ? graph::to_dot(built_->executor->graph(), built_->executor->compiled()) : "";
}

std::vector<DrawnPass> PipelineRenderer::draws() const {
    std::vector<DrawnPass> draws;
    if (!built_) return draws;
    const graph::FrameGraph& graph = built_->executor->graph();
    for (const int index : built_->executor->compiled().passes) {
        const graph::Pass& pass = graph.pass(index);
        if (pass.kind == graph::PassKind::draw || pass.kind == graph::PassKind::instances)
            draws.push_back({pass.name, pass.computes(), pass.why_drawn});
    }
    return draws;
}

std::pair<std::uint64_t, std::uint64_t> PipelineRenderer::graph_bytes() const {
    if (!built_) return {0, 0};
    const graph::CompiledGraph& compiled = built_->executor->compiled();
    return {compiled.bytes, compiled.bytes_unaliased};
}

}  // namespace aftershade
