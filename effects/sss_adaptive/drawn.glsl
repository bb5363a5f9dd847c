// What a frame's samples find.
#include <scattering/facet.glsl>
#include "epoch.glsl"
#include "mark.glsl"
#include "mip_level.glsl"

// Mean over about the area that the sample stands for, where that is all of one object.
vec3 light_of_sample(Facet there, vec2 place, float area_px) {
#if PREFILTER
    vec4 mean = textureLod(light, place * light_size.zw, mip_level(area_px));
    return abs(mean.a - mark_of(there.key)) < 1e-4 ? mean.rgb : there.light;
#else
    return there.light;
#endif
}

#include <scattering/gather.glsl>

// `each`: of the texture epoch. A pixel that takes no sample keeps its light.
Gathered drawn(ViewLines lines, ivec2 p, Facet here, float count, float each) {
    if (count < 0.5) return Gathered(here.light, vec3(1.0), vec3(1.0));
    return gathered(lines, p, here, first_point(each), int(count));
}
