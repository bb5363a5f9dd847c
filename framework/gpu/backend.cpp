#include "framework/gpu/backend.h"

#include <array>
#include <vector>

#include "framework/base/text.h"

namespace aftershade::gpu {

namespace {

constexpr std::array kChoices = {Backend::automatic, Backend::egl, Backend::software, Backend::egl_software,
                                 Backend::osmesa};

}  // namespace

std::optional<Backend> parse_backend(std::string_view name) {
    for (const Backend backend : kChoices)
        if (name == backend_name(backend)) return backend;
    return std::nullopt;
}

std::string backend_names() {
    std::vector<std::string> names;
    for (const Backend backend : kChoices) names.emplace_back(backend_name(backend));
    return joined(names, ", ");
}

std::string_view backend_name(Backend backend) {
    switch (backend) {
        case Backend::egl: return "egl";
        case Backend::egl_software: return "egl-software";
        case Backend::osmesa: return "osmesa";
        case Backend::software: return "software";
        case Backend::automatic: break;
    }
    return "auto";
}

}  // namespace aftershade::gpu
