#version 450 core
#include <pass>
#include "tile.glsl"
#include "grid.glsl"
#include "sample.glsl"

// Between these CoC radii a pixel's own colour gives way to the grid's.
const float kSharpPx = 0.5, kBlurredPx = 1.5;

struct Sum {
    vec4 blurred, sharp;
    float opacity, weight;
};

void add_point(inout Sum sum, usampler2D image, usampler2D light, ivec2 texel, float share, float coc) {
    if (share <= 0.0 || !is_in(texel, textureSize(image, 0))) return;
    Sample point = unpack_sample(texelFetch(image, texel, 0));
    float apart = abs(point.coc - coc);
    // A point of another surface stands in only where there is none of this one.
    float weight = share * point.weight * (clamp(2.0 - apart, 0.0, 1.0) + 1e-3 / (1.0 + apart * apart));
    sum.weight += weight;
    sum.blurred += weight * point.color;
    sum.opacity += weight * point.opacity;
    if (abs(coc) < kBlurredPx) sum.sharp += weight * unpack_sample(texelFetch(light, texel, 0)).color;
}

// Linear between the three points around the pixel.
Sum take(usampler2D image, usampler2D light, float spacing, ivec2 p, float coc) {
    Grid grid = make_grid(spacing);
    vec2 at = coordinates_of(grid, vec2(p) + 0.5), base = floor(at), part = at - base;
    ivec2 point = ivec2(base);
    bool second = part.x + part.y > 1.0;  // of the two triangles of a parallelogram
    Sum sum = Sum(vec4(0.0), vec4(0.0), 0.0, 0.0);
    add_point(sum, image, light, texel_of(grid, point + (second ? ivec2(1) : ivec2(0))), abs(1.0 - part.x - part.y), coc);
    add_point(sum, image, light, texel_of(grid, point + ivec2(1, 0)), second ? 1.0 - part.y : part.x, coc);
    add_point(sum, image, light, texel_of(grid, point + ivec2(0, 1)), second ? 1.0 - part.x : part.y, coc);
    return sum;
}

vec4 compose(ivec2 p, vec4 own, float blur_px) {
    float coc_px = texelFetch(coc, p, 0).r;
    Sum sum;
    if (blur_px < kCoarsePx) sum = take(fine, fine_light, 1.0, p, coc_px);
    else sum = take(coarse, coarse_light, 2.0, p, coc_px);
    float opacity = sum.opacity / max(sum.weight, 1e-9), blurred = smoothstep(kSharpPx, kBlurredPx, abs(coc_px));
    if (sum.weight <= 0.0 || (opacity == 0.0 && blurred == 0.0)) return own;
    // What lies over the pixel covers its own colour as it covers the grid's.
    vec4 result = sum.blurred / sum.weight;
    if (blurred < 1.0) result += (1.0 - blurred) * (1.0 - opacity) * (own - sum.sharp / sum.weight);
    return result;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_color = texelFetch(color, p, 0);
    float blur_px = texelFetch(grids, p / kTile, 0).y;
    if (blur_px >= kLeastBlurPx) out_color = compose(p, out_color, blur_px);
}
