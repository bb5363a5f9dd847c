#version 450 core
// One triangle that covers the target; gl_FragCoord (0.5, 0.5) is texel (0, 0), the top left of the image.
out gl_PerVertex { vec4 gl_Position; };
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
