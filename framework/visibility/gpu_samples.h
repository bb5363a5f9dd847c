// Light at every visibility sample as compute shaders: what decoupled sampling saves.
#pragma once

#include <cstddef>

#include "framework/scene/scene_renderer.h"
#include "framework/scene/visibility.h"
#include "framework/visibility/bands.h"
#include "framework/visibility/passes.h"

namespace aftershade::visibility {

/// As scene::light_samples(), in single precision and with stochastic transparency. No buffer is larger than
/// `max_buffer_bytes`: larger pictures are done in bands of rows. Throws Error(ErrorKind::usage) for more
/// than 2^20 triangles, and what gpu throws.
scene::LitSamples light_samples(Passes& passes, const scene::SceneRenderer& renderer, int frame,
                                const scene::VisibilitySettings& settings,
                                std::size_t max_buffer_bytes = kMaxBufferBytes);

}  // namespace aftershade::visibility
