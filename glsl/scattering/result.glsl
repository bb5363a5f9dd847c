// What leaves an effect of the module scattering: mixed_result() by the texture facet.
#include <scattering/mixed.glsl>

vec4 scattered_result(ivec2 pixel, vec3 scattered) {
    return mixed_result(pixel, texelFetch(facet, pixel, 0).r, scattered);
}
