#version 450 core
#include <pass>
#include <scattering/lines.glsl>
#include "shadow.glsl"
#include "spread.glsl"

// Along the lines.
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    Shadow own = unpacked_shadow(texelFetch(shadow, at, 0));
    float per_mm = own.key != 0u ? pixels_per_mm(view_lines(), own.depth_m) : 0.0;
    vec3 sigma_mm = blur_sigma_mm(scattering_profile(own.key - 1u).d, max(per_mm, 1e-6));
    int reach = own.key != 0u ? reach_px(sigma_mm, per_mm) : -1;
    Spread spread = nothing();
    for (int i = -reach; i <= reach; ++i) {
        ivec2 there = ivec2(at.x + i, at.y);
        if (there.x < 0 || there.x >= frame.size.x) continue;
        Shadow other = unpacked_shadow(texelFetch(shadow, there, 0));
        if (other.key != own.key) continue;
        float off_mm = length(vec2(float(i) / per_mm, (other.depth_m - own.depth_m) * param.world_unit));
        add(spread, other.seen, other.seen, other.seen, vec3(other.trust), off_mm, sigma_mm);
    }
    finish(spread, sigma_mm, per_mm, own.depth_m, own.key, out_blurred, out_range);
}
