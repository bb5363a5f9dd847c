#include "framework/render/built_graph.h"

namespace aftershade {

std::optional<StatisticTextures> find_textures(const StepTextures& textures, const TelemetrySpec& spec) {
    StatisticTextures found{textures.at(spec.of.texture), std::nullopt};
    if (spec.where) found.where = textures.at(spec.where->texture);
    if (found.of.version == 0 || (found.where && found.where->version == 0)) return std::nullopt;
    return found;
}

}  // namespace aftershade
