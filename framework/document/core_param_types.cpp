// The types that need nothing but document; each is a file of framework/document/param_types.
#include "framework/document/param.h"

namespace aftershade {

std::span<const ParamType> core_param_types() {
    static constexpr ParamType types[] = {
        kFloatParam, kIntParam,  kBoolParam,  kEnumParam, kAngleParam, kColorParam,   kVec2Param,
        kVec3Param,  kVec4Param, kCurveParam, kFileParam, kTableParam, kObjectsParam, kTextParam,
    };
    return types;
}

}  // namespace aftershade
