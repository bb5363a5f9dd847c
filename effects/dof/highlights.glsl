// Places of highlight_list: a pixel, and whether the highlight is hidden there by what is in front of it.
const uint kHidden = 0x8000u;

uint place_of(ivec2 p) { return uint(p.x) | uint(p.y) << 16; }
ivec2 highlight_place(uint place) { return ivec2(place & 0x7fffu, place >> 16); }
bool is_hidden(uint place) { return (place & kHidden) != 0u; }

struct Highlight {
    vec3 rgb;
    vec2 middle_px;  // from the pixel's centre, at most 0.5
};

uvec4 pack_highlight(Highlight h) { return uvec4(floatBitsToUint(h.rgb), packSnorm2x16(2.0 * h.middle_px)); }

Highlight unpack_highlight(uvec4 texel) { return Highlight(uintBitsToFloat(texel.xyz), 0.5 * unpackSnorm2x16(texel.w)); }
