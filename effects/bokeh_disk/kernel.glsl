// A disk as a sum of components A Re(k(x) k(y)) + B Im(k(x) k(y)), where k(x) = exp(-a t^2) (cos b t^2 + i sin b t^2) and t is
// x in units of the disk's radius times kScale, with which the disk ends at its radius: there it has half of its mean.
#include <lens/highlight.glsl>
#include <lens/packing.glsl>
#include "tile.glsl"
#include "field.glsl"

// a, b, A, B.
#if COMPONENTS == 1
const float kScale = 1.143;
const vec4 kComponents[1] = vec4[](vec4(0.862325, 1.624835, 0.767583, 1.862321));
#elif COMPONENTS == 2
const float kScale = 1.111;
const vec4 kComponents[2] = vec4[](vec4(0.886528, 5.268909, 0.411259, -0.548794), vec4(1.960518, 1.558213, 0.513282, 4.56111));
#else
const float kScale = 1.106;
const vec4 kComponents[3] = vec4[](vec4(2.17649, 5.043495, 1.621035, -2.105439), vec4(1.019306, 9.027613, -0.28086, -0.162882),
                                   vec4(2.81511, 1.597273, -0.366471, 10.300301));
#endif

vec2 multiply(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

vec2 gaussian(vec4 component, float t_squared) {
    float phase = component.y * t_squared;
    return exp(-component.x * t_squared) * vec2(cos(phase), sin(phase));
}

// k at 0, 1, 2, ... px: each is the one before times a factor that itself grows by a factor.
struct Walk {
    vec2 k[COMPONENTS], factor[COMPONENTS], growth[COMPONENTS];
};

Walk start_walk(float radius_px) {
    float step = kScale / radius_px, step_squared = step * step;
    Walk walk;
    for (int i = 0; i < COMPONENTS; ++i) {
        walk.k[i] = vec2(1.0, 0.0);
        walk.factor[i] = gaussian(kComponents[i], step_squared);
        walk.growth[i] = gaussian(kComponents[i], 2.0 * step_squared);
    }
    return walk;
}

void step_on(inout Walk walk) {
    for (int i = 0; i < COMPONENTS; ++i) {
        walk.k[i] = multiply(walk.k[i], walk.factor[i]);
        walk.factor[i] = multiply(walk.factor[i], walk.growth[i]);
    }
}

// How much of a tap `distance_px` away lies within `reach_px`.
float cover(float reach_px, float distance_px) { return clamp(reach_px - distance_px + 0.5, 0.0, 1.0); }

// CoC radius in the field at hand: behind the focus plane, or before it.
float field_radius(float coc) { return NEAR == 1 ? -coc : coc; }

// The radius by which a pixel gathers: its own, or where it is not of this field, that of what may reach it. Behind the
// focus plane, a highlight that even spread outshines the pixel imposes its own, or it would not be round.
float gather_radius(Light centre, vec4 reach_px) {
    float own = field_radius(centre.coc);
    if (NEAR == 1) return own >= kLeastBlurPx ? own : reach_px.x;
    if (reach_px.z > amount(centre.color.rgb)) return reach_px.w;
    return own >= kLeastBlurPx ? own : reach_px.y;
}

// What a tap of the field counts at a distance: one with a clearly smaller CoC than the centre's, as far as its own reaches.
float seen(float tap_radius, float radius_px, float distance_px) {
    return mix(1.0, cover(tap_radius, distance_px), clamp(radius_px - tap_radius, 0.0, 1.0));
}
