#include <isf/images.glsl>

vec2 isf_norm;
void isf_vertShaderInit() {
    isf_norm = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(2.0 * isf_norm - 1.0, 0.0, 1.0);
}
