#version 450 core
#include <pass>
#include "layout.glsl"
#include "letter.glsl"
#include "names.glsl"

// Labels in turn: the name of what is shown, up to eight at the drawing, and those of the loud colours.
const int kTitle = 0, kFirst = 1, kFaultLabels = 9;

void append_unit(inout Text text) {
    int unit = param.unit;
#ifdef SHOWS_VECTORS
    if (unit == UNIT_AUTO) unit = UNIT_PX;
#elif SHOW == SHOW_DEPTH
    if (unit == UNIT_AUTO) unit = UNIT_M;
#elif SHOW == SHOW_LIGHT
    text.suffix = 0x20657600u;  // ev
    text.suffix_length = 3;
#endif
    if (unit == UNIT_AUTO || unit == UNIT_NONE || SHOW == SHOW_LIGHT) return;
    // px m s deg
    text.suffix = unit == UNIT_PX ? 0x20707800u : unit == UNIT_M ? 0x206d0000u : unit == UNIT_S ? 0x20730000u : 0x20646567u;
    text.suffix_length = unit == UNIT_PX ? 3 : unit == UNIT_DEG ? 4 : 2;
}

// The number of a label at the drawing, and in `middle` the middle of its upper edge, in units.
float label_number(int label, vec2 ends, out vec2 middle) {
    middle = vec2(0.5 * float(kBody.x), kBody.y - 11);
#if SHOW == SHOW_VELOCITY || SHOW == SHOW_TILES
    return ends.y;
#elif SHOW == SHOW_ARROWS
    return key_velocity(unit_px());
#elif SHOW == SHOW_LIGHT
    return param.exposure;
#else
    float t = kCells > 0 ? (float(label) + 0.5) / float(max(kCells, 1)) : 0.5 * float(label);
    middle = vec2(mix(float(kBarLeft), float(kBarRight), t), kBarBottom + 4);
#if SHOW == SHOW_DEPTH && DEPTH_SCALE == DEPTH_SCALE_LOG
    float between = sqrt(ends.x) * sqrt(ends.y);
#else
    float between = 0.5 * (ends.x + ends.y);
#endif
    return kCells > 0 ? float(label) : label == 0 ? ends.x : label == 1 ? between : ends.y;
#endif
}

Text label_text(int label, vec2 ends, out vec2 middle) {
    Text text = text_of(uvec3(0u), 0);
    float number = label_number(label, ends, middle);
    if (label >= kLabels) return text;
#if SHOW == SHOW_DEPTH || SHOW == SHOW_SIGNED || SHOW == SHOW_SCALAR
    // Long numbers leave no room for the one in the middle.
    int letters = 5;
    vec2 ignored;
    for (int i = 0; i < 3; ++i) letters += make_number(label_number(i, ends, ignored)).length;
    if (label == 1 && letters * kLetterWidth > kBody.x) return text;
#endif
#if SHOW == SHOW_NORMAL
    text.word.x = (label % 2 == 0 ? 0x2b000000u : 0x2d000000u) | (0x780000u + uint(label / 2) * 0x10000u);  // +x -x +y ...
    text.word_length = 2;
#else
    text.has_number = true;
    text.number = make_number(number);
    if (label == kLabels - 1 && kCells == 0) append_unit(text);
#endif
    return text;
}

// nan inf neg sky
Text fault_text(int fault, int faults) {
    int bit = fault == 0 ? kNan : fault == 1 ? kInfinite : fault == 2 ? kNegative : kNothingHit;
    uint word = fault == 0 ? 0x6e616e00u : fault == 1 ? 0x696e6600u : fault == 2 ? 0x6e656700u : 0x736b7900u;
    return text_of(uvec3(word, 0u, 0u), (faults & bit) != 0 ? 3 : 0);
}

void main() {
    no_letter();
    vec4 scale = texelFetch(range, ivec2(0), 0);
    int label = gl_InstanceID / kTextLength, at = gl_InstanceID % kTextLength, faults = int(scale.z), unit = unit_px();
    vec2 corner = vec2(6.0, 3.0), middle;
    Text text = shown_name();
    if (label >= kFaultLabels) {
        text = fault_text(label - kFaultLabels, faults);
        corner = vec2(15.0 + 29.0 * float(label - kFaultLabels), kBody.y);
    } else if (label > kTitle) {
        text = label_text(label - kFirst, scale.xy, middle);
        // Within the panel, and with the space of the last letter left out.
        float width = float(text_length(text) * kLetterWidth - 1);
        corner = vec2(clamp(floor(middle.x - 0.5 * width + 0.5), 2.0, max(2.0, float(kBody.x) - width - 2.0)), middle.y);
    }
    if (at >= text_length(text)) return;
    ivec2 place_px = panel_corner(faults) + ivec2(corner * float(unit)) + ivec2(at * kLetterWidth * unit, 0);
    put_letter(letter_of(text, at), place_px, unit, vec3(0.9));
}
