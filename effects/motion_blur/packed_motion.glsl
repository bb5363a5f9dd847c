// Motion of the picture's pixels, which the pass motion has packed.
#include "motion.glsl"

#ifdef HAS_FOREGROUND_PLACE
#include "foreground.glsl"
#endif

// Where light of the lens covers a surface, a pixel that shows that surface.
ivec2 shown_at(ivec2 p) {
#ifdef VEILED
    return covered_by_light(p);
#else
    return p;
#endif
}

uvec2 packed_path_at(ivec2 p) { return texelFetch(motion, shown_at(p), 0).xy; }

vec4 path_of(ivec2 p) { return unpack_path(packed_path_at(p)); }

#ifdef SHARES_PIXELS
vec2 depth_and_share(ivec2 p) {
    ivec2 shown = shown_at(p);
    vec2 known = texelFetch(motion_share, shown, 0).xy;
    return vec2(known.x, shown == p ? known.y : 1.0);
}
#else
vec2 depth_and_share(ivec2 p) { return vec2(texelFetch(depth, shown_at(p), 0).r, 1.0); }
#endif

float depth_of(ivec2 p) { return depth_and_share(p).x; }

Motion packed_motion(ivec2 p) {
    vec2 known = depth_and_share(p);
    return Motion(path_of(p), known.x, known.y);
}
