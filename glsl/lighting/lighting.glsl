// What the capture's lights, or the look's where the capture has none, send to a point without anything in their way.

#include <camera_rays.glsl>

struct Arriving {
    vec3 toward;  // world, unit length, from the point to the light; 0 where the point lies in the light
    vec3 light;   // as the role irradiance has it (over pi), on a surface that faces the light
};

// The point of the world that the pixel shows: of the image `position` where there is one, else by the camera's matrices.
// Without either it has no meaning, but lights from far away do not ask for it.
vec3 world_position_m(vec2 pixel, float depth_m) {
#ifdef HAS_POSITION
    return texelFetch(position, ivec2(pixel), 0).xyz;
#endif
    vec4 view = view_point(camera.clip_from_view, ndc_of_pixel(pixel), 1.0);
    return (camera.world_from_view * vec4(view.xyz / view.w * depth_m, 1.0)).xyz;
}

int light_count() { return max(lights.count, 1); }

// Lights that are near send nothing where nobody knows where a pixel is.
// An area light counts as a point at its centre that shines by the cosine of its own direction (Lambert): on the axis
// of a square too much by a third at a distance of one side, by 4 % at three.
Arriving arriving(int i, vec3 position_m) {
    const float pi = 3.14159265358979;
    if (lights.count == 0) {
        float span = length(param.light_direction);
        return span > 0.0 ? Arriving(-param.light_direction / span, param.light_intensity / pi)
                          : Arriving(vec3(0.0), vec3(0.0));
    }
    Light light = lights.light[i];
    if (light.kind == LIGHT_DIRECTIONAL) return Arriving(-light.direction, light.intensity / pi);
#ifndef HAS_POSITION
    if (!camera.has_matrices) return Arriving(vec3(0.0), vec3(0.0));
#endif
    vec3 way = light.position_m - position_m;
    float square = dot(way, way);
    if (square == 0.0) return Arriving(vec3(0.0), vec3(0.0));
    vec3 toward = way * inversesqrt(square);
    float size = light.kind == LIGHT_AREA
        ? light.size_m.x * light.size_m.y * max(dot(light.direction, -toward), 0.0)
        : 1.0;
    return Arriving(toward, light.intensity * (size / (pi * square)));
}
