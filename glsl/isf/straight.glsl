#include <coverage.glsl>
// ISF's filters take straight alpha.
void main() { ISF_OUT = vec4(straight_light(ISF_IMAGE_0), ISF_IMAGE_0.a); }
