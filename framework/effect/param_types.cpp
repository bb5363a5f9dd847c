#include "framework/effect/param_types.h"

#include <vector>

#include "framework/scattering/param_scattering.h"

namespace aftershade {

std::span<const ParamType> param_types() {
    static const std::vector<ParamType> types = [] {
        const auto core = core_param_types();
        std::vector<ParamType> all(core.begin(), core.end());
        all.insert(all.end(), {kScatteringParam});
        return all;
    }();
    return types;
}

}  // namespace aftershade
