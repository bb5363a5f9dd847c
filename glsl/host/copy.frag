#version 450 core
// Keeps an image for the next frame, bit for bit. The host defines COPY_UINT for integer formats.
#ifdef COPY_UINT
layout(binding = 0) uniform usampler2D source;
layout(location = 0) out uvec4 result;
#else
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 result;
#endif

void main() { result = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }
