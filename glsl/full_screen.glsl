// The corner gl_VertexID, in NDC, of one triangle that covers the target. As the strip of four vertices that an instance is, its second
// triangle is empty.
vec4 full_screen_corner() { return vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID > 1 ? 3.0 : -1.0, 0.0, 1.0); }
