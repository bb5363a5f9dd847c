// Places of highlight_list: a pixel, and whether the highlight is hidden there by what is in front of it.
const uint kHidden = 0x8000u;

uint place_of(ivec2 p) { return uint(p.x) | uint(p.y) << 16; }
ivec2 highlight_place(uint place) { return ivec2(place & 0x7fffu, place >> 16); }
bool is_hidden(uint place) { return (place & kHidden) != 0u; }
