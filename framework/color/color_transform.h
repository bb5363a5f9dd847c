// Colour transforms of OpenColorIO as text for shaders and a table of its LUTs.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "framework/color/color_request.h"
#include "framework/image/color_encoding.h"

namespace aftershade {

struct ColorTransform {
    /// Declares the sampler2D "<function>_table", which only texelFetch reads, and `vec3 function(vec3 rgb)`.
    std::string glsl;
    std::vector<float> texels;  ///< whole rows of kColorTableRow texels
    int channels = 4;           ///< of a texel: 4, or 2 where it has curves alone, which are faster to fetch
    std::vector<std::filesystem::path>
        files;  ///< the config and the LUTs, or the transform, that it was made of
    /// How its results are encoded: for the view's display, or as the destination; unknown also for a file.
    ColorEncoding encoding{kRec709, ColorEncoding::Curve::unknown, 1};
};

/// Reads its files again each time. [thread-safe]
std::variant<ColorTransform, ColorFault> make_color_transform(const ColorRequest& request);

/// The names in the config at that path, which is as in a request.
std::variant<ColorNames, ColorFault> color_names(const std::string& path);

/// Whether this program was built with OpenColorIO.
bool has_opencolorio();

}  // namespace aftershade
