// The mean light of the samples of each pixel of a band, fetched by address. `shaded` is a slice of the picture's shadings; samples whose address
// lies in another slice add nothing.
layout(std430, binding = 0) readonly buffer Addresses { uint addresses[]; };
layout(std430, binding = 1) readonly buffer Shaded { vec4 shaded[]; };
layout(std430, binding = 2) writeonly buffer Means { vec4 means[]; };
layout(std140, binding = 0) uniform Settings {
    vec4 background;  // 0 in all slices but one
    uint pixel_count;
    uint sample_count;
    uint first;  // of the slice
    uint count;
};

const uint kNoShading = 0xffffffffu;

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < sample_count; ++i) {
        uint address = addresses[pixel * sample_count + i], place = address - first;
        if (address == kNoShading) sum += background.rgb;
        else if (place < count) sum += shaded[place].rgb;
    }
    means[pixel] = vec4(sum / float(sample_count), 1.0);
}
