#version 450 core
#include <pass>
#include "motion.glsl"
#ifdef HAS_FOREGROUND_PLACE
#include "foreground.glsl"
#endif

// But for the signs.
bool is_zero(uvec2 bits) { return ((bits.x | bits.y) & 0x7fffffffu) == 0u; }

// Software GL ends a loop once no pixel needs it: a tile in motion costs its first row.
void main() {
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy);
    uvec2 bits = uvec2(0u);
    for (int y = 0; y < kTile && is_zero(bits); ++y)
        for (int x = 0; x < kTile; ++x) {
            ivec2 p = min(corner + ivec2(x, y), frame.size - 1);
            bits |= floatBitsToUint(texelFetch(velocity, p, 0).xy);
#if defined(HAS_VELOCITY_NEXT) && CURVE
            bits |= floatBitsToUint(texelFetch(velocity_next, p, 0).xy);
#endif
#ifdef SHARES_PIXELS
            bits |= floatBitsToUint(texelFetch(first_velocity, p, 0).xy);
#endif
        }
#ifdef HAS_OUT_TILE_VEILED
    bool is_veiled = false;
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x) {
            ivec2 p = min(corner + ivec2(x, y), frame.size - 1), sender = sender_of(p);
            is_veiled = is_veiled || sender != p;
            bits |= floatBitsToUint(texelFetch(velocity, sender, 0).xy);
#if defined(HAS_VELOCITY_NEXT) && CURVE
            bits |= floatBitsToUint(texelFetch(velocity_next, sender, 0).xy);
#endif
#ifdef SHARES_PIXELS
            bits |= floatBitsToUint(texelFetch(first_velocity, sender, 0).xy);
#endif
        }
    out_tile_veiled = is_veiled ? 1.0 : 0.0;
#endif
    out_tile_moves = is_zero(bits) ? 0u : 1u;
#ifdef HAS_OUT_TILE_SCALE
    out_tile_scale = objects_default.scale;
#endif
}
