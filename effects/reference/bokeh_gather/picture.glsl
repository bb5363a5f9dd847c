// The picture of the aperture.

// How much light passes at a point of the aperture, in its radii.
float passes_at(vec2 point) {
    float angle = radians(param.rotation), c = cos(angle), s = sin(angle);
    vec2 turned = vec2(c * point.x + s * point.y, c * point.y - s * point.x);
    vec2 size = aperture_size.xy;
    vec2 texel = 0.5 * (size + turned * min(size.x, size.y));
    return max(texelFetch(aperture, clamp(ivec2(texel), ivec2(0), ivec2(size) - 1), 0).r, 0.0);
}
