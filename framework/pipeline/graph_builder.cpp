#include "framework/pipeline/graph_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "framework/core/error.h"
#include "framework/effect/std140.h"

namespace aftershade {

namespace {

/// FNV-1a: the seed of a step is its name's, so that a step inserted before it changes nothing.
std::uint32_t hash_name(const std::string& name) {
    std::uint32_t hash = 2166136261u;
    for (const unsigned char c : name) hash = (hash ^ c) * 16777619u;
    return hash;
}

int scaled_side(int side, const TextureSpec& spec) {
    if (spec.tile > 0) return (side + spec.tile - 1) / spec.tile;
    return std::max(1, int(std::ceil(side * spec.scale)));
}

}  // namespace

std::vector<std::byte> frame_block(const CaptureHeader& header, const std::string& step) {
    FrameBlock block;
    block.display_size_px[0] = header.display_window.width();
    block.display_size_px[1] = header.display_window.height();
    block.origin_px[0] = header.data_window.min_x - header.display_window.min_x;
    block.origin_px[1] = header.data_window.min_y - header.display_window.min_y;
    block.number = header.frame;
    block.step_seed = hash_name(step);
    const ColorMatrix matrix = conversion_matrix(header.primaries, kRec709);
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            block.rec709_from_color[column][row] = float(matrix[row * 3 + column]);
    std::vector<std::byte> bytes(sizeof block);
    std::memcpy(bytes.data(), &block, sizeof block);
    return bytes;
}

GraphBuilder::GraphBuilder(ProgramCache& programs, const Pipeline& pipeline, const Capture& capture)
    : programs_(programs), pipeline_(pipeline), capture_(capture) {
    width_ = capture.header.data_window.width();
    height_ = capture.header.data_window.height();
    for (const auto& [role, image] : capture.images) roles_.push_back(role);
}

GraphBuilder::Names GraphBuilder::add_step(int index, const ParamSet& params,
                                           const std::vector<Names>& earlier,
                                           const std::function<void(int pass)>& bound) {
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

graph::TextureHandle GraphBuilder::import(const std::string& role) {
    const auto known = imports.find(role);
    if (known != imports.end()) return known->second;
    return imports[role] =
               graph.import_texture("capture." + role, {width_, height_, texture_format_of_role(role)});
}

void GraphBuilder::add_pass(const PipelineStep& step, const ShaderContext& shader, const Names& inputs,
                            Names& names) {
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
    pass.uniforms.push_back({kFrameBinding, frame_block(capture_.header, step.name)});
    if (!pass.reads.empty()) pass.uniforms.push_back({kSizeBinding, sizes.finish()});
    std::vector<graph::TextureHandle> targets;
    for (const std::string& name : shader.pass->writes) targets.push_back(names.at(name));
    const auto written = graph.add_pass(std::move(pass), targets);
    for (std::size_t i = 0; i < written.size(); ++i) names[shader.pass->writes[i]] = written[i];
}

}  // namespace aftershade
