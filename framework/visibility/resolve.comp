// The mean light of the samples of each pixel of a band. `shaded` is that of a slice of the picture's shading samples; samples that met others
// add nothing.
layout(std430, binding = 0) readonly buffer Ids { uint ids[]; };
layout(std430, binding = 1) readonly buffer Set { uint set[]; };        // one bit for each id of the picture
layout(std430, binding = 2) readonly buffer Before { uint before[]; };  // bits in earlier pairs of words
layout(std430, binding = 3) readonly buffer Shaded { vec4 shaded[]; };
layout(std430, binding = 4) writeonly buffer Means { vec4 means[]; };
layout(std140, binding = 0) uniform Settings {
    vec4 background;  // 0 in all slices but one
    uint pixel_count;
    uint sample_count;
    uint first;  // of the slice
    uint count;
};

const uint kNoShading = 0xffffffffu;

// How many ids of the set are smaller.
uint number_of(uint id) {
    uint word = id >> 5;
    uint smaller = bitCount(set[word] & ((1u << (id & 31u)) - 1u));
    if ((word & 1u) != 0u) smaller += bitCount(set[word - 1u]);
    return before[id >> 6] + smaller;
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < sample_count; ++i) {
        uint id = ids[pixel * sample_count + i];
        uint place = id == kNoShading ? count : number_of(id) - first;
        if (id == kNoShading) sum += background.rgb;
        else if (place < count) sum += shaded[place].rgb;
    }
    means[pixel] = vec4(sum / float(sample_count), 1.0);
}
