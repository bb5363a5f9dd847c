// Pictures on surfaces, each with its coarser copies.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/image/image.h"

namespace aftershade::scene {

enum class TextureWrap { repeat, mirror, clamp };

/// What the 8 bits of a texel stand for.
enum class TexelValues {
    linear,  ///< 0 to 1
    srgb,    ///< 0 to 1, decoded before they are filtered
    normal   ///< -1 to 1. 127 and 128 are both 0, which 8 bits lack, so that a flat map tilts nothing
};

struct TextureSampling {
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    bool nearest = false;   ///< one texel where a pixel is smaller than a texel; else four are blended
    bool by_alpha = false;  ///< colours count by their alpha in a mean, as alpha cuts out or blends them
};

/// Three channels and alpha of 8 bits, and the means of their areas at half the size, a quarter and so on.
/// [immutable: any thread]
class SurfaceTexture {
public:
    /// `stored`: 1 to 4 channels, 0 to 1, as the file has them. Grey becomes three channels.
    SurfaceTexture(const Image& stored, TexelValues values, const TextureSampling& sampling);

    /// The mean over a pixel; w: alpha, 0 to 1. u grows along the rows, v down, and the picture fills 0 to 1.
    /// The columns of `uv_of_pixel` are the pixel's two sides in texture coordinates. Up to kMostTaps places
    /// along the longer axis of its footprint are looked up (Heckbert 1989), each trilinearly (Williams
    /// 1983).
    glm::dvec4 at(const glm::dvec2& uv, const glm::dmat2& uv_of_pixel) const;
    static constexpr int kMostTaps = 8;

    struct Level {
        glm::ivec2 size{1};
        std::size_t first = 0;  ///< index into texels()
    };
    const std::vector<Level>& levels() const { return levels_; }
    /// The texels of all levels, the finest first; red in the lowest byte, then green, blue and alpha.
    const std::vector<std::uint32_t>& texels() const { return texels_; }
    /// Whether alpha is 1 everywhere.
    bool is_opaque() const {
        return std::ranges::all_of(texels_, [](std::uint32_t texel) { return texel >> 24 == 255; });
    }
    TexelValues values() const { return values_; }
    /// `by_alpha` is false where alpha is 1 everywhere, since it would change nothing.
    const TextureSampling& sampling() const { return sampling_; }

private:
    /// Colour times its weight, where it counts by alpha.
    glm::dvec4 texel(const Level& level, int x, int y) const;
    glm::dvec4 blended(std::size_t level, const glm::dvec2& uv) const;
    glm::dvec4 nearest(const glm::dvec2& uv) const;

    TexelValues values_;
    TextureSampling sampling_;
    std::vector<Level> levels_;
    std::vector<std::uint32_t> texels_;
};

}  // namespace aftershade::scene
