// The CoC of a depth, by the module's parameters.
#include "coc.glsl"

float lens_at_infinity_px() {
    float px_per_mm = float(frame.display_size.x) / param.sensor_width;
    return coc_radius_at_infinity_px(param.focus_distance, param.focal_length, param.f_number, px_per_mm,
                                     LENS_MODEL == LENS_MODEL_THIN);
}

// Signed CoC radius of a depth, px.
float coc_of(float depth_m, float at_infinity_px) {
    float coc = coc_radius_px(depth_m, param.focus_distance, at_infinity_px);
    return clamp(coc, -param.max_coc_radius, param.max_coc_radius);
}
