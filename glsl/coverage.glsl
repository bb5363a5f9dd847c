// Light of what covers a pixel in part.

// The least normal half. A smaller alpha, which filters leave, has lost its digits: light divided by it would be a firefly.
const float kLeastAlpha = 6.103515625e-5;

bool has_coverage(float alpha) { return alpha >= kLeastAlpha; }

// Without its premultiplication. Light without coverage (glows, flames) has none to divide by.
vec3 straight_light(vec4 texel) { return has_coverage(texel.a) ? texel.rgb / texel.a : texel.rgb; }
