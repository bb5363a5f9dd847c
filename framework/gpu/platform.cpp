#include "framework/gpu/platform.h"

#include <algorithm>
#include <array>

#include <dlfcn.h>
#include <fmt/format.h>

#include "framework/core/error.h"
#include "framework/core/memory_limit.h"
#include "framework/core/text.h"
#include "framework/gpu/egl_platform.h"
#include "framework/gpu/osmesa_platform.h"

namespace aftershade::gpu {

std::unique_ptr<Platform> make_platform(Backend backend) {
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

bool is_software_renderer(std::string_view renderer) {
    static constexpr std::array<std::string_view, 5> kNames = {"llvmpipe", "softpipe", "swrast",
                                                               "software rasterizer", "swiftshader"};
    const std::string lower = lower_case(renderer);
    return std::any_of(kNames.begin(), kNames.end(),
                       [&](std::string_view name) { return lower.find(name) != std::string::npos; });
}

void* open_library(std::initializer_list<const char*> names, std::string_view package) {
    std::string reason;
    for (const char* name : names) {
        if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
        const char* message = dlerror();
        if (reason.empty()) reason = message ? message : name;
    }
    throw AbsentLibrary(reason, fmt::format("; install the Debian package {}", package));
}

std::string gl_string(const Platform& platform, unsigned int name) {
    using GetString = const unsigned char* (*)(unsigned int);
    const auto get_string = reinterpret_cast<GetString>(platform.proc("glGetString"));
    const unsigned char* text = get_string ? get_string(name) : nullptr;
    return text ? reinterpret_cast<const char*>(text) : "";
}

}  // namespace aftershade::gpu
