#include "framework/host/rendering.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "framework/base/cores.h"
#include "framework/base/text.h"
#include "framework/gpu/external_texture.h"
#include "framework/host/host_non_finite.h"
#include "framework/image/role.h"
#include "framework/render/frame_drive.h"
#include "framework/run/nan_policy.h"

namespace aftershade::host {

namespace {

bool contains(const std::vector<std::string>& list, const std::string& item) {
    return std::find(list.begin(), list.end(), item) != list.end();
}

gpu::ExternalTexture external(const GlTexture& texture) {
    return {texture.name, texture.width, texture.height, texture.bottom_up};
}

void check_external(gpu::Context& context, const GlTexture& texture, const std::string& role) {
    const ChannelRole known = *find_role(role);
    gpu::check_external_texture(context, external(texture), known.channels,
                                known.type == ComponentType::uint32, role);
}

bool needs_color(const PipelineStep& step) {
    return std::ranges::any_of(step.manifest->inputs, [&](const InputSpec& input) {
        return !input.optional && step.inputs.at(input.name) == InputSource{-1, kColorRole};
    });
}

void require_roles(const Pipeline& pipeline, const aftershade::Capture& capture) {
    const bool is_of_files = !capture.header.path.empty();
    if (is_of_files) require_capture_roles(pipeline, capture.header);
    aftershade::CaptureHeader read = capture.header;
    read.roles.clear();
    for (const auto& [role, image] : capture.images)
        if (!role.is_coverage()) read.roles.push_back(role.name());
    const std::string there = read.roles.empty() ? "no images" : list_of_names(read.roles, "and");
    // Whoever read a file without its color takes other outputs.
    if (is_of_files && std::ranges::none_of(pipeline.steps, needs_color)) read.roles.push_back(kColorRole);
    std::vector<std::string> needs;
    for (const MissingRole& missing : find_missing_roles(pipeline, read)) needs.push_back(need_of(missing));
    // Files have a coverage by Cryptomattes, too, which is read where the look asks for it.
    const std::vector<RoleId> roles = pipeline.capture_roles();
    const auto lacks = [&](const RoleId& role) {
        return role.is_coverage() && !capture.images.contains(role);
    };
    const auto coverage = std::ranges::find_if(roles, lacks);
    if (coverage != roles.end() && !capture.images.contains(kObjectIdRole))
        needs.push_back("the " + coverage->name() + " needs the role 'object_id'");
    if (needs.empty()) return;
    const std::string them = needs.size() == 1 ? "it" : "them";
    fail_at(ErrorKind::capture, "capture",
            joined(needs, " and ") + "; the capture has " + there + " (" +
                (is_of_files ? "render " + them + ", or add " + them + " to CaptureOptions::roles)"
                             : "add " + them + " by set_image or set_texture)"));
}

void require_same_window(const Capture::Data& capture, const Capture::Data* other, const char* option) {
    if (other && !(other->capture.header.data_window == capture.capture.header.data_window))
        fail_at(ErrorKind::usage, option, "its data window is not that of the frame");
}

/// Roles whose values steps take: they must be in memory.
std::vector<RoleId> roles_of_values(const Pipeline& pipeline) {
    std::vector<RoleId> roles;
    for (const PipelineStep& step : pipeline.steps) {
        for (const RoleId& role : roles_of(step.mix)) roles.push_back(role);
        for (const auto& [name, source] : step.values)
            for (const RoleId& role : roles_of(source)) roles.push_back(role);
    }
    return roles;
}

}  // namespace

std::vector<std::string> made_roles(const Pipeline& pipeline) {
    std::vector<std::string> roles;
    for (const PipelineStep& step : pipeline.steps)
        for (const OutputSpec& output : step.manifest->outputs)
            if (!contains(roles, output.role)) roles.push_back(output.role);
    std::sort(roles.begin(), roles.end());
    return roles;
}

Rendering::Rendering(std::shared_ptr<Host::Data> host, std::shared_ptr<const LookCore> look)
    : host_(std::move(host)), look_(std::move(look)) {}

Rendering::~Rendering() {
    if (gpu::is_forked_from_gl()) {
        gpu::leave_to_exit(std::move(look_));  // the renderer refers to its pipeline
        gpu::leave_to_exit(std::move(renderer_));
        gpu::leave_to_exit(std::move(host_));
        return;
    }
    std::unique_lock lock(host_->mutex);
    host_->renderings.erase(this);
    if (!renderer_) return;
    if (host_->owner != std::this_thread::get_id()) {
        // The renderer refers to the look's pipeline.
        struct Left {
            std::shared_ptr<const LookCore> look;
            std::shared_ptr<PipelineRenderer> renderer;
        };
        host_->left.push_back(std::make_shared<Left>(Left{look_, std::move(renderer_)}));
        return;
    }
    lock.unlock();
    const gpu::ForeignContextGuard foreign;
    renderer_.reset();
}

PipelineRenderer& Rendering::renderer() {
    gpu::Context& context = host_->context();
    if (!renderer_) {
        RendererOptions options;
        // Which threads use the display of a shared context is for the calling program to say.
        if (!host_->options.share) options.compile_threads = allotted_cores() - 1;
        renderer_ = std::make_shared<PipelineRenderer>(context, look_->pipeline, host_->programs(),
                                                       NativeSources{host_->natives.get(), nullptr}, options);
        form_ = look_->form;
        const std::lock_guard lock(host_->mutex);
        host_->renderings.insert(this);
    }
    if (std::exchange(form_, look_->form) != look_->form) renderer_->pipeline_changed();
    return *renderer_;
}

void Rendering::prepare(const RenderOptions& options) {
    if (!(options.fps > 0 && std::isfinite(options.fps)))
        fail_at(ErrorKind::usage, "RenderOptions::fps",
                fmt::format("{:g} is not above 0 and finite", options.fps));
    if (int(options.non_finite) < int(NonFinite::ignore) || int(options.non_finite) > int(NonFinite::mend))
        fail_at(ErrorKind::usage, "RenderOptions::non_finite",
                fmt::format("{} is not one of its values", int(options.non_finite)));
    if (options.stop.stop_requested()) fail(ErrorKind::interrupted, "a stop was requested");
    if ((!options.targets.empty() || options.wait) && !host_->options.share)
        fail_at(ErrorKind::usage, "RenderOptions", "targets and wait need HostOptions::share");
    PipelineRenderer& renderer = this->renderer();
    std::vector<std::string> kept;
    for (const auto& [role, texture] : options.targets) kept.push_back(role);
    renderer.keep_on_gpu(std::move(kept));
    renderer.set_telemetry(options.telemetry);
    if (options.wait) gpu::wait_for_fence(host_->context(), options.wait);
}

std::vector<std::string> Rendering::asked_roles(const RenderOptions& options,
                                                const std::vector<std::string>& captured) const {
    const std::vector<std::string> made = made_roles(look_->pipeline);
    std::vector<std::string> roles = options.roles;
    if (roles.empty()) roles = made.empty() ? std::vector<std::string>{kColorRole} : made;
    for (const std::string& role : roles) {
        if (!find_role(role))
            fail_at(ErrorKind::usage, "RenderOptions::roles",
                    "'" + role + "' is not a role" + did_you_mean(role, role_names()));
        if (!contains(made, role) && !contains(captured, role))
            fail_at(ErrorKind::capture, "RenderOptions::roles",
                    "no step makes '" + role + "', and the capture does not have it");
    }
    for (const auto& [role, texture] : options.targets) {
        if (!contains(made, role))
            fail_at(ErrorKind::usage, "RenderOptions::targets",
                    "no step makes '" + role + "'" + did_you_mean(role, made));
        if (!contains(roles, role)) roles.push_back(role);
    }
    std::sort(roles.begin(), roles.end());
    roles.erase(std::unique(roles.begin(), roles.end()), roles.end());
    return roles;
}

void Rendering::check_targets(const RenderOptions& options, const aftershade::Window& window) {
    for (const auto& [role, texture] : options.targets) {
        if (texture.width != window.width() || texture.height != window.height())
            fail_at(ErrorKind::usage, "RenderOptions::targets",
                    fmt::format("'{}': the texture has {} x {} texels, the data window {} x {} px", role,
                                texture.width, texture.height, window.width(), window.height()));
        check_external(host_->context(), texture, role);
    }
}

namespace {

/// The pixels of a shared texture, in memory.
aftershade::Image read_texture(gpu::Context& context, const GlTexture& texture, const std::string& role) {
    check_external(context, texture, role);
    const ChannelRole known = *find_role(role);
    const bool is_uint = known.type == ComponentType::uint32;
    gpu::Texture copy(
        context,
        {texture.width, texture.height, is_uint ? gpu::TextureFormat::r32ui : gpu::TextureFormat::rgba32f},
        role);
    gpu::copy_texture(context, external(texture), copy);
    aftershade::Image image(texture.width, texture.height, known.channels, known.type);
    if (is_uint) {
        std::ranges::copy(copy.read_uints(), image.uints().begin());
        return image;
    }
    const std::vector<float> texels = copy.read_floats();
    const auto channels = std::size_t(known.channels);
    for (std::size_t i = 0; i < texels.size() / 4; ++i)
        std::copy_n(&texels[i * 4], channels, &image.floats()[i * channels]);
    return image;
}

/// The capture with those images in memory that values are taken from.
std::shared_ptr<const Capture::Data> with_values_in_memory(
    gpu::Context& context, const std::shared_ptr<const Capture::Data>& capture, const Pipeline& pipeline) {
    std::shared_ptr<Capture::Data> filled;
    for (const RoleId& role : roles_of_values(pipeline)) {
        const auto texture = capture->textures.find(role.name());
        if (texture == capture->textures.end()) continue;
        if (!filled) filled = std::make_shared<Capture::Data>(*capture);
        filled->capture.images[role] = read_texture(context, texture->second, role.name());
    }
    return filled ? filled : capture;
}

}  // namespace

Result::Data Rendering::render(const FrameTask& task, const RenderOptions& options) {
    const Pipeline& pipeline = look_->pipeline;
    const Capture::Data& given = *task.capture;
    const std::vector<std::string> roles = asked_roles(options, given.capture.header.roles);
    require_roles(pipeline, given.capture);
    require_same_window(given, task.previous.get(), "RenderOptions::previous");
    require_same_window(given, task.next.get(), "RenderOptions::next");
    prepare(options);
    gpu::Context& context = host_->context();
    check_targets(options, given.capture.header.data_window);

    Result::Data result;
    result.is_pending = pipeline.last_accumulating_step() >= 0 && task.subframe + 1 < task.subframe_count;
    const auto seen = [&](const std::shared_ptr<const Capture::Data>& capture) {
        if (!capture) return capture;
        return with_values_in_memory(context, meet_non_finite(capture, options.non_finite, result.non_finite),
                                     pipeline);
    };
    const auto current = seen(task.capture), previous = seen(task.previous), next = seen(task.next);
    result.capture = {current, &current->capture};
    FrameSetting setting{{}, task.begins_shot, task.subframe_count, given.scale, options.fps};
    if (previous) setting.neighbours[-1] = {previous, &previous->capture};
    if (next) setting.neighbours[1] = {next, &next->capture};
    FrameInputs frame =
        setting.inputs(current->capture, task.subframe, task.centre ? &task.centre->capture : nullptr);
    frame.fill = [&](const RoleId& role, int offset, gpu::Texture& texture) {
        const auto& from = offset == -1 ? previous : offset == 1 ? next : current;
        const auto found = from->textures.find(role.name());
        if (found == from->textures.end()) return false;
        check_external(context, found->second, role.name());
        gpu::copy_texture(context, external(found->second), texture);
        return true;
    };
    FrameResult made = renderer().render(frame, roles, options.timed);
    if (options.non_finite != NonFinite::ignore) {
        const NanPolicy policy = options.non_finite == NonFinite::mend ? NanPolicy::mend : NanPolicy::warn;
        const auto found = non_finite_of(apply_nan_policy(policy, made));
        if (options.non_finite == NonFinite::fail && !found.empty()) refuse_non_finite(found.front());
        result.non_finite.insert(result.non_finite.end(), found.begin(), found.end());
    }
    result.frame = std::make_shared<const FrameResult>(std::move(made));
    finish(options, roles, result);
    return result;
}

void Rendering::finish(const RenderOptions& options, const std::vector<std::string>& roles,
                       Result::Data& result) {
    gpu::Context& context = host_->context();
    result.renderer = context.info().renderer;
    result.gpu_bytes = renderer_->graph_bytes().first;
    result.is_timed = options.timed;
    result.documents = look_->documents;
    for (const std::string& role : roles)
        if (!options.targets.contains(role)) result.roles.push_back(role);
    if (result.is_pending) return;
    for (const auto& [role, texture] : options.targets) {
        check_external(context, texture, role);
        gpu::copy_texture(context, *renderer_->result_texture(role), external(texture));
    }
    if (options.wants_fence) result.fence = gpu::insert_fence(context);
    else if (!options.targets.empty()) context.finish();
}

}  // namespace aftershade::host
