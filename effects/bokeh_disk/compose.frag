#version 450 core
#include <pass>
#include "columns.glsl"

// Between these CoC radii a pixel's own colour gives way to the blurred field's.
const float kSharpPx = 0.5, kBlurredPx = 1.5;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(color, p, 0);
    vec4 reach_px = texelFetch(reach, p / kTile, 0);
    out_color = own;
    if (max(reach_px.x, reach_px.y) < kLeastBlurPx) return;

    Light centre = unpack_light(texelFetch(light, p, 0));
    Light under = unpack_light(texelFetch(BEHIND, p, 0));
    Light beyond = unpack_light(texelFetch(far, p, 0));
    float blurred = under.coc > 0.0 && beyond.coc > 0.0 ? smoothstep(kSharpPx, kBlurredPx, under.coc) : 0.0;
    vec4 base = blurred > 0.0 ? mix(under.color, beyond.color, blurred) : under.color;
    out_color = base;
    if (reach_px.x < kLeastBlurPx) return;

    Blurred near = blur_columns(p, gather_radius(centre, reach_px));
    float opacity = clamp(near.weight / near.whole, 0.0, 1.0);
    if (opacity == 0.0) return;
    vec4 color = max(near.color / near.weight, 0.0);
    if (centre.coc < 0.0) {
        // Where no layer has what lies behind near pixels, the field behind the focus plane goes on, where there is any; else the
        // near field is closed.
        float near_share = smoothstep(kSharpPx, kBlurredPx, -centre.coc);
        if (under.coc < 0.0) base = mix(color, beyond.color, beyond.coc);
        base = mix(own, base, near_share);
        color = mix(own, color, near_share);
    }
    out_color = mix(base, color, opacity);
}
