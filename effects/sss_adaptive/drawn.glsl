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

struct Drawn {
    vec3 light;   // scattered; the pixel's own where it takes no sample
    float count;
    vec3 share;   // of the profile, that was found
};

// `each`: of the texture epoch. scattered: share of the scattered light in the result.
Drawn drawn_light(ViewLines lines, ivec2 p, Facet here, float count, float each, float scattered) {
    Drawn drawn = Drawn(here.light, count, vec3(1.0));
    if (count < 0.5) return drawn;
    vec3 gathered = gathered_light(lines, p, here, first_point(each), int(count), drawn.share);
    drawn.light = mix(here.light, gathered, scattered);
    return drawn;
}
