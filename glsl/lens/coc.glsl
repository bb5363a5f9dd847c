// Circle of confusion of a thin lens. Post 2013, Depth of Field and Motion Blur in Realtime Computer Graphics,
// equation 2.1; Potmesil and Chakravarty 1981.

// Signed CoC *radius* in px of a point at infinity. It is the asymptote of every depth:
// radius(z) = at_infinity * (1 - focus / z), negative in front of the focus plane.
// The `thin` model images the focus plane sharply at f S1 / (S1 - f); `pinhole` keeps the perspective of a camera whose
// sensor lies at f, as Blender and ray tracers do, and has S1 where `thin` has S1 - f.
float coc_radius_at_infinity_px(float focus_m, float focal_length_mm, float f_number, float px_per_mm, bool thin) {
    float focus_mm = focus_m * 1000.0;
    float aperture_diameter_mm = focal_length_mm / f_number;
    float distance_mm = thin ? max(focus_mm - focal_length_mm, 1.0) : focus_mm;
    return 0.5 * aperture_diameter_mm * focal_length_mm / distance_mm * px_per_mm;
}

// depth_m: along the view axis; +inf, and anything that is no distance, counts as infinitely far.
float coc_radius_px(float depth_m, float focus_m, float at_infinity_px) {
    return depth_m > 0.0 ? at_infinity_px * (1.0 - focus_m / depth_m) : at_infinity_px;
}
