#include "framework/pipeline/renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/core/error.h"
#include "framework/gpu/timer.h"
#include "framework/image/role.h"
#include "framework/pipeline/graph_builder.h"

namespace aftershade {

namespace {

/// Texels of three-channel roles carry a fourth that nothing reads.
std::vector<float> widened(std::span<const float> rgb) {
    std::vector<float> rgba(rgb.size() / 3 * 4);
    for (std::size_t i = 0; i < rgb.size() / 3; ++i) std::copy_n(&rgb[i * 3], 3, &rgba[i * 4]);
    return rgba;
}

Image read_back(const gpu::Texture& texture, int channels) {
    const gpu::TextureDesc& desc = texture.desc();
    if (gpu::is_integer(desc.format)) {
        Image image(desc.width, desc.height, gpu::channel_count(desc.format), ComponentType::uint32);
        const auto values = texture.read_uints();
        std::copy(values.begin(), values.end(), image.uints().begin());
        return image;
    }
    const std::vector<float> values = texture.read_floats();
    const int stored = gpu::channel_count(desc.format);
    Image image(desc.width, desc.height, channels);
    for (std::size_t pixel = 0; pixel < values.size() / std::size_t(stored); ++pixel)
        std::copy_n(&values[pixel * std::size_t(stored)], channels,
                    &image.floats()[pixel * std::size_t(channels)]);
    return image;
}

bool infinity_allowed(const std::string& role) {
    return std::isinf(find_role(role)->outside);
}

void audit_input(const std::string& role, const Image& image, std::vector<AuditFinding>& findings) {
    if (image.type() != ComponentType::float32) return;
    audit_values(image.floats(), image.width(), image.channels(), infinity_allowed(role), "capture",
                 "capture." + role, findings);
}

/// Integer textures hold ids and packed bits, of which no value is wrong.
graph::Executor::PassObserver auditor(const Pipeline& pipeline, std::vector<AuditFinding>& findings) {
    std::map<std::string, std::string> role_of_output;
    for (const PipelineStep& step : pipeline.steps)
        for (const OutputSpec& output : step.manifest->outputs)
            role_of_output[step.name + "." + output.name] = output.role;
    return [role_of_output, &findings](const std::string& pass, const std::string& texture,
                                       const gpu::Texture& target) {
        const gpu::TextureDesc& desc = target.desc();
        if (gpu::is_integer(desc.format)) return;
        const auto role = role_of_output.find(texture);
        const bool infinity = role != role_of_output.end() && infinity_allowed(role->second);
        audit_values(target.read_floats(), desc.width, gpu::channel_count(desc.format), infinity, pass,
                     texture, findings);
    };
}

}  // namespace

/// A frame graph for one size and one choice of passes.
struct PipelineRenderer::Built {
    struct BoundPass {
        int step = 0;
        int pass = 0;  // in the graph
        bool has_params = false;
    };
    std::string key;
    std::map<std::string, graph::TextureHandle> imports;             // by role of the capture
    std::vector<std::map<std::string, graph::TextureHandle>> names;  // per step: textures and outputs
    std::map<std::string, graph::TextureHandle> results;             // by role
    std::vector<BoundPass> passes;
    std::unique_ptr<graph::Executor> executor;
};

PipelineRenderer::PipelineRenderer(gpu::Context& context, const Pipeline& pipeline,
                                   const std::filesystem::path& data_folder)
    : context_(context), pipeline_(pipeline), programs_(context, data_folder / "glsl") {}

PipelineRenderer::~PipelineRenderer() = default;

std::string PipelineRenderer::graph_key(const Capture& capture, const std::vector<ParamSet>& params,
                                        const std::vector<std::string>& roles) const {
    std::string key = std::to_string(capture.header.data_window.width()) + "x" +
                      std::to_string(capture.header.data_window.height());
    for (const auto& [role, image] : capture.images) key += " " + role;
    for (const std::string& role : roles) key += " >" + role;
    for (std::size_t i = 0; i < pipeline_.steps.size(); ++i) {
        const EffectManifest& manifest = *pipeline_.steps[i].manifest;
        for (const ParamSpec& spec : manifest.params)
            if (spec.bind == ParamBind::define) key += " " + format_value(params[i].get(spec.name));
        for (const PassSpec& pass : manifest.passes)
            for (const WhenSpec& condition : pass.when)
                if (params[i].has(condition.subject))
                    key += " " + format_value(params[i].get(condition.subject));
    }
    return key;
}

std::unique_ptr<PipelineRenderer::Built> PipelineRenderer::build(const Capture& capture,
                                                                 const std::vector<ParamSet>& params,
                                                                 const std::vector<std::string>& roles) {
    auto built = std::make_unique<Built>();
    GraphBuilder builder(programs_, pipeline_, capture);
    for (int i = 0; i < int(pipeline_.steps.size()); ++i) {
        const EffectManifest& manifest = *pipeline_.steps[std::size_t(i)].manifest;
        const auto bound = [&](int pass) { built->passes.push_back({i, pass, has_param_block(manifest)}); };
        built->names.push_back(builder.add_step(i, params[std::size_t(i)], built->names, bound));
        for (const OutputSpec& output : manifest.outputs)
            built->results[output.role] = built->names.back().at(output.name);
    }
    for (const std::string& role : roles)
        if (const auto result = built->results.find(role); result != built->results.end())
            builder.graph.keep(result->second);
    for (const Tap& tap : pipeline_.taps) {
        for (std::size_t i = 0; i < pipeline_.steps.size(); ++i) {
            if (pipeline_.steps[i].name != tap.step) continue;
            const graph::TextureHandle handle = built->names[i].at(tap.texture);
            if (handle.version == 0)
                throw Error(ExitCode::usage,
                            "--tap " + tap.text() + ": no pass writes it with these parameters");
            builder.graph.keep(handle);
        }
    }
    built->imports = std::move(builder.imports);
    built->executor = std::make_unique<graph::Executor>(context_, std::move(builder.graph));
    return built;
}

FrameResult PipelineRenderer::render(const Capture& capture, const std::vector<std::string>& roles,
                                     bool timed) {
    std::vector<ParamSet> params;
    for (const PipelineStep& step : pipeline_.steps) params.push_back(resolve_params(step, capture.header));
    const std::string key = graph_key(capture, params, roles);
    if (!built_ || built_->key != key) {
        built_.reset();  // the old textures go before the new ones come
        built_ = build(capture, params, roles);
        built_->key = key;
    }

    FrameResult result;
    gpu::Timer timer(context_);
    timer.start();
    for (const auto& [role, handle] : built_->imports) {
        gpu::Texture* texture = built_->executor->texture(handle);
        if (!texture) continue;
        const Image& image = capture.images.at(role);
        if (image.type() == ComponentType::uint32) texture->upload(image.uints());
        else if (image.channels() == 3) texture->upload(widened(image.floats()));
        else texture->upload(image.floats());
    }
    for (const Built::BoundPass& pass : built_->passes) {
        const PipelineStep& step = pipeline_.steps[std::size_t(pass.step)];
        if (pass.has_params)
            built_->executor->set_uniforms(pass.pass, kParamBinding,
                                           param_block(*step.manifest, params[std::size_t(pass.step)]));
        built_->executor->set_uniforms(pass.pass, kFrameBinding, frame_block(capture.header, step.name));
    }
    const double upload_ms = timer.stop_ms();
    if (audit_)
        for (const auto& [role, handle] : built_->imports)
            audit_input(role, capture.images.at(role), result.audit);
    result.times = built_->executor->run(
        timed, audit_ ? auditor(pipeline_, result.audit) : graph::Executor::PassObserver{});

    timer.start();
    for (const std::string& role : roles)
        if (const auto handle = built_->results.find(role); handle != built_->results.end())
            result.images[role] =
                read_back(*built_->executor->texture(handle->second), find_role(role)->channels);
    for (const Tap& tap : pipeline_.taps)
        for (std::size_t i = 0; i < pipeline_.steps.size(); ++i)
            if (pipeline_.steps[i].name == tap.step) {
                const gpu::Texture& texture = *built_->executor->texture(built_->names[i].at(tap.texture));
                result.taps[tap.text()] = read_back(texture, gpu::channel_count(texture.desc().format));
            }
    if (timed) {
        result.times.insert(result.times.begin(), {"upload", upload_ms});
        result.times.push_back({"readback", timer.stop_ms()});
    }
    return result;
}

}  // namespace aftershade
