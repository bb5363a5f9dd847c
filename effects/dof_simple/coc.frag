#version 450 core
#include <pass>
#include <coc.glsl>

void main() {
    float px_per_mm = float(frame.display_size.x) / param.sensor_width;
    float at_infinity = coc_radius_at_infinity_px(param.focus_distance, param.focal_length, param.f_number, px_per_mm,
                                                  LENS_MODEL == LENS_MODEL_THIN);
    float coc = coc_radius_px(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r, param.focus_distance, at_infinity);
    out_coc = clamp(coc, -param.max_coc_radius, param.max_coc_radius);
}
