// The grids that steps work on, from one to the other, and what is kept of them: the third part of
// GraphBuilder.
#include <string>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/effect/std140.h"
#include "framework/image/role.h"
#include "framework/render/graph_builder.h"
#include "framework/render/step_build.h"

namespace aftershade {

void GraphBuilder::use_grid_of(int step) {
    is_single_ = step < 0 || step > pipeline_.last_accumulating_step();
    is_square_ = square_steps_.contains(step);
    width_ = is_square_ ? square_.width_px : frame_.width_px();
    height_ = is_square_ ? square_.height_px : frame_.height_px();
}

namespace {

/// nullopt for a texture that is not an output: what it holds is the effect's business.
std::optional<ChannelRole> role_of(const Pipeline& pipeline, const InputSource& source) {
    if (source.step < 0) return find_role(source.output);
    for (const OutputSpec& output : pipeline.steps[std::size_t(source.step)].manifest->outputs)
        if (output.name == source.output) return find_role(output.role);
    return std::nullopt;
}

}  // namespace

graph::TextureHandle GraphBuilder::on_grid(graph::TextureHandle handle, const InputSource& source) {
    const bool was_square = square_steps_.contains(source.step);
    if (was_square == is_square_) return handle;
    gpu::TextureDesc desc = graph_.textures()[std::size_t(handle.texture)].desc;
    const int width = was_square ? square_.width_px : frame_.width_px();
    const int height = was_square ? square_.height_px : frame_.height_px();
    // A texture of another size is not looked up by the pixel.
    if (desc.width != width || desc.height != height || desc.layers > 1) return handle;
    const auto [known, is_new] = converted_.try_emplace({handle.texture, handle.version, is_single_});
    if (!is_new) return known->second;
    const auto role = role_of(pipeline_, source);
    std::vector<std::string> defines = {is_square_ ? "TO_SQUARE" : "TO_STORED"};
    if (gpu::is_integer(desc.format)) defines.emplace_back("INTEGERS");
    else if (role && role->kind == RoleKind::motion) defines.emplace_back("MOTION");
    else if (role && role->filterable) defines.emplace_back("MEAN");
    graph::Pass pass;
    pass.name = graph_.textures()[std::size_t(handle.texture)].name +
                (is_square_ ? kToSquarePixels : kToStoredPixels);
    Std140Writer block;
    for (const std::int64_t number : {std::int64_t(square_.stretch.axis), square_.stretch.to,
                                      square_.stretch.from, std::int64_t(square_.phase)})
        block.add(std::int32_t(number));
    pass.uniforms.push_back({kStretchBinding, block.finish()});
    pass.reads.push_back({handle, 0, gpu::Filter::nearest, gpu::Wrap::clamp, input_level(handle)});
    desc = {width_, height_, desc.format};
    pass.targets.push_back({graph_.create_texture(pass.name, desc)});
    programs_.give_host(graph_, pass, "square_pixels.frag", defines);
    return converted_[{handle.texture, handle.version, is_single_}] =
               graph_.add_pass(std::move(pass)).targets.front();
}

namespace {

/// The last output of that role among all steps.
InputSource result_source(const Pipeline& pipeline, const std::string& role) {
    InputSource source;
    for (int i = 0; i < int(pipeline.steps.size()); ++i)
        for (const OutputSpec& output : pipeline.steps[std::size_t(i)].manifest->outputs)
            if (output.role == role) source = {i, output.name};
    return source;
}

}  // namespace

void GraphBuilder::keep_results() {
    for (auto& [role, texture] : built_->results)
        if (frame_.wants(role)) graph_.keep(texture = on_grid(texture, result_source(pipeline_, role)));
}

void GraphBuilder::keep_taps() {
    for (const Tap& tap : pipeline_.taps)
        for (std::size_t i = 0; i < pipeline_.steps.size(); ++i) {
            if (pipeline_.steps[i].name != tap.step) continue;
            graph::TextureHandle handle = built_->textures[i].at(tap.texture);
            if (handle.version == 0)
                throw Error(ErrorKind::usage, spelled(Option::tap) + " " + tap.text() +
                                                  ": no pass writes it with these parameters");
            handle = on_grid(handle, {int(i), tap.texture});
            graph_.keep(built_->taps[tap.text()] = handle);
        }
}

void GraphBuilder::keep_statistics() {
    for (std::size_t i = 0; i < pipeline_.steps.size(); ++i)
        for (const TelemetrySpec& spec : pipeline_.steps[i].manifest->telemetry)
            if (const auto found = find_textures(built_->textures[i], spec)) {
                graph_.keep(found->of);
                if (found->where) graph_.keep(*found->where);
            }
}

}  // namespace aftershade
