#version 450 core
#include <pass>
#include "wide.glsl"

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    bool is_drawn = is_blurred(tile), is_wide_too = is_drawn && is_wide(tile), is_silhouette = is_plated(tile, is_drawn);
    out_wide_tile = is_wide_too ? 1.0 : 0.0;
    out_plain_tile = is_drawn && !is_silhouette ? 1.0 : 0.0;
    out_silhouette_tile = is_drawn && is_silhouette ? 1.0 : 0.0;
    out_wide_plain_tile = is_wide_too && !is_silhouette ? 1.0 : 0.0;
    out_wide_silhouette_tile = is_wide_too && is_silhouette ? 1.0 : 0.0;
}
