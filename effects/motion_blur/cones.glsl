// Weights of McGuire et al. 2012, section 2.3. Lengths in px.
#include "depth_order.glsl"

float cone(float distance_px, float way_px) { return clamp(1.0 - distance_px / max(way_px, 1e-3), 0.0, 1.0); }
float cylinder(float distance_px, float way_px) { return 1.0 - smoothstep(0.95 * way_px, 1.05 * way_px + 1e-3, distance_px); }

// 1 where `a` is not clearly behind `b`.
float soft_before(float a_m, float b_m) { return clamp(1.0 + nearness(a_m, b_m), 0.0, 1.0); }
