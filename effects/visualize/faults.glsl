#include <false_color.glsl>
#include "mode.glsl"

// The loudest of the faults.
vec3 fault_color(int faults) {
    if ((faults & kNan) != 0) return vec3(FALSE_COLOR_NAN);
    if ((faults & kInfinite) != 0) return vec3(FALSE_COLOR_INFINITE);
    if ((faults & kNegative) != 0) return vec3(FALSE_COLOR_NEGATIVE);
    return vec3(FALSE_COLOR_NOTHING_HIT);
}
