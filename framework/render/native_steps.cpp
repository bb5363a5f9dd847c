#include "framework/render/native_steps.h"

#include <cstring>
#include <utility>

#include "framework/image/role.h"
#include "framework/look/pixel_shape.h"
#include "framework/render/frame_blocks.h"

namespace aftershade {

namespace {

NativeDeclaration declaration_of(const EffectManifest& manifest) {
    NativeDeclaration declaration{manifest.id, manifest.version, {}, {}, {}};
    for (const NativeUniformSpec& uniform : manifest.native->uniforms)
        declaration.uniforms[uniform.name] = *parse_native_uniform_type(uniform.type);
    for (const NativeTableSpec& table : manifest.native->tables)
        declaration.tables[table.name] = {*parse_native_element(table.element), table.width, table.height};
    for (const PassSpec& pass : manifest.passes) declaration.passes.push_back(pass.name);
    return declaration;
}

NativeFrame frame_of(const PipelineStep& step, const StepGrid& grid, const FrameInputs& frame,
                     const ParamSet& params, bool history_valid) {
    const CaptureHeader& header = frame.capture->header;
    NativeFrame native;
    native.specs = &step.manifest->params;
    native.params = &params;
    native.camera = &header.camera;
    for (const std::string& name : header.metadata.names())
        if (const auto text = header.metadata.text(name)) native.metadata[name] = *text;
    native.number = header.frame;
    native.fps = frame.fps;
    native.width_px = grid.data_window.width();
    native.height_px = grid.data_window.height();
    native.display_width_px = grid.display_window.width();
    native.display_height_px = grid.display_window.height();
    native.history_valid = history_valid;
    native.step_seed = step_seed(step.name);
    for (const InputSpec& input : step.manifest->inputs) {
        const InputSource& source = step.inputs.at(input.name);
        const bool present =
            step.may_take(input) && (source.step >= 0 || frame.has_image(source.output, input.frame));
        native.images.push_back({input.name, input.image_role(), native.width_px, native.height_px,
                                 find_role(input.role)->channels, present});
    }
    return native;
}

std::string_view level_name(NativeLogLevel level) {
    switch (level) {
        case NativeLogLevel::debug: return "debug: ";
        case NativeLogLevel::info: return "";
        case NativeLogLevel::warning: return "warning: ";
        case NativeLogLevel::error: return "error: ";
    }
    return "";
}

}  // namespace

NativeRegistry& NativeSteps::registry() {
    if (sources_.registry) return *sources_.registry;
    if (!linked_) linked_ = std::make_unique<NativeRegistry>(std::vector<std::filesystem::path>{});
    return *linked_;
}

NativeEffect& NativeSteps::effect(int index, const PipelineStep& step) {
    const auto known = effects_.find(index);
    if (known != effects_.end()) return known->second;
    NativeEffect made(registry(), declaration_of(*step.manifest), step.name, sources_.status);
    return effects_.emplace(index, std::move(made)).first->second;
}

void NativeSteps::prepare(const Pipeline& pipeline, const FrameInputs& frame,
                          const std::vector<ParamSet>& params, bool history_valid) {
    const CaptureHeader& header = frame.capture->header;
    const SquareSteps square(pipeline, header.pixel_aspect);
    for (int i = 0; i < int(pipeline.steps.size()); ++i) {
        const PipelineStep& step = pipeline.steps[std::size_t(i)];
        if (!step.manifest->native) continue;
        NativeResult result = effect(i, step).prepare(
            frame_of(step, square.grid_of(i, header), frame, params[std::size_t(i)], history_valid));
        for (const NativeLogLine& line : result.log)
            messages_.push_back(step.name + ": " + std::string(level_name(line.level)) + line.text);
        const auto before = results_.find(i);
        const bool asks_anew = before == results_.end() ||
                               before->second.warm_up_frames != result.warm_up_frames ||
                               before->second.overscan_px != result.overscan_px;
        if (asks_anew && result.warm_up_frames > 0)
            messages_.push_back(step.name + ": needs " + std::to_string(result.warm_up_frames) +
                                " frames before the first one that counts");
        if (asks_anew && result.overscan_px > 0)
            messages_.push_back(step.name + ": needs " + std::to_string(result.overscan_px) +
                                " px of overscan");
        results_[i] = std::move(result);
    }
}

void NativeSteps::reset() {
    for (auto& [step, effect] : effects_) effect.reset();
}

const NativeResult* NativeSteps::result(int step) const {
    const auto found = results_.find(step);
    return found == results_.end() ? nullptr : &found->second;
}

std::vector<std::string> NativeSteps::take_messages() {
    return std::exchange(messages_, {});
}

gpu::TextureDesc table_desc(NativeElement element, int width, int height) {
    using gpu::TextureFormat;
    constexpr TextureFormat formats[] = {TextureFormat::r32f,    TextureFormat::rg32f,
                                         TextureFormat::rgba32f, TextureFormat::r32ui,
                                         TextureFormat::rg32ui,  TextureFormat::rgba32ui};
    return {width, height, formats[std::size_t(element)]};
}

void upload_table(const NativeTable& table, gpu::Texture& texture) {
    const auto upload = [&]<typename T>(std::vector<T> values) {
        std::memcpy(values.data(), table.bytes.data(), table.bytes.size());
        texture.upload(std::span<const T>(values));
    };
    const std::size_t count = table.bytes.size() / 4;
    if (gpu::is_integer(texture.desc().format)) upload(std::vector<std::uint32_t>(count));
    else upload(std::vector<float>(count));
}

std::map<std::string, std::vector<double>> native_values(const NativeResult& result) {
    std::map<std::string, std::vector<double>> values;
    for (const auto& [name, uniform] : result.uniforms)
        std::visit([&to = values[name]](const auto& numbers) { to.assign(numbers.begin(), numbers.end()); },
                   uniform);
    return values;
}

}  // namespace aftershade
