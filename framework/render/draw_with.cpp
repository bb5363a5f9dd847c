#include "framework/render/draw_with.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "framework/base/error.h"
#include "framework/effect/pass_program.h"
#include "framework/gpu/commands.h"
#include "framework/gpu/timer.h"

namespace aftershade {

namespace {

constexpr std::array<std::string_view, 3> kNames = {"auto", "fragment", "compute"};

/// As much work as a pass of an effect has: 256 dependent multiplications and additions a texel.
constexpr const char* kProbe = R"(#version 450 core
layout(location = 0) out vec4 result;
void main() {
    vec4 value = gl_FragCoord;
    for (int i = 0; i < 256; ++i) value = value * 0.999 + 0.001;
    result = value;
}
)";
constexpr int kProbeSidePx = 1024;
constexpr int kProbeRuns = 4;  // the first one warms up

/// The least time of some runs, ms.
template <typename Run>
double least_ms(gpu::Context& context, const Run& run) {
    gpu::Timer timer(context);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kProbeRuns; ++i) {
        timer.start();
        run();
        const double ms = timer.stop_ms();
        if (i > 0) least = std::min(least, ms);
    }
    return least;
}

DrawWith measured(gpu::Context& context, ProgramCache& programs) {
    ProgramSources draw = programs.full_screen(kProbe, "host.probe");
    const gpu::Texture target(context, {kProbeSidePx, kProbeSidePx, gpu::TextureFormat::rgba16f}, "probe");
    std::string why_not;
    const auto compute = in_compute_form(draw, {.targets = {target.desc().format}}, why_not);
    const std::array<gpu::Target, 1> targets = {{{&target}}};
    const auto fragments = programs.get(draw), groups = programs.get(*compute);
    const double drawn_ms = least_ms(context, [&] { gpu::draw(context, *fragments, targets, {}); });
    const double computed_ms =
        least_ms(context, [&] { gpu::dispatch_over(context, *groups, targets, 0, {}); });
    return computed_ms < drawn_ms ? DrawWith::compute : DrawWith::fragment;
}

}  // namespace

std::optional<DrawWith> parse_draw_with(std::string_view name) {
    const auto found = std::ranges::find(kNames, name);
    if (found == kNames.end()) return std::nullopt;
    return DrawWith(found - kNames.begin());
}

std::string_view draw_with_name(DrawWith way) {
    return kNames[std::size_t(way)];
}

DrawWith faster_draw_with(gpu::Context& context, ProgramCache& programs) {
    if (context.info().software) return DrawWith::fragment;
    const gpu::ContextInfo& gl = context.info();
    const std::string key = "aftershade draw with\n" + gl.vendor + "\n" + gl.renderer + "\n" + gl.version;
    // The answer is kept as a program is: an entry of the same folder, whose bytes are the name.
    if (const auto kept = programs.store().load(key)) {
        const std::string_view name(reinterpret_cast<const char*>(kept->bytes.data()), kept->bytes.size());
        if (const auto way = parse_draw_with(name); way && *way != DrawWith::automatic) return *way;
    }
    const DrawWith way = measured(context, programs);
    const auto bytes = std::as_bytes(std::span(draw_with_name(way)));
    programs.store().save(key, {0, {bytes.begin(), bytes.end()}});
    return way;
}

DrawWith chosen_draw_with(gpu::Context& context, DrawWith wanted, ProgramCache& programs) {
    if (wanted != DrawWith::automatic) return wanted;
    if (const char* const name = std::getenv("AFTERSHADE_DRAW_WITH"); name && *name) {
        const auto named = parse_draw_with(name);
        if (!named)
            throw Error(ErrorKind::usage, "AFTERSHADE_DRAW_WITH: '" + std::string(name) +
                                              "' is not one of auto, fragment, compute");
        if (*named != DrawWith::automatic) return *named;
    }
    return faster_draw_with(context, programs);
}

}  // namespace aftershade
