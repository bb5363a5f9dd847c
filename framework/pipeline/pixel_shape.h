// Steps whose shapes are round in pixels, over frames whose pixels are not square.
#pragma once

#include <string>

#include "framework/pipeline/pipeline.h"

namespace aftershade {

/// A sentence that names the steps which measure both axes by one length in pixels: blurs by a radius, lenses,
/// scattering, vignettes. Empty where the pixels are square, or no step does.
std::string square_pixels_warning(const Pipeline& pipeline, float pixel_aspect);

}  // namespace aftershade
