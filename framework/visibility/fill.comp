// Sets all words of a buffer.
layout(std430, binding = 0) writeonly buffer Words { uint words[]; };
layout(std140, binding = 0) uniform Settings {
    uint word_count;
    uint value;
};

void main() {
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < word_count; i += stride) words[i] = value;
}
