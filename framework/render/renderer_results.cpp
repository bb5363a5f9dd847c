// What a frame leaves on the GPU: results, taps and numbers about it, and what the numbers of its colours
// mean where OpenColorIO has taken them to another space.
#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/effect/color_param.h"
#include "framework/gpu/timer.h"
#include "framework/image/non_finite.h"
#include "framework/image/role.h"
#include "framework/render/built_graph.h"
#include "framework/render/renderer.h"

namespace aftershade {

namespace {

/// `channels` of a texture of floats; 0, and of integers: as many as it has.
PendingFrame::Read begin_read(const std::string& name, const gpu::Texture& texture, int channels = 0,
                              gpu::ReadAs as = gpu::ReadAs::stored) {
    const gpu::TextureDesc& desc = texture.desc();
    const bool is_integer = gpu::is_integer(desc.format);
    if (channels == 0 || is_integer) channels = gpu::channel_count(desc.format);
    const ComponentType type = is_integer ? ComponentType::uint32 : ComponentType::float32;
    return {name, false, Image(desc.width, desc.height, channels, type, FirstValues::unwritten),
            texture.begin_read(channels, as)};
}

/// Whether all values were seen to be finite.
bool fill(PendingFrame::Read& read) {
    if (read.image.type() == ComponentType::uint32) {
        read.texels.finish(read.image.uints());
        return false;
    }
    std::atomic<bool> is_finite = true;
    read.texels.finish(read.image.floats(), [&](std::span<const float> values) {
        if (is_finite && !are_finite(values)) is_finite = false;
    });
    return is_finite;
}

Image read_back(const gpu::Texture& texture) {
    PendingFrame::Read read = begin_read("", texture);
    fill(read);
    return std::move(read.image);
}

}  // namespace

FrameTelemetry PipelineRenderer::read_telemetry(int frame) const {
    FrameTelemetry telemetry;
    telemetry.frame = frame;
    graph::Executor& executor = *built_->executor;
    std::map<std::pair<int, int>, Image> read;  // by handle
    const auto image = [&](const graph::TextureHandle& handle) -> const Image& {
        const auto [found, is_new] = read.try_emplace({handle.texture, handle.version});
        const gpu::Texture& texture = *executor.texture(handle);
        if (is_new) found->second = read_back(texture);
        return found->second;
    };
    for (std::size_t i = 0; i < pipeline_.steps.size(); ++i)
        for (const TelemetrySpec& spec : pipeline_.steps[i].manifest->telemetry)
            if (const auto textures = find_textures(built_->textures[i], spec))
                telemetry.steps[pipeline_.steps[i].name][spec.name] = statistic_of(
                    spec, image(textures->of), textures->where ? &image(*textures->where) : nullptr);
    const graph::CompiledGraph& compiled = executor.compiled();
    for (const gpu::TextureDesc& slot : compiled.slots) {
        FormatMemory& format = telemetry.textures[std::string(gpu::texture_format_name(slot.format))];
        ++format.textures;
        format.bytes += gpu::byte_size(slot);
    }
    for (const graph::BufferDesc& slot : compiled.buffer_slots) telemetry.buffer_bytes += slot.bytes;
    telemetry.bytes = compiled.bytes;
    telemetry.bytes_unaliased = compiled.bytes_unaliased;
    return telemetry;
}

void PipelineRenderer::begin_reads(const std::vector<std::string>& roles, PendingFrame& pending) {
    gpu::Timer timer(context_);
    const bool are_issued = context_.info().maps_transfers;
    if (pending.is_timed && are_issued) timer.start();
    graph::Executor& executor = *built_->executor;
    const auto has = [](const std::vector<std::string>& list, const std::string& role) {
        return std::ranges::find(list, role) != list.end();
    };
    for (const std::string& role : roles) {
        const auto handle = built_->results.find(role);
        if (handle == built_->results.end() || has(kept_on_gpu_, role)) continue;
        const auto as = has(read_as_halfs_, role) ? gpu::ReadAs::halfs : gpu::ReadAs::stored;
        pending.reads.push_back(
            begin_read(role, *executor.texture(handle->second), find_role(role)->channels, as));
    }
    for (const auto& [tap, handle] : built_->taps) {
        pending.reads.push_back(begin_read(tap, *executor.texture(handle)));
        pending.reads.back().is_tap = true;
    }
    if (pending.is_timed && are_issued) pending.readback = timer.stop();
}

FrameResult PendingFrame::finish() {
    gpu::Timer timer(context_);
    const bool reads_now = is_timed && !is_partial && !readback;
    if (reads_now) timer.start();
    for (Read& read : reads) {
        const bool is_finite = fill(read);
        if (is_finite && !read.is_tap) result.finite_roles.insert(read.name);
        (read.is_tap ? result.taps : result.images)[read.name] = std::move(read.image);
    }
    if (reads_now) readback = timer.stop();
    result.times = measured(std::move(passes));
    if (!is_timed || is_partial) return std::move(result);
    double upload_ms = 0;
    for (gpu::Duration& upload : uploads) upload_ms += upload.ms();
    result.times.insert(result.times.begin(), {"upload", upload_ms});
    result.times.push_back({"readback", readback->ms()});
    if (result.telemetry) result.telemetry->passes = result.times;
    return std::move(result);
}

const gpu::Texture* PipelineRenderer::result_texture(const std::string& role) const {
    if (!built_) return nullptr;
    const auto handle = built_->results.find(role);
    return handle == built_->results.end() ? nullptr : built_->executor->texture(handle->second);
}

namespace {

bool outputs(const PipelineStep& step, const std::string& role) {
    return std::ranges::find(step.manifest->outputs, role, &OutputSpec::role) != step.manifest->outputs.end();
}

bool takes(const PipelineStep& step, const std::string& role) {
    return std::ranges::find(step.manifest->inputs, role, &InputSpec::role) != step.manifest->inputs.end();
}

const ParamSpec* config_of(const PipelineStep& step) {
    const auto& params = step.manifest->params;
    const auto config = std::ranges::find(params, FileKind::ocio_config, &ParamSpec::file_kind);
    return config == params.end() ? nullptr : &*config;
}

/// Unknown where the step's file is not loaded.
ColorEncoding made_by(const StepFiles& files, int index, const ParamSpec& config) {
    const auto* transform = std::get_if<ColorTransform>(files.loaded(index, config.name));
    return transform ? transform->encoding : ColorTransform{}.encoding;
}

/// Whether the step's conversion is to a space, not back to the capture's primaries.
bool has_destination(const PipelineStep& step) {
    return std::ranges::any_of(step.manifest->params, [&](const ParamSpec& spec) {
        return spec.ocio == "destination" &&
               std::ranges::any_of(step.known_values(spec), [](const ParamValue& value) {
                   return !std::get<std::string>(value).empty();
               });
    });
}

}  // namespace

void PipelineRenderer::set_encodings(FrameResult& result) const {
    for (int index = int(pipeline_.steps.size()) - 1; index >= 0; --index) {
        const PipelineStep& step = pipeline_.steps[std::size_t(index)];
        const ParamSpec* const config = config_of(step);
        if (!outputs(step, kDisplayRole) || (!config && takes(step, kDisplayRole))) continue;
        if (config) result.display_encoding = made_by(files_, index, *config);
        break;
    }
    for (int index = int(pipeline_.steps.size()) - 1; index >= 0; --index) {
        const PipelineStep& step = pipeline_.steps[std::size_t(index)];
        const ParamSpec* const config = config_of(step);
        if (!config || !outputs(step, kColorRole)) continue;
        if (has_destination(step)) result.color_encoding = made_by(files_, index, *config);
        break;
    }
}

}  // namespace aftershade
