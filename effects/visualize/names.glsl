#include <text.glsl>
#include "mode.glsl"

// The role, or the input, that the mode shows.
Text role_name() {
#if defined(SHOWS_VECTORS)
    return text_of(uvec3(0x76656c6fu, 0x63697479u, 0u), 8);  // velocity
#elif SHOW == SHOW_DEPTH
    return text_of(uvec3(0x64657074u, 0x68000000u, 0u), 5);  // depth
#elif SHOW == SHOW_NORMAL
    return text_of(uvec3(0x6e6f726du, 0x616c0000u, 0u), 6);  // normal
#elif SHOW == SHOW_OBJECT_ID
    return text_of(uvec3(0x6f626a65u, 0x63742069u, 0x64000000u), 9);  // object id
#else
    return text_of(uvec3(0x696d6167u, 0x65000000u, 0u), 5);  // image
#endif
}

// For people, where it is not there.
Text missing_name() {
#if defined(SHOWS_VECTORS)
    return text_of(uvec3(0x6e6f2076u, 0x656c6f63u, 0x69747900u), 11);  // no velocity
#elif SHOW == SHOW_DEPTH
    return text_of(uvec3(0x6e6f2064u, 0x65707468u, 0u), 8);  // no depth
#elif SHOW == SHOW_NORMAL
    return text_of(uvec3(0x6e6f206eu, 0x6f726d61u, 0x6c000000u), 9);  // no normal
#elif SHOW == SHOW_OBJECT_ID
    return text_of(uvec3(0x6e6f206fu, 0x626a6563u, 0x74206964u), 12);  // no object id
#else
    return text_of(uvec3(0x6e6f2069u, 0x6d616765u, 0u), 8);  // no image
#endif
}

Text shown_name() {
#if SHOW == SHOW_ARROWS
    return text_of(uvec3(0x6172726fu, 0x77730000u, 0u), 6);  // arrows
#elif SHOW == SHOW_TILES
    return text_of(uvec3(0x74696c65u, 0x73000000u, 0u), 5);  // tiles
#elif SHOW == SHOW_SIGNED
    return text_of(uvec3(0x7369676eu, 0x65640000u, 0u), 6);  // signed
#elif SHOW == SHOW_SCALAR
    return text_of(uvec3(0x7363616cu, 0x61720000u, 0u), 6);  // scalar
#elif SHOW == SHOW_LIGHT
    return text_of(uvec3(0x6c696768u, 0x74000000u, 0u), 5);  // light
#else
    return role_name();
#endif
}
