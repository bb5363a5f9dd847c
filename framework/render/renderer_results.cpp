// What a frame leaves on the GPU: results, taps and numbers about it.
#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/gpu/timer.h"
#include "framework/image/non_finite.h"
#include "framework/image/role.h"
#include "framework/render/built_graph.h"
#include "framework/render/renderer.h"

namespace aftershade {

namespace {

struct ReadImage {
    Image image;
    bool is_finite = false;  ///< seen to be
};

/// Floats of a texture that has as many channels.
ReadImage read_floats(const gpu::Texture& texture) {
    const gpu::TextureDesc& desc = texture.desc();
    ReadImage read{Image(desc.width, desc.height, gpu::channel_count(desc.format)), true};
    texture.read_floats(read.image.floats(), [&](std::span<const float> values) {
        read.is_finite = read.is_finite && are_finite(values);
    });
    return read;
}

ReadImage read_back(const gpu::Texture& texture, int channels) {
    const gpu::TextureDesc& desc = texture.desc();
    const int stored = gpu::channel_count(desc.format);
    if (gpu::is_integer(desc.format)) {
        Image image(desc.width, desc.height, stored, ComponentType::uint32);
        const auto values = texture.read_uints();
        std::copy(values.begin(), values.end(), image.uints().begin());
        return {std::move(image)};
    }
    if (channels == stored) return read_floats(texture);
    Image image(desc.width, desc.height, channels);
    const std::vector<float> values = texture.read_floats();
    for (std::size_t pixel = 0; pixel < values.size() / std::size_t(stored); ++pixel)
        std::copy_n(&values[pixel * std::size_t(stored)], channels,
                    &image.floats()[pixel * std::size_t(channels)]);
    return {std::move(image)};
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
        if (is_new) found->second = read_back(texture, gpu::channel_count(texture.desc().format)).image;
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

void PipelineRenderer::read_results(const std::vector<std::string>& roles, bool timed, FrameResult& result) {
    gpu::Timer timer(context_);
    timer.start();
    graph::Executor& executor = *built_->executor;
    const auto is_kept = [&](const std::string& role) {
        return std::find(kept_on_gpu_.begin(), kept_on_gpu_.end(), role) != kept_on_gpu_.end();
    };
    for (const std::string& role : roles) {
        const auto handle = built_->results.find(role);
        if (handle == built_->results.end() || is_kept(role)) continue;
        ReadImage read = read_back(*executor.texture(handle->second), find_role(role)->channels);
        result.images[role] = std::move(read.image);
        if (read.is_finite) result.finite_roles.insert(role);
    }
    for (const auto& [tap, handle] : built_->taps) {
        const gpu::Texture& texture = *executor.texture(handle);
        result.taps[tap] = read_back(texture, gpu::channel_count(texture.desc().format)).image;
    }
    if (timed) result.times.push_back({"readback", timer.stop_ms()});
}

const gpu::Texture* PipelineRenderer::result_texture(const std::string& role) const {
    if (!built_) return nullptr;
    const auto handle = built_->results.find(role);
    return handle == built_->results.end() ? nullptr : built_->executor->texture(handle->second);
}

}  // namespace aftershade
