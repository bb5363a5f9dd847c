#version 450 core
#include <pass>
#include <texturing/texturing.glsl>

// All three kinds of texturing are color + after * (S(before * E) - before * E), with before * after = albedo: so written,
// nothing is added where the scattering gave its light back as it was.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    vec3 reflected = texelFetch(albedo, p, 0).rgb;
    vec3 light = light_before(texelFetch(unscattered, p, 0).rgb, reflected);
    precise vec3 change = texelFetch(scattered, p, 0).rgb - light;
    vec3 sum = texel.rgb + albedo_after(reflected) * change;
    // Adding 0 would turn -0 into 0.
    out_color = vec4(mix(sum, texel.rgb, equal(change, vec3(0.0))), texel.a);
}
