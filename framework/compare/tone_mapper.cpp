#include "framework/compare/tone_mapper.h"

#include <algorithm>
#include <cstddef>

namespace aftershade {

namespace {

constexpr std::array<std::string_view, 3> kToneMapperNames = {"aces", "reinhard", "hable"};

}  // namespace

std::string_view tone_mapper_name(ToneMapper mapper) {
    return kToneMapperNames[std::size_t(mapper)];
}

std::optional<ToneMapper> find_tone_mapper(std::string_view name) {
    const auto found = std::ranges::find(kToneMapperNames, name);
    if (found == kToneMapperNames.end()) return std::nullopt;
    return ToneMapper(found - kToneMapperNames.begin());
}

std::vector<std::string> tone_mapper_names() {
    return {kToneMapperNames.begin(), kToneMapperNames.end()};
}

const std::array<float, 6>& tone_mapper_coefficients(ToneMapper mapper) {
    static constexpr std::array<float, 6> aces = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0,
                                                  0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};
    static constexpr std::array<float, 6> hable = {0.231683f, 0.013791f, 0, 0.18f, 0.3f, 0.018f};
    return mapper == ToneMapper::hable ? hable : aces;
}

}  // namespace aftershade
