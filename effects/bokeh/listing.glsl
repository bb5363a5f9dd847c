// Post 2013, Depth of Field and Motion Blur in Realtime Computer Graphics, listings A.1 and A.2, to the
// letter: taps at even distances from end to end of a line, through the picture's own CoC and depth in both passes.
// Irrlicht, which Post draws with, filters textures bilinearly unless told otherwise, and so do these taps; in full
// precision, by four texels each.
//
// Not the listing's: the edges clamp, the alpha, which it sets to 1, is blurred as the colour, and what is exactly in
// focus is copied.
#include "outline.glsl"

struct Bilinear {
    ivec2 low, high;
    vec2 part;
};

Bilinear bilinear_at(vec2 at_px) {
    ivec2 last = textureSize(coc, 0) - 1, corner = ivec2(floor(at_px - 0.5));
    return Bilinear(clamp(corner, ivec2(0), last), clamp(corner + 1, ivec2(0), last), at_px - 0.5 - vec2(corner));
}

vec4 mixed(vec4 a, vec4 b, vec4 c, vec4 d, vec2 part) { return mix(mix(a, b, part.x), mix(c, d, part.x), part.y); }

vec4 light_at(sampler2D image, Bilinear tap) {
    return mixed(texelFetch(image, tap.low, 0), texelFetch(image, ivec2(tap.high.x, tap.low.y), 0),
                 texelFetch(image, ivec2(tap.low.x, tap.high.y), 0), texelFetch(image, tap.high, 0), tap.part);
}

// CoC from 0 to 1, and depth: what has no end is as far as the greatest float, so that mixing stays a number.
vec2 coc_and_depth(ivec2 p) {
    float depth_m = texelFetch(depth, p, 0).r;
    return vec2(abs(texelFetch(coc, p, 0).r) / param.max_coc_radius, depth_m > 0.0 ? min(depth_m, 1e30) : 1e30);
}

vec2 coc_and_depth_at(Bilinear tap) {
    vec4 a = coc_and_depth(tap.low).xyxy, b = coc_and_depth(ivec2(tap.high.x, tap.low.y)).xyxy;
    vec4 c = coc_and_depth(ivec2(tap.low.x, tap.high.y)).xyxy, d = coc_and_depth(tap.high).xyxy;
    return mixed(a, b, c, d, tap.part).xy;
}

// The end of the line for a CoC of 1, px: listing A.1's point.
vec2 line_end_px(float degrees) {
    return param.listing_radius * float(frame.display_size.y) * squeezed(direction(degrees));
}

vec4 listing_blur(sampler2D image, float degrees) {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 centre = coc_and_depth(p), end_px = line_end_px(degrees) * centre.x;
    if (centre.x == 0.0) return texelFetch(image, p, 0);
    int taps = param.taps > 0 ? max(param.taps, 2) : 6;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < taps; ++i) {
        Bilinear tap = bilinear_at(gl_FragCoord.xy + mix(-end_px, end_px, float(i) / float(taps - 1)));
        vec2 there = coc_and_depth_at(tap);
        float weight = there.y < centre.y ? there.x * param.bleed_multiplier : 1.0;
        weight = clamp(centre.x > there.x + param.bleed_bias ? weight : 1.0, 0.0, 1.0);
        sum += weight * light_at(image, tap);
        weights += weight;
    }
    return weights > 1e-6 ? sum / weights : texelFetch(image, p, 0);
}
