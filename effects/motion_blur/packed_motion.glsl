// Motion of the picture's pixels, which the pass motion has packed.
#include "motion.glsl"

uvec2 packed_path_at(ivec2 p) { return texelFetch(motion, p, 0).xy; }

vec4 path_of(ivec2 p) { return unpack_path(packed_path_at(p)); }

#ifdef SHARES_PIXELS
vec2 depth_and_share(ivec2 p) { return texelFetch(motion_share, p, 0).xy; }
#else
vec2 depth_and_share(ivec2 p) { return vec2(texelFetch(depth, p, 0).r, 1.0); }
#endif

float depth_of(ivec2 p) { return depth_and_share(p).x; }

Motion packed_motion(ivec2 p) {
    vec2 known = depth_and_share(p);
    return Motion(path_of(p), known.x, known.y);
}
