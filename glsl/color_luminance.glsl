// Relative luminance of light in the capture's primaries. The weights are converted, not the light: in Rec. 709 they are exact,
// and a channel that is not finite does not make the others so.
#include <luminance.glsl>

float color_luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722) * frame.rec709_from_color); }
