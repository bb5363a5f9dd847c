// Part of a layer: its light, its opacity, and how much is known about it.
#include "layers.glsl"
#include <lens/own.glsl>

struct Part {
    vec4 light;
    vec2 share;
};

// What is known of the surface behind a pixel: its light, premultiplied, and its CoC radius, px.
struct Behind {
    vec4 color;
    float coc_px;
};

#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
#define KNOWS_BEHIND 1
#include <lens/coc.glsl>

Behind behind_at(ivec2 p) {
    float px_per_mm = float(frame.display_size.x) / param.sensor_width;
    float at_infinity_px = coc_radius_at_infinity_px(param.focus_distance, param.focal_length, param.f_number, px_per_mm,
                                                     LENS_MODEL == LENS_MODEL_THIN);
    return Behind(texelFetch(second, p, 0), coc_radius_px(texelFetch(second_depth, p, 0).r, param.focus_distance, at_infinity_px));
}
#elif defined(HAS_BEHIND)
#define KNOWS_BEHIND 1

Behind behind_at(ivec2 p) { return Behind(texelFetch(behind, p, 0), texelFetch(behind_coc, p, 0).r); }
#endif

// What one pixel is in the layer of this pass: what is seen there, or what the capture has behind it, or the push-pull.
Part part_at(ivec2 p, Layers layers) {
    float behind = float(pass.index) - layer_of(layers, texelFetch(coc, p, 0).r);
    float seen = seen_in(behind), hidden = hidden_in(behind);
    Part part = Part(vec4(0.0), vec2(seen, seen_from(behind)));
    if (seen > 0.0) part.light = seen * own_color(p);
    if (hidden > 0.0) {
        vec3 at = vec3((vec2(p) + 0.5) * color_size.zw, float(pass.index));
#ifdef KNOWS_BEHIND
        Behind known = behind_at(p);
        if (known.color.a > 0.0) {
            // What the picture shows nowhere is at the nearest or the farthest layer.
            float deeper = float(pass.index) - layer_of(layers, clamp(known.coc_px, -layers.near_px - kSharp, layers.far_px + kSharp));
            part.light += hidden * seen_in(deeper) * known.color;
            part.share += hidden * vec2(seen_in(deeper) * known.color.a, seen_from(deeper));
            hidden *= hidden_in(deeper);
        }
#endif
        part.light += hidden * textureLod(hidden_light, at, 0.0);
        part.share += hidden * textureLod(hidden_share, at, 0.0).rg;
    }
    return part;
}
