// Light of surfaces from the nearest to the farthest, each by its share of a pixel.
const float kOneSurface = 1.03;  // ratio of depths, up to which two finds at one place are one surface

struct Light {
    vec4 sum;    // premultiplied
    float left;  // of what lies behind
};

void put_behind(inout Light light, vec4 color, float share) {
    light.sum += light.left * color;
    light.left *= 1.0 - share;
}
