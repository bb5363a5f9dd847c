#include "framework/scene/surface_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "framework/image/srgb.h"

namespace aftershade::scene {

using glm::dvec2;
using glm::dvec4;
using glm::ivec2;

namespace {

using Values = std::vector<glm::vec4>;

double decoded(TexelValues values, int byte) {
    if (values == TexelValues::srgb) return decode_srgb(byte / 255.0);
    if (values == TexelValues::linear) return byte / 255.0;
    return byte == 127 || byte == 128 ? 0.0 : byte / 127.5 - 1;
}

std::array<double, 256> table_of(TexelValues values) {
    std::array<double, 256> table{};
    for (int byte = 0; byte < 256; ++byte) table[std::size_t(byte)] = decoded(values, byte);
    return table;
}

const std::array<double, 256>& decoding(TexelValues values) {
    static const std::array<std::array<double, 256>, 3> tables = {
        table_of(TexelValues::linear), table_of(TexelValues::srgb), table_of(TexelValues::normal)};
    return tables[std::size_t(values)];
}

std::uint32_t byte_of(double zero_to_one) {
    return std::uint32_t(std::clamp(std::lround(255 * zero_to_one), 0l, 255l));
}

std::uint32_t encoded(TexelValues values, double value) {
    if (values == TexelValues::srgb) return byte_of(encode_srgb(value));
    return byte_of(values == TexelValues::linear ? value : 0.5 + 0.5 * value);
}

/// Weight of alpha 0 where colours count by alpha. It keeps the colour of a mean of texels that all have
/// alpha 0. textures.glsl has the same.
constexpr double kLeastWeight = 1e-4;

/// Calls visit(texel, share) for the texels along one side that texel `at` of a coarser side covers.
template <class Visit>
void for_each_covered(int fine, int coarse, int at, const Visit& visit) {
    const double low = double(at) * fine / coarse, high = double(at + 1) * fine / coarse;
    for (int i = int(low); i < fine && i < high; ++i)
        visit(i, (std::min(high, i + 1.0) - std::max(low, double(i))) / (high - low));
}

Values coarser(const Values& from, const ivec2& fine, const ivec2& coarse, bool by_alpha) {
    Values result(std::size_t(coarse.x) * std::size_t(coarse.y));
    for (int y = 0; y < coarse.y; ++y)
        for (int x = 0; x < coarse.x; ++x) {
            dvec4 sum(0);
            for_each_covered(fine.y, coarse.y, y, [&](int from_y, double share_y) {
                for_each_covered(fine.x, coarse.x, x, [&](int from_x, double share_x) {
                    const std::size_t index = std::size_t(from_y) * std::size_t(fine.x) + std::size_t(from_x);
                    dvec4 value(from[index]);
                    if (by_alpha) value = dvec4(glm::dvec3(value) * (value.w + kLeastWeight), value.w);
                    sum += share_x * share_y * value;
                });
            });
            if (by_alpha) sum = dvec4(glm::dvec3(sum) / (sum.w + kLeastWeight), sum.w);
            result[std::size_t(y) * std::size_t(coarse.x) + std::size_t(x)] = glm::vec4(sum);
        }
    return result;
}

/// Into 0 to 1.
double folded(TextureWrap wrap, double u) {
    if (wrap == TextureWrap::repeat) return u - std::floor(u);
    if (wrap == TextureWrap::clamp) return std::clamp(u, 0.0, 1.0);
    const double turn = u - 2 * std::floor(0.5 * u);
    return turn > 1 ? 2 - turn : turn;
}

/// The texel that stands for one at most one outside.
int inside(TextureWrap wrap, int at, int side) {
    if (wrap != TextureWrap::repeat) return std::clamp(at, 0, side - 1);
    return at < 0 ? side - 1 : at >= side ? 0 : at;
}

/// An ellipse in texels.
struct Footprint {
    dvec2 axis{1, 0};  ///< of unit length, along the longer one
    double longer = 0;
    double shorter = 0;
};

/// The ellipse of the parallelogram with these two sides: the matrix's singular values, and the direction of
/// the first.
Footprint footprint_of(const glm::dmat2& sides) {
    const double a = sides[0].x * sides[0].x + sides[1].x * sides[1].x,
                 b = sides[0].x * sides[0].y + sides[1].x * sides[1].y,
                 c = sides[0].y * sides[0].y + sides[1].y * sides[1].y;
    const double half = 0.5 * (a - c), apart = std::sqrt(half * half + b * b);
    Footprint footprint;
    footprint.longer = std::sqrt(0.5 * (a + c) + apart);
    if (footprint.longer > 0) footprint.shorter = std::abs(glm::determinant(sides)) / footprint.longer;
    const dvec2 along = half >= 0 ? dvec2(half + apart, b) : dvec2(b, apart - half);
    if (const double length = glm::length(along); length > 0) footprint.axis = along / length;
    return footprint;
}

}  // namespace

SurfaceTexture::SurfaceTexture(const Image& stored, TexelValues values, const TextureSampling& sampling)
    : values_(values), sampling_(sampling) {
    const bool grey = stored.channels() <= 2;
    ivec2 size(stored.width(), stored.height());
    Values level;
    level.reserve(std::size_t(size.x) * std::size_t(size.y));
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            glm::vec4 value(0, 0, 0, 1);
            for (int c = 0; c < 3; ++c)
                value[c] = float(decoding(values)[byte_of(double(stored.at(x, y, grey ? 0 : c)))]);
            if (stored.channels() % 2 == 0) value.w = stored.at(x, y, stored.channels() - 1);
            level.push_back(value);
        }
    sampling_.by_alpha =
        sampling.by_alpha && std::ranges::any_of(level, [](const glm::vec4& value) { return value.w < 1; });
    for (;;) {
        levels_.push_back({size, texels_.size()});
        for (const glm::vec4& value : level)
            texels_.push_back(encoded(values, double(value.x)) | encoded(values, double(value.y)) << 8 |
                              encoded(values, double(value.z)) << 16 | byte_of(double(value.w)) << 24);
        if (size == ivec2(1)) return;
        const ivec2 half = glm::max(size / 2, 1);
        level = coarser(level, size, half, sampling_.by_alpha);
        size = half;
    }
}

dvec4 SurfaceTexture::texel(const Level& level, int x, int y) const {
    const std::size_t row = std::size_t(inside(sampling_.wrap_v, y, level.size.y));
    const std::size_t column = std::size_t(inside(sampling_.wrap_u, x, level.size.x));
    const std::uint32_t word = texels_[level.first + row * std::size_t(level.size.x) + column];
    const auto& table = decoding(values_);
    const double alpha = (word >> 24) / 255.0;
    const glm::dvec3 color(table[word & 255], table[word >> 8 & 255], table[word >> 16 & 255]);
    return {sampling_.by_alpha ? color * (alpha + kLeastWeight) : color, alpha};
}

dvec4 SurfaceTexture::blended(std::size_t index, const dvec2& uv) const {
    const Level& level = levels_[index];
    const dvec2 at =
        dvec2(folded(sampling_.wrap_u, uv.x), folded(sampling_.wrap_v, uv.y)) * dvec2(level.size) - 0.5;
    const dvec2 low = glm::floor(at), part = at - low;
    const ivec2 first(low);
    return glm::mix(
        glm::mix(texel(level, first.x, first.y), texel(level, first.x + 1, first.y), part.x),
        glm::mix(texel(level, first.x, first.y + 1), texel(level, first.x + 1, first.y + 1), part.x), part.y);
}

dvec4 SurfaceTexture::nearest(const dvec2& uv) const {
    const Level& level = levels_.front();
    const ivec2 at(dvec2(folded(sampling_.wrap_u, uv.x), folded(sampling_.wrap_v, uv.y)) * dvec2(level.size));
    return texel(level, at.x, at.y);
}

dvec4 SurfaceTexture::at(const dvec2& uv, const glm::dmat2& uv_of_pixel) const {
    const dvec2 size(levels_.front().size);
    const Footprint footprint = footprint_of({uv_of_pixel[0] * size, uv_of_pixel[1] * size});
    // A little less than the ratio, so that single and double precision choose alike where it is whole.
    const double ratio = footprint.longer / std::max(footprint.shorter, 1.0) - 0.01;
    const int taps = ratio > 1 ? int(std::ceil(std::min(ratio, double(kMostTaps)))) : 1;
    const double across = std::max(footprint.longer / taps, footprint.shorter);
    const double level = across > 1 ? std::min(std::log2(across), double(levels_.size() - 1)) : 0.0;
    const auto fine = std::size_t(level);
    const double part = level - double(fine);
    dvec4 sum(0);
    for (int tap = 0; tap < taps; ++tap) {
        const double along = ((tap + 0.5) / taps - 0.5) * footprint.longer;
        const dvec2 place = taps > 1 ? uv + along * footprint.axis / size : uv;
        if (level <= 0 && sampling_.nearest) sum += nearest(place);
        else if (part <= 0) sum += blended(fine, place);
        else sum += glm::mix(blended(fine, place), blended(fine + 1, place), part);
    }
    sum /= double(taps);
    return sampling_.by_alpha ? dvec4(glm::dvec3(sum) / (sum.w + kLeastWeight), sum.w) : sum;
}

}  // namespace aftershade::scene
