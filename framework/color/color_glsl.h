// OpenColorIO's text for shaders, with LUTs in one table that texelFetch reads.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace aftershade {

/// A LUT that OpenColorIO made for a texture of its own.
struct ShaderLut {
    std::string sampler;  ///< the texture's name in the text
    int dimensions = 2;   ///< 1 or 2: a curve, in rows; 3: a cube
    int width = 0;        ///< samples in a row; a cube's edge
    int height = 1;
    int channels = 3;  ///< 1 or 3
    bool is_tetrahedral = false;
    std::vector<float> values;  ///< channels interleaved
};

/// A function of one number for each channel, straight between the numbers that have no bits below `shift`.
struct BitCurve {
    int shift = 0;
    /// For each of these 2^(32 - shift) numbers, in the order of their bits, its value and the way to the
    /// next. One after another for red, green and blue, or once for all three.
    std::vector<float> values;

    std::size_t size() const { return std::size_t(1) << (32 - shift); }
    bool is_common() const { return values.size() == 2 * size(); }
};

/// `vec3 name(vec3 rgb)`, which reads the curve's part of `table`. Appends that part to `texels`.
std::string glsl_of_curve(const BitCurve& curve, const std::string& name, const std::string& table,
                          std::vector<float>& texels);

/// The text with each LUT's sampler replaced by a function of the same interpolation, which reads the LUT's
/// part of `table`, a sampler2D with rows of kColorTableRow texels. Appends that part, RGBA, to `texels`.
/// Filters of textures have 8 bits of fraction on GPUs and differ between drivers; these functions have
/// neither fault.
std::string glsl_with_table(std::string text, const std::vector<ShaderLut>& luts, const std::string& table,
                            std::vector<float>& texels);

/// The table's texels, in whole rows, with as many of their 4 channels as its parts need.
std::vector<float> table_of(const std::vector<float>& texels, int channels);

}  // namespace aftershade
