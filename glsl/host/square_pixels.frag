#version 450 core
// From pixels that are not square to the square ones that stand for each, and back. The host defines
// TO_SQUARE or TO_STORED; INTEGERS for integer formats, MOTION for px of both axes, MEAN for what may be filtered.
layout(std140, binding = 0) uniform Stretch {
    int axis;   // 0: x, 1: y
    int to;     // so many square pixels
    int from;   // stand for so many stored ones
    int phase;  // stored pixels, less than `from`, from one where such a group begins to the first
} stretch;

#ifdef INTEGERS
layout(binding = 0) uniform usampler2D source;
layout(location = 0) out uvec4 result;
#else
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 result;
#endif

// The first square pixel of a stored one: its left or upper edge, rounded.
int edge(int stored) { return (2 * stored * stretch.to + stretch.from) / (2 * stretch.from); }

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int place = pixel[stretch.axis];
    int origin = edge(stretch.phase);
#ifdef TO_SQUARE
    // The last one whose edge is not beyond.
    pixel[stretch.axis] =
        ((2 * (place + origin) + 1) * stretch.from - 1) / (2 * stretch.to) - stretch.phase;
    result = texelFetch(source, pixel, 0);
#else
    int begin = edge(place + stretch.phase) - origin;
    int end = edge(place + 1 + stretch.phase) - origin;
#ifdef MEAN
    pixel[stretch.axis] = begin;
    vec4 first = texelFetch(source, pixel, 0), sum = first;
    bool are_equal = true;
    for (int i = begin + 1; i < end; ++i) {
        pixel[stretch.axis] = i;
        vec4 texel = texelFetch(source, pixel, 0);
        are_equal = are_equal && texel == first;
        sum += texel;
    }
    result = are_equal ? first : sum / float(end - begin);
#else
    pixel[stretch.axis] = (begin + end) / 2;
    result = texelFetch(source, pixel, 0);
#endif
#endif
#ifdef MOTION
    float pixels = float(stretch.to) / float(stretch.from);
#ifdef TO_SQUARE
    result[stretch.axis] *= pixels;
#else
    result[stretch.axis] /= pixels;
#endif
#endif
}
