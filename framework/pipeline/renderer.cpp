#include "framework/pipeline/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "framework/core/error.h"
#include "framework/effect/std140.h"
#include "framework/gpu/timer.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// FNV-1a: the seed of a step is its name's, so that a step inserted before it changes nothing.
std::uint32_t hash_name(const std::string& name) {
    std::uint32_t hash = 2166136261u;
    for (const unsigned char c : name) hash = (hash ^ c) * 16777619u;
    return hash;
}

std::vector<std::byte> frame_block(const CaptureHeader& header, std::uint32_t step_seed) {
    FrameBlock block;
    block.display_size_px[0] = header.display_window.width();
    block.display_size_px[1] = header.display_window.height();
    block.origin_px[0] = header.data_window.min_x - header.display_window.min_x;
    block.origin_px[1] = header.data_window.min_y - header.display_window.min_y;
    block.number = header.frame;
    block.step_seed = step_seed;
    const ColorMatrix matrix = conversion_matrix(header.primaries, kRec709);
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            block.rec709_from_color[column][row] = float(matrix[row * 3 + column]);
    std::vector<std::byte> bytes(sizeof block);
    std::memcpy(bytes.data(), &block, sizeof block);
    return bytes;
}

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

int scaled_side(int side, const TextureSpec& spec) {
    if (spec.tile > 0) return (side + spec.tile - 1) / spec.tile;
    return std::max(1, int(std::ceil(side * spec.scale)));
}

}  // namespace

namespace {

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

namespace {

/// Adds the passes of one step after the other to a graph.
class GraphBuilder {
public:
    using Names = std::map<std::string, graph::TextureHandle>;

    GraphBuilder(ProgramCache& programs, const Pipeline& pipeline, const Capture& capture)
        : programs_(programs), pipeline_(pipeline), capture_(capture) {
        width_ = capture.header.data_window.width();
        height_ = capture.header.data_window.height();
        for (const auto& [role, image] : capture.images) roles_.push_back(role);
    }

    /// Calls `bound(graph pass)` for each pass that runs; returns the step's textures and outputs by name.
    template <typename Bound>
    Names add_step(int index, const ParamSet& params, const std::vector<Names>& earlier, Bound bound) {
        const PipelineStep& step = pipeline_.steps[std::size_t(index)];
        const EffectManifest& manifest = *step.manifest;
        const std::vector<std::string> present = present_inputs(pipeline_, index, roles_);
        Names inputs, names;
        for (const std::string& name : present) {
            const InputSource& source = step.inputs.at(name);
            inputs[name] =
                source.step < 0 ? import(source.output) : earlier[std::size_t(source.step)].at(source.output);
        }
        for (const TextureSpec& spec : manifest.textures)
            names[spec.name] =
                graph.create_texture(step.name + "." + spec.name,
                                     {scaled_side(width_, spec), scaled_side(height_, spec), spec.format});
        for (const OutputSpec& spec : manifest.outputs)
            names[spec.name] = graph.create_texture(step.name + "." + spec.name,
                                                    {width_, height_, texture_format_of_role(spec.role)});
        for (const PassSpec& pass : manifest.passes) {
            if (!pass_enabled(pass, params, present)) continue;
            const ShaderContext shader{&manifest, &pass, &params, present, programs_.glsl_folder()};
            add_pass(step, shader, inputs, names);
            bound(graph.pass_count() - 1);
        }
        for (const OutputSpec& spec : manifest.outputs)
            if (names.at(spec.name).version == 0)
                throw Error(ExitCode::effect, "step '" + step.name + "': no pass writes the output '" +
                                                  spec.name + "' with these parameters");
        return names;
    }

    graph::FrameGraph graph;
    Names imports;  // by role

private:
    graph::TextureHandle import(const std::string& role) {
        const auto known = imports.find(role);
        if (known != imports.end()) return known->second;
        return imports[role] =
                   graph.import_texture("capture." + role, {width_, height_, texture_format_of_role(role)});
    }

    void add_pass(const PipelineStep& step, const ShaderContext& shader, const Names& inputs, Names& names) {
        const EffectManifest& manifest = *shader.manifest;
        graph::Pass pass;
        pass.name = step.name + "." + shader.pass->name;
        pass.program = &programs_.get(shader);
        Std140Writer sizes;
        for (const ReadSpec& read : present_reads(manifest, *shader.pass, shader.present_inputs)) {
            const auto input = inputs.find(read.name);
            const graph::TextureHandle handle = input != inputs.end() ? input->second : names.at(read.name);
            if (handle.version == 0)
                throw Error(ExitCode::effect, "step '" + step.name + "': pass '" + shader.pass->name +
                                                  "' reads '" + read.name +
                                                  "', which no pass has written with these parameters");
            pass.reads.push_back({handle, int(pass.reads.size()), read.filter, read.wrap});
            const gpu::TextureDesc& desc = graph.textures()[std::size_t(handle.texture)].desc;
            const float size[4] = {float(desc.width), float(desc.height), 1.0f / float(desc.width),
                                   1.0f / float(desc.height)};
            sizes.add(std::span<const float>(size));
        }
        if (has_param_block(manifest))
            pass.uniforms.push_back({kParamBinding, param_block(manifest, *shader.params)});
        pass.uniforms.push_back({kFrameBinding, frame_block(capture_.header, hash_name(step.name))});
        if (!pass.reads.empty()) pass.uniforms.push_back({kSizeBinding, sizes.finish()});
        std::vector<graph::TextureHandle> targets;
        for (const std::string& name : shader.pass->writes) targets.push_back(names.at(name));
        const auto written = graph.add_pass(std::move(pass), targets);
        for (std::size_t i = 0; i < written.size(); ++i) names[shader.pass->writes[i]] = written[i];
    }

    ProgramCache& programs_;
    const Pipeline& pipeline_;
    const Capture& capture_;
    std::vector<std::string> roles_;
    int width_ = 0;
    int height_ = 0;
};

}  // namespace

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
        built_->executor->set_uniforms(pass.pass, kFrameBinding,
                                       frame_block(capture.header, hash_name(step.name)));
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
