// Light at a point, in the words of world_lighting.cpp.
struct Light {
    vec4 position;   // m; w: kind
    vec4 direction;  // w: points of a grid a side that shadows are sought from; 0: no shadows
    vec4 half_u;     // m; w: kind of pattern
    vec4 half_v;     // w: the pattern's offset, m
    vec4 intensity;  // w: the pattern's period, m
    vec4 axis;       // of the pattern; w: its amplitude
};

const float kPi = 3.14159265358979;
const float kPoint = 0.0, kDirectional = 1.0;  // kinds; 2: area
const float kEdge = 1.0, kCosine = 2.0;        // kinds of patterns; 0: none
// Precision of a position, over the size of its coordinates. A ray starts so far off its surface.
const float kPrecision = 1e-5;

struct Point {
    vec3 position;
    vec3 normal;            // for shading
    vec3 geometric_normal;  // both of unit length, on the side that is seen
    Finish finish;
    uint seed;              // of its random rays
};

Light light_number(uint index) {
    uint at = lights_at + 6u * index;
    return Light(moving[at], moving[at + 1u], moving[at + 2u], moving[at + 3u], moving[at + 4u], moving[at + 5u]);
}

vec3 off_surface(Point point) {
    vec3 size = abs(point.position);
    return point.position + point.geometric_normal * (kPrecision * max(max(size.x, size.y), max(size.z, 1e-3)));
}

vec3 corner_of(Light light, int corner) {
    vec2 side = vec2(corner == 1 || corner == 2 ? 1.0 : -1.0, corner >= 2 ? 1.0 : -1.0);
    return light.position.xyz + side.x * light.half_u.xyz + side.y * light.half_v.xyz;
}

// What an edge of a polygon adds to Lambert's formula.
float edge_cosine(vec3 a, vec3 b, vec3 normal) {
    vec3 across = cross(a, b);
    float size = length(across);
    return size > 0.0 ? atan(size, dot(a, b)) * dot(across, normal) / size : 0.0;
}

// Lambert's formula (Photometria, 1760; Baum et al. 1989) over a quadrilateral cut at the horizon. The edge along the horizon joins the two
// points where the others are cut.
float polygon_cosine(Light light, Point point) {
    float sum = 0.0;
    vec3 enters = vec3(0.0), leaves = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec3 a = corner_of(light, i) - point.position, b = corner_of(light, (i + 1) & 3) - point.position;
        float height_a = dot(a, point.normal), height_b = dot(b, point.normal);
        if (height_a < 0.0 && height_b < 0.0) continue;
        vec3 cut = mix(a, b, height_a / (height_a - height_b));
        if (height_a < 0.0) enters = a = cut;
        if (height_b < 0.0) leaves = b = cut;
        sum += edge_cosine(a, b, point.normal);
    }
    return abs(sum + edge_cosine(leaves, enters, point.normal)) / 2.0;
}

// The corner that stands highest above the surface.
vec3 highest_corner(Light light, Point point) {
    vec3 highest = corner_of(light, 0);
    for (int i = 1; i < 4; ++i) {
        vec3 corner = corner_of(light, i);
        if (dot(corner - highest, point.geometric_normal) > 0.0) highest = corner;
    }
    return highest;
}

// The share of a light that shines through, of an area light by a grid of its points; as World::visible_part(). One place alone calls
// light_through(), since compilers write it out at each.
float visible_part(Light light, Point point, vec3 toward) {
    bool is_far = light.position.w == kDirectional, is_area = light.position.w > kDirectional;
    int side = is_area ? int(light.direction.w) : 1, count = 0;
    vec3 from = off_surface(point);
    float seen = 0.0;
    for (int i = 0; i < side * side + (count > 0 ? 0 : 1); ++i) {
        vec2 uv = vec2(float(i % side) + 0.5, float(i / side) + 0.5) / float(side) * 2.0 - 1.0;
        vec3 to = light.position.xyz + uv.x * light.half_u.xyz + uv.y * light.half_v.xyz;
        if (!is_area) to = light.position.xyz;
        else if (i == side * side) to = highest_corner(light, point);
        else if (dot(to - point.position, point.geometric_normal) <= 0.0) continue;
        ++count;
        seen += light_through(from, is_far ? toward : to - from, is_far ? 1e30 : 1.0);
    }
    return seen / float(count);
}

float pattern_at(Light light, vec3 position) {
    float along_m = dot(position, light.axis.xyz) - light.half_v.w;
    if (light.half_u.w == kEdge) return along_m >= 0.0 ? 1.0 : 0.0;
    return light.half_u.w == kCosine ? 1.0 + light.axis.w * cos(2.0 * kPi * along_m / light.intensity.w) : 1.0;
}

// GGX with the height-correlated masking of Heitz 2014 and Schlick's Fresnel; without the light's cosine.
vec3 highlight(Finish finish, vec3 normal, vec3 to_light, vec3 to_eye) {
    float n_l = dot(normal, to_light), n_v = dot(normal, to_eye);
    if (finish.reflectance == vec3(0.0) || n_l <= 0.0 || n_v <= 0.0) return vec3(0.0);
    vec3 half_way = normalize(to_light + to_eye);
    float alpha = finish.roughness * finish.roughness, a2 = alpha * alpha;
    float n_h = clamp(dot(normal, half_way), 0.0, 1.0);
    // As n_h * n_h * (a2 - 1) + 1, whose digits cancel where the lobe is narrow.
    vec3 off_half = cross(normal, half_way);
    float base = n_h * n_h * a2 + dot(off_half, off_half);
    float masking = 0.5 / (n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2));
    float grazing = 1.0 - clamp(dot(half_way, to_light), 0.0, 1.0), squared = grazing * grazing;
    return a2 / (kPi * base * base) * masking * (finish.reflectance + (1.0 - finish.reflectance) * squared * squared * grazing);
}

// Adds one light to the irradiance over pi and to what is reflected.
void add_light(Light light, Point point, vec3 to_eye, inout vec3 irradiance, inout vec3 reflected) {
    bool is_far = light.position.w == kDirectional, is_area = light.position.w > kDirectional;
    vec3 way = is_far ? -light.direction.xyz : light.position.xyz - point.position;
    float distance2 = dot(way, way);
    if (distance2 == 0.0) return;
    vec3 toward = way / sqrt(distance2);
    float cosine = max(dot(point.normal, toward), 0.0);
    float front = is_area ? -dot(light.direction.xyz, toward) : 1.0;
    if (front <= 0.0 || (!is_area && dot(point.geometric_normal, toward) <= 0.0)) return;
    float received = is_far ? cosine * pattern_at(light, point.position) : cosine / distance2;
    float highlighted = received;
    if (is_area) {
        highlighted *= front * 4.0 * length(light.half_u.xyz) * length(light.half_v.xyz);
        received = polygon_cosine(light, point);
    }
    if (received <= 0.0) return;
    if (light.direction.w > 0.0) {
        float seen = visible_part(light, point, toward);
        received *= seen;
        highlighted *= seen;
    }
    irradiance += light.intensity.rgb * (received / kPi);
    if (highlighted > 0.0) reflected += light.intensity.rgb * (highlighted * highlight(point.finish, point.normal, toward, to_eye));
}

// Point `index` of `count` as scene::shifted_hammersley() has it.
vec2 shifted_hammersley(uint index, uint count, uint seed) {
    const float kToUnit = 1.0 / 4294967296.0;
    vec2 shift = vec2(float(pcg3d(uvec3(0u, seed, 0x5bd1e995u)).x), float(pcg3d(uvec3(1u, seed, 0x5bd1e995u)).x)) * kToUnit;
    return fract(vec2(float(index) / float(count), float(bitfieldReverse(index)) * kToUnit) + shift);
}

// The unit square onto the unit disk (Shirley and Chiu 1997).
vec2 on_disk(vec2 u) {
    vec2 p = 2.0 * u - 1.0;
    if (p == vec2(0.0)) return p;
    bool wide = abs(p.x) > abs(p.y);
    float angle_rad = wide ? kPi / 4.0 * p.y / p.x : kPi / 2.0 - kPi / 4.0 * p.x / p.y;
    return (wide ? p.x : p.y) * vec2(cos(angle_rad), sin(angle_rad));
}

// A rotation of +z to `axis` (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
mat3 frame_about(vec3 axis) {
    float side = axis.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + axis.z), b = axis.x * axis.y * a;
    return mat3(vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x), vec3(b, side + axis.y * axis.y * a, -axis.y), axis);
}

// The share of the ambient light that shines through, by rays as likely as their cosine.
float visible_ambient(Point point, uint rays) {
    mat3 frame = frame_about(point.normal);
    vec3 from = off_surface(point);
    float seen = 0.0;
    for (uint i = 0u; i < rays; ++i) {
        vec2 at = on_disk(shifted_hammersley(i, rays, point.seed));
        vec3 way = frame * vec3(at, sqrt(max(1.0 - dot(at, at), 0.0)));
        seen += dot(way, point.geometric_normal) > 0.0 ? light_through(from, way, 1e30) : 1.0;
    }
    return seen / float(rays);
}

// Light from `count` lights, beginning with `first`, and from the ambient light, whose rays are ambient.w.
vec3 light_at(Point point, vec3 eye, vec4 ambient, uint first, uint count) {
    vec3 way = eye - point.position, to_eye = way == vec3(0.0) ? point.normal : normalize(way);  // as direction_to() of the CPU
    vec3 irradiance = point.finish.ambient * ambient.rgb, reflected = vec3(0.0);
    if (ambient.w > 0.0 && ambient.rgb != vec3(0.0)) irradiance *= visible_ambient(point, uint(ambient.w));
    for (uint i = first; i < first + count; ++i) add_light(light_number(i), point, to_eye, irradiance, reflected);
    return point.finish.albedo * irradiance + reflected + point.finish.emission;
}
