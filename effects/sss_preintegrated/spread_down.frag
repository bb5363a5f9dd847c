#version 450 core
#include <pass>
#include <scattering/lines.glsl>
#include "shadow.glsl"
#include "spread.glsl"

// Along the columns, over what spread_across left.
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec4 own = texelFetch(range, at, 0);
    float depth_m = uintBitsToFloat(own.z);
    float per_mm = own.w != 0u ? pixels_per_mm(view_lines(), depth_m) : 0.0;
    vec3 sigma_mm = blur_sigma_mm(scattering_profile(own.w - 1u).d, max(per_mm, 1e-6));
    int reach = own.w != 0u ? reach_px(sigma_mm, per_mm) : -1;
    Spread spread = nothing();
    for (int i = -reach; i <= reach; ++i) {
        ivec2 there = ivec2(at.x, at.y + i);
        if (there.y < 0 || there.y >= frame.size.y) continue;
        uvec4 other = texelFetch(range, there, 0);
        if (other.w != own.w) continue;
        uvec4 light = texelFetch(blurred, there, 0);
        float off_mm = length(vec2(float(i) / per_mm, (uintBitsToFloat(other.z) - depth_m) * param.world_unit));
        add(spread, uintBitsToFloat(light.rgb), unpacked_share(other.x), unpacked_share(other.y), unpacked_weight(light.a),
            off_mm, sigma_mm);
    }
    finish(spread, sigma_mm, per_mm, depth_m, own.w, out_blurred, out_range);
}
