#include "framework/gpu/make_platform.h"

#include <exception>

#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/gpu/backend.h"
#include "framework/gpu/device.h"
#include "framework/gpu/driver_cache.h"
#include "framework/gpu/egl_platform.h"
#include "framework/gpu/osmesa_platform.h"

namespace aftershade::gpu {

std::unique_ptr<Platform> make_platform(const GlChoice& choice) {
    prepare_driver_cache();
    const bool is_osmesa = choice.backend == Backend::osmesa;
    if (is_osmesa && names_one_device(choice.device))
        throw Error(ErrorKind::gl, "OSMesa draws on no device; name none, or take another backend");
    if (is_osmesa) return make_osmesa_platform();
    return make_egl_platform(
        choice.backend == Backend::egl_software ? Renderer::software : Renderer::hardware, choice.device);
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
