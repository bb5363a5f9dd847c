#version 450 core
#include <pass>
#include "place.glsl"
#include <lighting/lighting.glsl>
#include "tables.glsl"
#include "bend.glsl"
#include "shadow.glsl"
#include "normal_distribution.glsl"
#include <scattering/result.glsl>

// The lights' share of the irradiance is taken away and comes back scattered: for each light what the table says for its
// N.L and the curvature, times what the other table says for the shadow.

float curvature_per_mm(ivec2 at, uint key, float depth_m) {
    int step_px = max(bend_step(key, depth_m) / 2, 1);
    vec2 sum = vec2(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 there = clamp(at + step_px * ivec2(x, y), ivec2(0), frame.size - 1);
            if (key_at(there) == key) sum += texelFetch(bend, there, 0).rg;
        }
    return sum.y > 0.0 ? sqrt(sum.x / sum.y) : 0.0;
}

vec3 more_light(int profile, float cosine, float curvature) {
    vec2 at = vec2(ball_column(clamp(cosine, -1.0, 1.0)), ball_line(curvature) + float(kBallLines * profile)) + 0.5;
    return textureLod(ball_table, at * ball_table_size.zw, 0.0).rgb;
}

#if PENUMBRA == 1
vec3 blurred_seen(ivec2 at) { return uintBitsToFloat(texelFetch(blurred, at, 0).rgb); }

// Change of the blurred shadow from a pixel to the next one along `axis`, for each px, and the way there in mm.
void change(ivec2 at, ivec2 axis, uint key, vec3 own, vec3 p, out vec3 by, out vec3 way) {
    ivec2 next = at + axis, last = at - axis;
    bool has_next = all(lessThan(next, frame.size)) && key_at(next) == key;
    bool has_last = all(greaterThanEqual(last, ivec2(0))) && key_at(last) == key;
    vec3 next_p = place_mm(next);
    vec3 last_p = place_mm(last);
    by = (has_next ? blurred_seen(next) : own) - (has_last ? blurred_seen(last) : own);
    way = (has_next ? next_p : p) - (has_last ? last_p : p);
}

// Length of the gradient over the surface, 1/mm: two slanting ways and what changes along them.
vec3 gradient_length(vec3 by_x, vec3 x, vec3 by_y, vec3 y) {
    float xx = dot(x, x), xy = dot(x, y), yy = dot(y, y), determinant = xx * yy - xy * xy;
    if (determinant <= 1e-6 * xx * yy) return sqrt(xx >= yy ? by_x * by_x / max(xx, 1e-20) : by_y * by_y / yy);
    return sqrt(max(by_x * by_x * yy - 2.0 * by_x * by_y * xy + by_y * by_y * xx, 0.0) / determinant);
}

float edge_light(int profile, int c, float distance, float width) {
    vec2 at = vec2(edge_column(abs(distance), width), edge_line(width) + float(kEdgeLines * profile)) + 0.5;
    float light = textureLod(edge_table, at * edge_table_size.zw, 0.0)[c];
    return distance < 0.0 ? 1.0 - light : light;
}

// The blur has made every edge wide; its value and slope tell how far away the edge is and how wide it was. For the widest
// edges the blurred shadow itself is the answer.
vec3 scattered_shadow(ivec2 at, uint key, float depth_m, ScatteringProfileRow row) {
    vec3 own = blurred_seen(at), by_x, by_y, x, y;
    uvec4 around = texelFetch(range, at, 0);
    vec3 least = unpacked_share(around.x), spread = unpacked_share(around.y) - least;
    vec3 p = place_mm(gl_FragCoord.xy, depth_m);
    change(at, ivec2(1, 0), key, own, p, by_x, x);
    change(at, ivec2(0, 1), key, own, p, by_y, y);
    vec3 slope = gradient_length(by_x, x, by_y, y) / max(spread, 1e-6);
    vec3 sigma = blur_sigma_mm(row.d, pixels_per_mm(view_lines(), depth_m));
    vec3 result = own;
    for (int c = 0; c < 3; ++c) {
        float share = clamp((own[c] - least[c]) / max(spread[c], 1e-6), 1e-6, 1.0 - 1e-6);
        float deviations = normal_quantile(share);
        // 3 %: what differences of pixels and the cut of the blur can make of a sharp edge.
        float whole = max(normal_density(deviations) / max(slope[c], 1e-20) / 1.03, sigma[c]);
        float width = sqrt(whole * whole - sigma[c] * sigma[c]) / row.d[c];
        if (spread[c] < 0.02 || width > kWidestEdge) continue;
        result[c] = least[c] + spread[c] * edge_light(row.index, c, deviations * whole / row.d[c], width);
    }
    return result;
}
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint key = key_at(at);
    vec4 point = texelFetch(surface, at, 0);
    vec3 n = texelFetch(normal, at, 0).xyz;
    vec3 position_m = world_position_m(gl_FragCoord.xy, point.a);
    ScatteringProfileRow row = scattering_profile(key - 1u);
    float curvature = curvature_per_mm(at, key, point.a) * max(row.d.r, max(row.d.g, row.d.b));
    vec3 without = vec3(0.0), with = vec3(0.0);
    for (int i = 0; i < light_count(); ++i) {
        Arriving one = arriving(i, position_m);
        float cosine = dot(n, one.toward);
        without += one.light * max(cosine, 0.0);
        with += one.light * (max(cosine, 0.0) + more_light(row.index, cosine, curvature));
    }
    vec3 seen = seen_share(point.rgb, without);
    vec3 after = seen;
#if PENUMBRA == 1
    after = scattered_shadow(at, key, point.a, row);
#endif
    vec3 result = max(point.rgb - seen * without + after * with, 0.0);
    // The tables have no room for more profiles.
    out_irradiance = row.index < kProfiles ? scattered_result(at, result) : texelFetch(irradiance, at, 0);
}
