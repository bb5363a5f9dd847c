#include <isf/fragment.glsl>
// The last target as the picture, whatever its size.
void main() { ISF_OUT = ISF_RESULT(textureLod(ISF_IMAGE_0, gl_FragCoord.xy / vec2(frame.size), 0.0)); }
