#include "framework/render/graph_bindings.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/capture/cryptomatte.h"
#include "framework/document/param_type.h"

namespace aftershade {

namespace {

void upload(const Image& image, gpu::Texture& texture) {
    const int stored = gpu::channel_count(texture.desc().format);
    if (image.channels() > stored)
        throw Error(ErrorKind::effect, fmt::format("{}: an image of {} channels, its role has {}",
                                                   texture.label(), image.channels(), stored));
    // Texels of three-channel roles, and of an AOV that has fewer than four, carry zeros that nothing reads.
    if (image.type() == ComponentType::uint32) texture.upload(image.uints());
    else texture.upload(image.floats(), 0, 0, image.channels());
}

void upload(const ParamTexture& source, gpu::Texture& texture) {
    const std::size_t layer_values = source.texels.size() / std::size_t(source.layers);
    for (int layer = 0; layer < source.layers; ++layer)
        texture.upload(std::span(source.texels).subspan(std::size_t(layer) * layer_values, layer_values),
                       layer);
}

std::optional<std::uint32_t> object_id_of_name(const std::string& name) {
    return cryptomatte_hash(name);
}

/// Gives each kind of binding its content. Textures and buffers that no pass needs are not there.
class Giver {
public:
    Giver(const GraphFeed& feed, graph::Executor& executor) : feed_(feed), executor_(executor) {}

    void operator()(const CaptureBinding& binding) const {
        if (feed_.same_captures) return;
        gpu::Texture* texture = executor_.texture(binding.texture);
        const FrameInputs& inputs = feed_.frame.inputs;
        if (!texture || (inputs.fill && inputs.fill(binding.role, binding.offset, *texture))) return;
        upload(inputs.at(binding.offset)->images.at(binding.role), *texture);
    }

    void operator()(ParamBinding& binding) const {
        const ParamValue& value = params(binding.step).get(binding.spec->name);
        if (binding.given == value) return;
        if (gpu::Buffer* buffer = binding.buffer ? executor_.buffer(*binding.buffer) : nullptr)
            buffer->write(
                table_buffer(*binding.spec, binding.spec->type->table->rows(value), object_id_of_name));
        if (gpu::Texture* texture = binding.texture ? executor_.texture(*binding.texture) : nullptr)
            upload(texture_of(binding, value), *texture);
        binding.given = value;
    }

    void operator()(MaskBinding& binding) const {
        if (std::exchange(binding.is_given, true)) return;
        if (gpu::Texture* texture = executor_.texture(binding.texture))
            texture->upload(feed_.files.mask_of(step(binding.step).mask->file).floats());
    }

    void operator()(const NativeTableBinding& binding) const {
        if (gpu::Texture* texture = executor_.texture(binding.texture))
            upload_table(feed_.frame.natives.result(binding.step)->tables.at(binding.table), *texture);
    }

    void operator()(const BlockBinding& binding) const {
        const auto first = std::ranges::lower_bound(binding.places, feed_.first_pass, {}, &BlockPlace::pass);
        if (first == binding.places.end()) return;
        const std::vector<std::byte> bytes = block(binding.kind, binding.step);
        std::for_each(first, binding.places.end(), [&](const BlockPlace& place) {
            executor_.set_uniforms(place.pass, place.binding, bytes);
        });
    }

private:
    const PipelineStep& step(int index) const { return feed_.frame.pipeline.steps[std::size_t(index)]; }
    const ParamSet& params(int step) const { return feed_.frame.params[std::size_t(step)]; }

    ParamTexture texture_of(const ParamBinding& binding, const ParamValue& value) const {
        if (is_param_texture(binding.spec->type)) return param_texture(*binding.spec, value);
        const auto& files = feed_.files.of_step(binding.step, step(binding.step), params(binding.step));
        return file_texture(files.at(binding.spec->name));
    }

    std::vector<std::byte> block(BlockKind kind, int index) const {
        const FrameInputs& inputs = feed_.frame.inputs;
        const EffectManifest& manifest = *step(index).manifest;
        const CaptureHeader& header = inputs.capture->header;
        const StepGrid grid = SquareSteps(feed_.frame.pipeline, header.pixel_aspect).grid_of(index, header);
        switch (kind) {
            case BlockKind::param: return param_block(manifest, params(index));
            case BlockKind::frame:
                return bytes_of(frame_block(inputs, grid, step(index).name, feed_.before.history_valid));
            case BlockKind::camera: return bytes_of(camera_block(inputs, grid, feed_.before));
            case BlockKind::lights: return bytes_of(lights_block(inputs, step(index).name));
            case BlockKind::native:
                return native_block(manifest, native_values(*feed_.frame.natives.result(index)));
            case BlockKind::mix: break;
        }
        return mix_block(step(index), grid, inputs);
    }

    const GraphFeed& feed_;
    graph::Executor& executor_;
};

}  // namespace

int gl_binding(BlockKind kind) {
    switch (kind) {
        case BlockKind::param: return kParamBinding;
        case BlockKind::frame: return kFrameBinding;
        case BlockKind::camera: return kCameraBinding;
        case BlockKind::lights: return kLightsBinding;
        case BlockKind::native: return kNativeBinding;
        case BlockKind::mix: break;
    }
    return kMixBinding;
}

std::size_t block_bytes(BlockKind kind, const EffectManifest& manifest) {
    switch (kind) {
        case BlockKind::param: return param_block_bytes(manifest);
        case BlockKind::frame: return sizeof(FrameBlock);
        case BlockKind::camera: return sizeof(CameraBlock);
        case BlockKind::lights: return sizeof(LightsBlock);
        case BlockKind::native: return native_block(manifest, {}).size();
        case BlockKind::mix: break;
    }
    return kMixBlockBytes;
}

void give(GraphBinding& binding, const GraphFeed& feed, graph::Executor& executor) {
    std::visit(Giver(feed, executor), binding);
}

}  // namespace aftershade
