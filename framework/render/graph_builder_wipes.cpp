// Clears that are confined to the tiles of a list.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/effect/glsl_tokens.h"
#include "framework/effect/shader_source.h"
#include "framework/effect/std140.h"
#include "framework/render/graph_builder.h"
#include "framework/render/step_build.h"

namespace aftershade {

namespace {

/// Of glsl/host/wipe.vert and wipe.frag.
constexpr int kWipeBinding = 0;
constexpr int kPlacesBinding = 0;
constexpr int kNextPlacesBinding = 1;

/// The four channels as a shader writes them, bit for bit. nullopt: a clear and a shader may round the value
/// differently, or the format has no wipe.
std::optional<std::array<std::uint32_t, 4>> wipe_bits(const std::array<double, 4>& value,
                                                      gpu::TextureFormat format) {
    if (gpu::is_signed_integer(format)) return std::nullopt;
    const bool is_integer = gpu::is_integer(format);
    const bool is_rounded = !is_integer && gpu::bytes_per_texel(format) < 4 * gpu::channel_count(format);
    std::array<std::uint32_t, 4> bits{};
    for (std::size_t i = 0; i < bits.size(); ++i) {
        if (is_rounded && value[i] != 0 && value[i] != 1) return std::nullopt;
        bits[i] = is_integer ? std::uint32_t(std::int64_t(value[i]))
                             : std::bit_cast<std::uint32_t>(float(value[i]));
    }
    return bits;
}

std::function<std::shared_ptr<const gpu::Program>()> wipe_program(ProgramCache& programs,
                                                                  std::vector<std::string> defines) {
    return [&programs, defines = std::move(defines),
            made = std::make_shared<std::shared_ptr<const gpu::Program>>()] {
        if (!*made) *made = programs.host("wipe.frag", defines, "wipe.vert");
        return *made;
    };
}

/// Whether every pixel of the pass's tiles gets what the shader makes.
bool overwrites_tiles(const EffectManifest& manifest, const PassSpec& spec,
                      const std::filesystem::path& glsl_folder, ShaderTexts& texts) {
    if (spec.blend != gpu::Blend::none) return false;
    Diagnostics faults;  // said where the program is made
    const ShaderSource source = author_text(manifest, spec, glsl_folder, faults, ShaderFile::main, &texts);
    if (faults.has_errors()) return false;
    // A backslash may divide a word.
    return source.text.find('\\') == std::string::npos && !has_any_word(source, {"discard"});
}

}  // namespace

/// Only on software GL, where a clear takes a pass over all texels. A vertex shader of the effect's own may
/// place tiles by anything.
void GraphBuilder::add_wipes(const StepBuild& build, const PassSpec& spec, const PassBindings& bindings,
                             graph::Pass& pass) {
    if (spec.over.empty() || !spec.vertex.empty() || !tools_.context.info().software || tools_.options.plain)
        return;
    const TileListSpec& list = *build.manifest().find_tile_list(spec.over);
    const auto runs = std::ranges::find(bindings.buffers, list.runs(), &AccessSpec::name);
    const auto& places = pass.buffers[std::size_t(runs - bindings.buffers.begin())];
    const bool overwrites =
        overwrites_tiles(build.manifest(), spec, tools_.programs.glsl_folder(), programs_.texts());
    const int tile = count_value(list.tile, build.params);
    for (std::size_t i = 0; i < pass.targets.size(); ++i) {
        std::optional<graph::Wipe>& wipe = pass.wipes.emplace_back();
        const auto& texture = graph_.textures()[std::size_t(pass.targets[i].texture.texture)];
        const TextureSpec* declared = build.manifest().find_texture(bindings.writes[i].name);
        // One with a texel per tile is cleared in less time than a draw takes to begin.
        if (!texture.options.clear || declared->grid.kind != GridSpec::Kind::scale) continue;
        const auto bits = wipe_bits(*texture.options.clear, texture.desc.format);
        if (!bits) continue;
        const std::array<float, 4> grid = tile_grid_size(build, spec, bindings);
        Std140Writer block;
        block.add(std::span<const float>(grid));
        for (const std::uint32_t word : *bits) block.add(word);
        block.add(std::int32_t(tile));
        block.add(std::int32_t((int(listed_size(build, list)[0]) + tile - 1) / tile));
        std::vector<std::string> defines;
        if (gpu::is_integer(texture.desc.format)) defines.push_back("WIPE_UINT");
        if (overwrites) defines.push_back("WIPE_REST");
        auto& program = wipe_programs_[defines];
        if (!program) program = wipe_program(tools_.programs, defines);
        wipe = graph::Wipe{program,
                           {kWipeBinding, block.finish()},
                           {places.buffer, kPlacesBinding, gpu::Access::read},
                           overwrites ? std::optional(kNextPlacesBinding) : std::nullopt};
    }
}

}  // namespace aftershade
