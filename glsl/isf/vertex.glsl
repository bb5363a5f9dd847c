#include <isf/images.glsl>

vec2 isf_corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
#ifdef ISF_MOVED
out vec2 isf_norm;
#else
vec2 isf_norm = isf_corner;
#endif
vec4 isf_vertex() { return vec4(2.0 * isf_corner - 1.0, 0.0, 1.0); }
void isf_vertShaderInit() {
    gl_Position = isf_vertex();
    isf_norm = isf_corner;
}
