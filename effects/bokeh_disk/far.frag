#version 450 core
#include <pass>
#include "columns.glsl"

// Less of the kernel than this is too little to tell a colour from: what the kernel has below 0 would show.
const float kLeastShare = 0.05;

// What the kernel has below 0 makes dark rims around highlights; a mean is never less than the least of what it is of. Guessed
// from five places.
vec4 least_around(ivec2 p, vec4 own, float radius_px) {
    int apart = int(0.7 * radius_px + 0.5);
    vec4 least = own;
    for (int i = 0; i < 4; ++i) {
        ivec2 to = apart * ivec2((i & 1) * 2 - 1, (i & 2) - 1);
        least = min(least, unpack_light(texelFetch(FIELD, clamp(p + to, ivec2(0), frame.size - 1), 0)).color);
    }
    return max(least, 0.0);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 reach_px = texelFetch(reach, p / kTile, 0);
    Light centre = unpack_light(texelFetch(FIELD, p, 0));
    out_far = uvec4(0u);
    // A pixel in focus shows nothing of what is behind it.
    if (reach_px.y < kLeastBlurPx || abs(centre.coc) < kLeastBlurPx) return;
    float radius_px = gather_radius(centre, reach_px);
    Blurred sum = blur_columns(p, radius_px);
    float share = sum.weight / sum.whole;
    if (share <= kLeastShare) return;
    vec4 color = max(sum.color / sum.weight, least_around(p, centre.color, radius_px));
    out_far = pack_light(Light(color, min(share, 1.0)));
}
