#version 450 core
#include <pass>
#define TAPS param.blur_samples
#define KEEPS_OWN 0
#include <scattering/blur.glsl>
#include "past.glsl"
#include "tile.glsl"

// Where nothing within reach changed, the frame before has the same.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if ALONG_ROWS
    bool stale = texelFetch(stale_rows, p / kTile, 0).r > 0.0;
    if (!stale) out_rows = texelFetch(rows_prev, p, 0);
#else
    bool stale = texelFetch(stale_columns, p / kTile, 0).r > 0.0;
    if (!stale) out_blurred = texelFetch(blurred_prev, p, 0);
#endif
    if (!stale) return;
    Lit here = unpack(texelFetch(SOURCE, p, 0));
    vec3 light = blurred_light(view_lines(), p, here);
#if ALONG_ROWS
    out_rows = pack(Lit(light, here.depth_m, here.key));
#else
    out_blurred = vec4(light, key_of(here.key));
#endif
}
