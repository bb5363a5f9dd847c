// Fetches of single texels as loads from images.
//
// llvmpipe calls a function for each texelFetch, and has a load from an image in line: a half to a third
// of the time (docs/llvmpipe.md). On GPUs the two differ little, and a sampler's path has the better caches,
// so authors write texelFetch and the host rewrites it where that pays.
#pragma once

#include <map>
#include <vector>

#include "framework/effect/shader_source.h"
#include "framework/gpu/texture.h"

namespace aftershade {

/// A texture that a program loads as an image.
struct ImageLoad {
    int sampler = 0;  ///< binding of the sampler that the author's text fetches from
    int unit = 0;     ///< of the image
};

/// Puts loads in the place of texelFetch(name, p, 0), where `name` is a uniform sampler2D or sampler2DArray
/// whose binding is in `formats`, or a function's parameter that only such ones come to. They become the
/// images from `first_unit` to below `units`, those with most fetches first; a sampler that has other uses
/// keeps them. Outside of the texture a load gives 0, as llvmpipe's fetch does. Keeps the lines of the text.
std::vector<ImageLoad> load_as_images(ShaderSource& source, const std::map<int, gpu::TextureFormat>& formats,
                                      int first_unit, int units);

}  // namespace aftershade
