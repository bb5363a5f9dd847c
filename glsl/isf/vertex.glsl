#include <isf/images.glsl>

vec2 isf_norm = vec2(gl_VertexID & 1, gl_VertexID >> 1);
vec4 isf_vertex() { return vec4(2.0 * isf_norm - 1.0, 0.0, 1.0); }
void isf_vertShaderInit() { gl_Position = isf_vertex(); }
