// The types that need nothing but document; each is a file of framework/document/param_types.
#include "framework/document/param.h"

namespace aftershade {

std::span<const ParamType> core_param_types() {
    static const ParamType types[] = {
        ParamType::float_, ParamType::int_,  ParamType::bool_,   ParamType::enum_, ParamType::angle,
        ParamType::color,  ParamType::vec2,  ParamType::vec3,    ParamType::vec4,  ParamType::curve,
        ParamType::file,   ParamType::table, ParamType::objects, ParamType::text,
    };
    return types;
}

}  // namespace aftershade
