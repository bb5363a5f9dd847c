// Cube maps: six pictures, +x, -x, +y, -y, +z and -z, with the axes of OpenGL 4.6, table 8.19.
vec4 isf_sample(sampler2D right, sampler2D left, sampler2D top, sampler2D bottom, sampler2D front, sampler2D back, vec3 at) {
    vec3 size = abs(at);
    if (size.x >= size.y && size.x >= size.z) {
        vec2 on_face = 0.5 - 0.5 * vec2(sign(at.x) * at.z, at.y) / size.x;
        return at.x > 0.0 ? textureLod(right, on_face, 0.0) : textureLod(left, on_face, 0.0);
    }
    if (size.y >= size.z) {
        vec2 on_face = 0.5 + 0.5 * vec2(at.x, sign(at.y) * at.z) / size.y;
        return at.y > 0.0 ? textureLod(top, on_face, 0.0) : textureLod(bottom, on_face, 0.0);
    }
    vec2 on_face = 0.5 + 0.5 * vec2(sign(at.z) * at.x, -at.y) / size.z;
    return at.z > 0.0 ? textureLod(front, on_face, 0.0) : textureLod(back, on_face, 0.0);
}
vec4 isf_sample(sampler2D right, sampler2D left, sampler2D top, sampler2D bottom, sampler2D front, sampler2D back, vec3 at,
                float bias) {
    return isf_sample(right, left, top, bottom, front, back, at);
}
vec4 isf_sample_level(sampler2D right, sampler2D left, sampler2D top, sampler2D bottom, sampler2D front, sampler2D back, vec3 at,
                      float level) {
    return isf_sample(right, left, top, bottom, front, back, at);
}
