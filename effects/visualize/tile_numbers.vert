#version 450 core
#include <pass>
#include "letter.glsl"

const int kLetters = 5;  // of a tile, as the manifest says

// Nothing where it does not fit.
void main() {
    no_letter();
    int tiles_in_row = int(longest_size.x), index = gl_InstanceID / kLetters, at = gl_InstanceID % kLetters;
    ivec2 tile = ivec2(index % tiles_in_row, index / tiles_in_row);
    vec4 data = texelFetch(longest, tile, 0);
    if (int(data.w) != 0 || !(data.z > 0.0)) return;
    Number number = make_number(data.z < 10.0 ? floor(data.z * 10.0 + 0.5) / 10.0 : floor(data.z + 0.5));
    int dot_px = max(param.tile_size / 80, 1), width = number.length * kLetterWidth * dot_px;
    if (at >= number.length || number.length > kLetters || width + 2 > param.tile_size || kLetterHeight * dot_px + 2 > param.tile_size) return;
    ivec2 corner = tile * param.tile_size + (param.tile_size - ivec2(width - dot_px, 7 * dot_px)) / 2 + 1;
    put_letter(number_letter(number, at), corner + ivec2(at * kLetterWidth * dot_px, 0), dot_px, vec3(1.0));
}
