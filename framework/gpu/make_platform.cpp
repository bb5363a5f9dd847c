#include "framework/gpu/make_platform.h"

#include <exception>

#include "framework/base/memory_limit.h"
#include "framework/gpu/backend.h"
#include "framework/gpu/driver_cache.h"
#include "framework/gpu/egl_platform.h"
#include "framework/gpu/osmesa_platform.h"

namespace aftershade::gpu {

std::unique_ptr<Platform> make_platform(Backend backend) {
    prepare_driver_cache();
    if (backend == Backend::osmesa) return make_osmesa_platform();
    return make_egl_platform(backend == Backend::egl_software ? Renderer::software : Renderer::hardware);
}

void load_ahead(Backend backend) noexcept {
    // Its size would count against what a context requires.
    if (backend != Backend::osmesa || address_space_left()) return;
    try {
        load_osmesa();
    } catch (const std::exception&) {
    }
}

}  // namespace aftershade::gpu
