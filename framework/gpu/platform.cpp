#include "framework/gpu/platform.h"

#include <algorithm>
#include <array>

#include <dlfcn.h>
#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/base/text.h"
#include "framework/gpu/driver_faults.h"

namespace aftershade::gpu {

bool is_software_renderer(std::string_view renderer) {
    // WARP calls itself Microsoft Basic Render Driver, alone and below Mesa's d3d12.
    static constexpr std::array<std::string_view, 9> kNames = {"llvmpipe",
                                                               "lavapipe",
                                                               "softpipe",
                                                               "swrast",
                                                               "software rasterizer",
                                                               "swiftshader",
                                                               "microsoft basic render",
                                                               "direct3d warp",
                                                               "openswr"};
    const std::string lower = lower_case(renderer);
    return std::any_of(kNames.begin(), kNames.end(),
                       [&](std::string_view name) { return lower.find(name) != std::string::npos; });
}

namespace {

/// Whether the loader says that it finds no file of the library itself. A library that it finds and cannot
/// load has an undefined symbol, or lacks another one, which the loader then names without a path.
bool is_absent(std::string_view message, std::string_view name) {
    const std::string_view file = message.substr(0, message.find(':'));
    return message.find("cannot open shared object file: No such file") != std::string_view::npos &&
           (file == name || file.find('/') != std::string_view::npos);
}

}  // namespace

void* open_library(std::initializer_list<const char*> names, std::string_view package) {
    std::string absent;
    for (const char* name : names) {
        if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
        const char* said = dlerror();
        const std::string message = said ? said : name;
        if (said && !is_absent(message, name))
            throw Error(ErrorKind::gl, fmt::format("{} is there, but the loader refuses it: {}{}", name,
                                                   message, loader_remedy(message)));
        if (absent.empty()) absent = message;
    }
    throw AbsentLibrary(absent, fmt::format("; install the Debian package {}", package));
}

std::string gl_string(const Platform& platform, unsigned int name) {
    using GetString = const unsigned char* (*)(unsigned int);
    const auto get_string = reinterpret_cast<GetString>(platform.proc("glGetString"));
    const unsigned char* text = get_string ? get_string(name) : nullptr;
    return text ? reinterpret_cast<const char*>(text) : "";
}

}  // namespace aftershade::gpu
