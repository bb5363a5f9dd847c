// The types that need nothing but core; each is a file of framework/core/param_types.
#include "framework/core/param.h"

namespace aftershade {

std::span<const ParamType> core_param_types() {
    static constexpr ParamType types[] = {
        kFloatParam, kIntParam,  kBoolParam,  kEnumParam, kAngleParam, kColorParam,   kVec2Param,
        kVec3Param,  kVec4Param, kCurveParam, kFileParam, kTableParam, kObjectsParam,
    };
    return types;
}

}  // namespace aftershade
