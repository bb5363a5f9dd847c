#version 450 core
#include <pass>
#include "motion_here.glsl"

// But for the signs.
bool is_zero(uvec2 bits) { return ((bits.x | bits.y) & 0x7fffffffu) == 0u; }

// Software GL runs both sides of a branch, but a loop only while some pixel needs it: a tile at rest costs its fetches alone.
bool is_at_rest(ivec2 corner) {
    uvec2 bits = uvec2(0u);
    for (int y = 0; y < kTile && is_zero(bits); ++y)
        for (int x = 0; x < kTile; ++x) {
            vec2 place = (vec2(corner + ivec2(x, y)) + 0.5) * velocity_size.zw;
            bits |= floatBitsToUint(textureLod(velocity, place, 0.0).xy);
#if defined(HAS_VELOCITY_NEXT) && CURVE
            bits |= floatBitsToUint(textureLod(velocity_next, place, 0.0).xy);
#endif
#ifdef SHARES_PIXELS
            bits |= floatBitsToUint(textureLod(first_velocity, place, 0.0).xy);
#endif
        }
    return is_zero(bits);
}

void main() {
    ivec2 last = frame.size - 1, corner = kTile * ivec2(gl_FragCoord.xy);
    int side = is_at_rest(corner) ? 0 : kTile;
    vec4 furthest = vec4(0.0), low = vec4(1e30), high = vec4(-1e30);
    float way = 0.0, near_m = 3e38, far_m = 0.0;
    vec4 near = vec4(0.0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ivec2 p = min(corner + ivec2(x, y), last);
            Motion m = motion_here(p);
            low = min(low, m.path);
            high = max(high, m.path);
#ifdef SHARES_PIXELS
            if (m.share < 1.0) {
                vec4 behind = second_motion(p).path;
                low = min(low, behind);
                high = max(high, behind);
            }
#endif
            near = m.depth_m < near_m ? m.path : near;
            near_m = min(near_m, m.depth_m);
            far_m = max(far_m, m.depth_m);
            furthest = m.way_px > way ? m.path : furthest;
            way = max(way, m.way_px);
        }
    out_tile_path = furthest;
    out_tile_near = near;
    out_tile_way = vec2(way, far_m);
    out_tile_depth = near_m;
    out_tile_low = side > 0 ? low : vec4(0.0);
    out_tile_high = side > 0 ? high : vec4(0.0);
}
