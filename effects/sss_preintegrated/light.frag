#version 450 core
#include <pass>
#include "shape.glsl"
#include <lighting/lighting.glsl>
#include "tables.glsl"
#include "bend.glsl"
#include "shadow.glsl"
#include "normal_distribution.glsl"
#include <scattering/result.glsl>

// The lights' share of the irradiance is taken away and comes back scattered: for each light what the table says for its
// N.L and the curvature, times what the other table says for the shadow.

// Of the pixels around: curvature, and bend with its sign, 1/mm.
vec2 bend_per_mm(ivec2 at, ScatteringProfileRow row, Shape own) {
    int step_px = max(bend_step(row, own.depth_m) / 4, 1);
    vec3 sum = vec3(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 there = clamp(at + step_px * ivec2(x, y), ivec2(0), frame.size - 1);
            if (texelFetch(shape, there, 0).r == own.key) sum += texelFetch(bend, there, 0).rgb;
        }
    return sum.y > 0.0 ? vec2(sqrt(sum.x / sum.y), sum.z / sum.y) : vec2(0.0);
}

// Bumps that are small against the profile shade as if they were not there, the more so the farther the channel's light goes
// (Penner and Borshukov): normals blurred for each channel. What a ball of that bend would turn the normals by is taken out
// of them first, so that its own remain as they are, at its silhouette too.
const int kNormals = 24;
const float kNormalReach = 4.0;  // d: taps are 2.1 d away in the mean, light 2.5 d
mat3 blurred_normals(ivec2 at, ScatteringProfileRow row, Shape own, vec3 normal, float bend_per_mm) {
    vec3 p = place_mm(at, own), reach_mm = kNormalReach * row.d;
    float reach_px = widest(reach_mm) * pixels_per_mm(view_lines(), own.depth_m);
    mat3 sum = mat3(normal, normal, normal) * (0.25 / float(kNormals));
    for (int i = 0; i < kNormals; ++i) {
        // As many taps for each distance, which stand for areas that grow with it; turned by the golden angle.
        float share = (float(i) + 0.5) / float(kNormals), angle = 2.39996323 * float(i);
        ivec2 there = at + ivec2(round(share * reach_px * vec2(cos(angle), sin(angle))));
        Shape other = shape_at(there);
        if (other.key != own.key) continue;
        vec3 way = place_mm(there, other) - p, off = length(way) / reach_mm;
        vec3 weight = share * max(1.0 - off * off, 0.0), flat_normal = other.normal - bend_per_mm * way_in_world(way);
        for (int c = 0; c < 3; ++c) sum[c] += weight[c] * flat_normal;
    }
    return mat3(normalize(sum[0]), normalize(sum[1]), normalize(sum[2]));
}

float ball_light(int profile, int c, float cosine, float curvature) {
    vec2 at = vec2(ball_column(clamp(cosine, -1.0, 1.0)), ball_line(curvature) + float(kBallLines * profile)) + 0.5;
    return max(cosine, 0.0) + textureLod(ball_table, at * ball_table_size.zw, 0.0)[c];
}

#if PENUMBRA == 1
vec3 blurred_seen(ivec2 at) { return uintBitsToFloat(texelFetch(blurred, at, 0).rgb); }

// Change of the blurred shadow from a pixel to the next one along `axis`, for each px, and the way there in mm.
void change(ivec2 at, ivec2 axis, Shape own, vec3 seen, vec3 p, out vec3 by, out vec3 way) {
    Shape next = shape_at(at + axis), last = shape_at(at - axis);
    bool has_next = next.key == own.key, has_last = last.key == own.key;
    by = (has_next ? blurred_seen(at + axis) : seen) - (has_last ? blurred_seen(at - axis) : seen);
    way = (has_next ? place_mm(at + axis, next) : p) - (has_last ? place_mm(at - axis, last) : p);
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
vec3 scattered_shadow(ivec2 at, Shape own, ScatteringProfileRow row) {
    vec3 seen = blurred_seen(at), p = place_mm(at, own), by_x, by_y, x, y;
    uvec4 around = texelFetch(range, at, 0);
    vec3 least = unpacked_share(around.x), spread = unpacked_share(around.y) - least;
    change(at, ivec2(1, 0), own, seen, p, by_x, x);
    change(at, ivec2(0, 1), own, seen, p, by_y, y);
    vec3 slope = gradient_length(by_x, x, by_y, y) / max(spread, 1e-6);
    vec3 sigma = blur_sigma_mm(row.d, pixels_per_mm(view_lines(), own.depth_m));
    vec3 result = seen;
    for (int c = 0; c < 3; ++c) {
        float share = clamp((seen[c] - least[c]) / max(spread[c], 1e-6), 1e-6, 1.0 - 1e-6);
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
    Shape own = shape_at(at);
    vec3 light = texelFetch(surface, at, 0).rgb, n = texelFetch(normal, at, 0).xyz;
    vec3 position_m = world_position_m(gl_FragCoord.xy, own.depth_m);
    ScatteringProfileRow row = scattering_profile(own.key - 1u);
    vec2 bent = bend_per_mm(at, row, own);
    mat3 normals = blurred_normals(at, row, own, n, bent.y);
    vec3 without = vec3(0.0), with = vec3(0.0);
    for (int i = 0; i < light_count(); ++i) {
        Arriving one = arriving(i, position_m);
        without += one.light * max(dot(n, one.toward), 0.0);
        for (int c = 0; c < 3; ++c)
            with[c] += one.light[c] * ball_light(row.index, c, dot(normals[c], one.toward), bent.x * widest(row.d));
    }
    vec3 seen = seen_share(light, without), after = seen;
#if PENUMBRA == 1
    after = scattered_shadow(at, own, row);
#endif
    vec3 result = max(light - seen * without + after * with, 0.0);
    // The tables have no room for more profiles.
    out_irradiance = row.index < kProfiles ? scattered_result(at, result) : texelFetch(irradiance, at, 0);
}
