#version 450 core
layout(binding = 0) uniform sampler2D light;
layout(binding = 1) uniform usampler2DArray ids;
#define FROM light
#define AT(p) texelFetch(FROM, p, 0)
vec4 at(sampler2D image, ivec2 p) { return texelFetch(image, min(p, textureSize(image, 0) - 1), 0); }
void main() { out_a = at(light, ivec2(texelFetch(ids, ivec3(0), 0).r)) + AT(ivec2(1)); }
