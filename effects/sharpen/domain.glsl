// Where sharpening happens: light compressed into (-1, 1), so that a lamp does not throw halos a hundred times as bright as
// what is beside it.

vec3 compressed(vec3 light) {
    vec3 result = light / (1.0 + abs(light));
    result = mix(result, sign(light), isinf(light));
    return mix(result, vec3(0.0), isnan(light));
}

// Light whose compressed value is that of `light` plus `change`, exact where the change is 0; not below 0, and no brighter
// than (1 + amount) times, which is what sharpening the light itself could give.
vec3 changed(vec3 light, vec3 change, float amount) {
    vec3 size = abs(light);
    vec3 outward = mix(change, -change, lessThan(light, vec3(0.0))) * (1.0 + size);
    vec3 result = mix(size * (1.0 + amount), (size + outward) / (1.0 - outward), lessThan(outward, vec3(0.999)));
    result = clamp(result, vec3(0.0), size * (1.0 + amount));
    return mix(result, -result, lessThan(light, vec3(0.0)));
}

float gaussian(int offset_px, float deviation_px) {
    float t = float(offset_px) / deviation_px;
    return exp(-0.5 * t * t);
}

// Three deviations hold 99.7 % of a Gaussian.
int reach_px(float deviation_px) { return int(ceil(3.0 * deviation_px)); }
