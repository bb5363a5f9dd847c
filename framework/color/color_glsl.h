// OpenColorIO's text for shaders, with LUTs in one table that texelFetch reads.
#pragma once

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

/// The text with each LUT's sampler replaced by a function of the same interpolation, which reads the LUT's
/// part of `table`, a sampler2D with rows of kColorTableRow texels. Appends that part, RGBA, to `texels`.
/// Filters of textures have 8 bits of fraction on GPUs and differ between drivers; these functions have
/// neither fault.
std::string glsl_with_table(std::string text, const std::vector<ShaderLut>& luts, const std::string& table,
                            std::vector<float>& texels);

}  // namespace aftershade
