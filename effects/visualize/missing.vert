#version 450 core
#include <pass>
#include "letter.glsl"
#include "mode.glsl"
#include "names.glsl"

// "no velocity" in the middle of the picture, where the capture or the look has nothing to show.
void main() {
    no_letter();
#ifndef HAS_DATA
    Text text = missing_name();
    int length_ = text_length(text);
    if (gl_InstanceID >= length_) return;
    int dot_px = max(1, frame.display_size.x / (2 * length_ * kLetterWidth));
    ivec2 size = ivec2(length_ * kLetterWidth, kLetterHeight) * dot_px;
    ivec2 corner = (frame.display_size - size) / 2 - frame.origin;
    put_letter(letter_of(text, gl_InstanceID), corner + ivec2(gl_InstanceID * kLetterWidth * dot_px, 0), dot_px, vec3(1.0, 0.35, 0.0));
#endif
}
