// What the types of numbers share. Internal to framework/document/param_types.
#pragma once

#include <string_view>

#include "framework/document/param_type.h"

namespace aftershade {

/// A block type of numbers with a range, continuous; the rest is the type's own.
constexpr ParamTypeTraits number_traits(std::string_view name, int components, std::string_view glsl_type) {
    ParamTypeTraits traits;
    traits.name = name;
    traits.components = components;
    traits.glsl_type = glsl_type;
    traits.has_range = true;
    traits.is_scalar = components == 1;
    traits.is_continuous = true;
    return traits;
}

}  // namespace aftershade
