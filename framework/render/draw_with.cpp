#include "framework/render/draw_with.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "framework/base/error.h"

namespace aftershade {

namespace {

constexpr std::array<std::string_view, 3> kNames = {"auto", "fragment", "compute"};

}  // namespace

std::optional<DrawWith> parse_draw_with(std::string_view name) {
    const auto found = std::ranges::find(kNames, name);
    if (found == kNames.end()) return std::nullopt;
    return DrawWith(found - kNames.begin());
}

std::string_view draw_with_name(DrawWith way) {
    return kNames[std::size_t(way)];
}

DrawWith chosen_draw_with(gpu::Context&, DrawWith wanted, const ProgramStore&) {
    if (wanted != DrawWith::automatic) return wanted;
    if (const char* const name = std::getenv("AFTERSHADE_DRAW_WITH"); name && *name) {
        const auto named = parse_draw_with(name);
        if (!named)
            throw Error(ErrorKind::usage, "AFTERSHADE_DRAW_WITH: '" + std::string(name) +
                                              "' is not one of auto, fragment, compute");
        if (*named != DrawWith::automatic) return *named;
    }
    return DrawWith::fragment;
}

}  // namespace aftershade
