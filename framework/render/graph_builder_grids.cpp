// The grids that steps work on, from one to the other, and what is kept of them: the third part of
// GraphBuilder.
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/effect/std140.h"
#include "framework/image/role.h"
#include "framework/render/graph_builder.h"
#include "framework/render/step_build.h"

namespace aftershade {

GraphBuilder::Grid GraphBuilder::grid_of(int step) const {
    return {square_steps_.contains(step), square_steps_.is_in_display_window(step)};
}

std::pair<int, int> GraphBuilder::size_of(const Grid& grid) {
    if (grid.is_display) {
        const GraphFrameReader::DisplayWindow window = frame_.display_window(grid.is_square);
        return {window.width_px, window.height_px};
    }
    if (grid.is_square) return {square_.width_px, square_.height_px};
    return {frame_.width_px(), frame_.height_px()};
}

void GraphBuilder::use_grid_of(int step) {
    is_single_ = step < 0 || step > pipeline_.last_accumulating_step();
    grid_ = grid_of(step);
    std::tie(width_, height_) = size_of(grid_);
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
    Grid from = grid_of(source.step);
    const gpu::TextureDesc& desc = graph_.textures()[std::size_t(handle.texture)].desc;
    // A texture of another size is not looked up by the pixel.
    if (std::pair(desc.width, desc.height) != size_of(from) || desc.layers > 1) return handle;
    const auto go = [&](const Grid& to) {
        if (from == to) return;
        handle = converted(handle, source, from, to);
        from = to;
    };
    // Square pixels are counted over the data window.
    if (from.is_square != grid_.is_square) go({from.is_square, false});
    go({grid_.is_square, from.is_display});
    go(grid_);
    return handle;
}

/// From one grid to another that differs in its pixels or in its window.
graph::TextureHandle GraphBuilder::converted(graph::TextureHandle handle, const InputSource& source,
                                             const Grid& from, const Grid& to) {
    const auto [width, height] = size_of(to);
    const GraphFrameReader::DisplayWindow window = from.is_display || to.is_display
                                                       ? frame_.display_window(to.is_square)
                                                       : GraphFrameReader::DisplayWindow{};
    const bool is_window = from.is_display != to.is_display;
    if (is_window && window.x == 0 && window.y == 0 && size_of(from) == size_of(to)) return handle;
    const std::tuple key{handle.texture, handle.version, is_single_, to.is_square, to.is_display};
    const auto [known, is_new] = converted_.try_emplace(key);
    if (!is_new) return known->second;
    const graph::TextureHandle& made = known->second;
    const gpu::TextureFormat format = graph_.textures()[std::size_t(handle.texture)].desc.format;
    std::vector<std::string> defines;
    if (!is_window) defines.emplace_back(to.is_square ? "TO_SQUARE" : "TO_STORED");
    const auto role = role_of(pipeline_, source);
    if (gpu::is_integer(format)) defines.emplace_back("INTEGERS");
    else if (!is_window && role && role->kind == RoleKind::motion) defines.emplace_back("MOTION");
    else if (!is_window && role && role->filterable) defines.emplace_back("MEAN");
    graph::Pass pass;
    pass.name = graph_.textures()[std::size_t(handle.texture)].name +
                (is_window      ? to.is_display ? kToDisplayWindow : kToDataWindow
                 : to.is_square ? kToSquarePixels
                                : kToStoredPixels);
    std::vector<std::int64_t> numbers;
    if (!is_window) numbers = {square_.stretch.axis, square_.stretch.to, square_.stretch.from, square_.phase};
    else if (to.is_display) numbers = {window.x, window.y};
    else numbers = {-window.x, -window.y};
    Std140Writer block;
    for (const std::int64_t number : numbers) block.add(std::int32_t(number));
    pass.uniforms.push_back({kStretchBinding, block.finish()});
    pass.reads.push_back({handle, 0, gpu::Filter::nearest, gpu::Wrap::clamp, input_level(handle)});
    pass.targets.push_back({graph_.create_texture(pass.name, {width, height, format})});
    programs_.give_host(graph_, pass, is_window ? "window.frag" : "square_pixels.frag", defines);
    converted_[key] = graph_.add_pass(std::move(pass)).targets.front();
    return made;
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
