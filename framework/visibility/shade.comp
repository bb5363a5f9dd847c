// Light at shading samples, at the frame's own time: the twin of scene::ShadingGrids::shade() in single precision.
struct Surface {
    vec4 corner;          // world, m; w: material, as bits
    vec4 to_second;       // w: v of the first corner
    vec4 to_third;        // w: v of the second
    vec4 normals[3];      // of the corners, world, of any length; w: their u
    vec4 px_from_cells;   // columns
    vec4 grid;            // xy: low corner, in cells; z: columns, as bits; w: v of the third
};
struct Blocker {
    vec4 corner;  // world, m; w: opacity
    vec4 to_second;
    vec4 to_third;
};
struct Material {
    vec4 albedo;    // w: roughness
    vec4 albedo_2;  // w: specular
    vec4 emission;
    vec4 checker_cells;  // xy
};
struct Light {
    vec4 position;   // m; w: kind
    vec4 direction;  // w: points of a grid a side that shadows are sought from; 0: no shadows
    vec4 half_u;     // m; w: kind of pattern
    vec4 half_v;     // w: the pattern's offset, m
    vec4 intensity;  // w: the pattern's period, m
    vec4 axis;       // of the pattern; w: its amplitude
};

layout(std430, binding = 0) readonly buffer Nodes { Node nodes[]; };
layout(std430, binding = 1) readonly buffer Blockers { Blocker blockers[]; };  // as the leaves order them
layout(std430, binding = 2) readonly buffer Starts { uint starts[]; };         // the first cell of each surface
layout(std430, binding = 3) readonly buffer Surfaces { Surface surfaces[]; };
layout(std430, binding = 4) readonly buffer Materials { Material materials[]; };
layout(std430, binding = 5) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 6) readonly buffer Ids { uint ids[]; };
layout(std430, binding = 7) writeonly buffer Shaded { vec4 shaded[]; };
layout(std140, binding = 0) uniform Settings {
    mat4 world_from_camera;
    vec4 ambient;
    vec2 size_px;
    float px_per_tangent;
    uint id_count;
    uint node_count;
    uint surface_count;
    uint light_count;
};

const float kPi = 3.14159265358979;
const float kPoint = 0.0, kDirectional = 1.0;  // kinds; 2: area
const float kEdge = 1.0, kCosine = 2.0;        // kinds of patterns; 0: none
// Of a position, over the size of its coordinates: where a ray leaves a surface that must not hide itself.
const float kPrecision = 1e-5;

// Places of a cell a side whose mean albedo counts, as ShadingGrids::kAlbedoPoints.
const int kAlbedoPoints = 4;

struct Point {
    vec3 position;
    vec3 normal;            // for shading
    vec3 geometric_normal;  // both of unit length, on the side that is seen
    vec3 albedo;
    uint material;
};

// The last surface whose cells begin at or before `cell`.
uint surface_of(uint cell) {
    uint low = 0u, high = surface_count;
    for (int step = 0; step < 32 && low + 1u < high; ++step) {
        uint middle = (low + high) / 2u;
        if (starts[middle] <= cell) low = middle;
        else high = middle;
    }
    return low;
}

// Weights of the second and third corner where the pinhole camera sees a place of the grid.
vec2 weights_at(Surface at, vec2 place) {
    vec2 tangent = (mat2(at.px_from_cells) * place - 0.5 * size_px) / px_per_tangent;
    vec3 direction = mat3(world_from_camera) * vec3(tangent.x, -tangent.y, -1.0);
    return on_plane(at.corner.xyz, at.to_second.xyz, at.to_third.xyz, world_from_camera[3].xyz, direction).yz;
}

vec3 albedo_at(Surface at, Material material, vec2 on) {
    vec3 weights = vec3(1.0 - on.x - on.y, on);
    vec2 uv = vec2(dot(vec3(at.normals[0].w, at.normals[1].w, at.normals[2].w), weights), dot(vec3(at.to_second.w, at.to_third.w, at.grid.w), weights));
    ivec2 square = ivec2(floor(uv * material.checker_cells.xy));
    return ((square.x + square.y) & 1) != 0 ? material.albedo_2.rgb : material.albedo.rgb;
}

// Over the cell whose corner is `corner`; `middle` stands for a cell of which no place lies on the triangle.
vec3 mean_albedo(Surface at, Material material, vec2 corner, vec2 middle) {
    if (material.checker_cells.xy == vec2(0.0)) return material.albedo.rgb;
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < kAlbedoPoints * kAlbedoPoints; ++i) {
        vec2 on = weights_at(at, corner + (vec2(float(i % kAlbedoPoints), float(i / kAlbedoPoints)) + 0.5) / float(kAlbedoPoints));
        if (!is_inside(on)) continue;
        sum += albedo_at(at, material, on);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : albedo_at(at, material, middle);
}

// The cell's centre as the pinhole camera sees it, drawn into the triangle.
Point point_of(uint id) {
    uint index = surface_of(id / 2u);
    Surface at = surfaces[index];
    uint cell = id / 2u - starts[index], columns = floatBitsToUint(at.grid.z);
    vec2 corner = at.grid.xy + vec2(float(cell % columns), float(cell / columns));
    vec2 on = weights_at(at, corner + 0.5);
    if (any(isnan(on)) || any(isinf(on))) on = vec2(1.0 / 3.0);
    vec3 weights = max(vec3(1.0 - on.x - on.y, on.x, on.y), vec3(0.0));
    weights /= weights.x + weights.y + weights.z;
    Point point;
    point.position = at.corner.xyz + weights.y * at.to_second.xyz + weights.z * at.to_third.xyz;
    point.geometric_normal = normalize(cross(at.to_second.xyz, at.to_third.xyz)) * ((id & 1u) != 0u ? -1.0 : 1.0);
    point.normal = normalize(mat3(at.normals[0].xyz, at.normals[1].xyz, at.normals[2].xyz) * weights);
    if (dot(point.geometric_normal, point.normal) < 0.0) point.normal = -point.normal;
    point.material = floatBitsToUint(at.corner.w);
    point.albedo = mean_albedo(at, materials[point.material], corner, weights.yz);
    return point;
}

// The share of light that crosses what stands on a ray before `high`.
float light_through(vec3 origin, vec3 direction, float high) {
    vec3 inverse = 1.0 / direction;
    float share = 1.0;
    uint at = 0u;
    // A ray comes to each node once at most, since it only goes on to later ones.
    for (uint step = 0u; step < node_count && at < node_count && share > 0.0; ++step) {
        if (!meets(origin, inverse, nodes[at].low_skip.xyz, nodes[at].high_items.xyz, high)) {
            at = floatBitsToUint(nodes[at].low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(nodes[at].high_items.w), first = items >> 3;
        for (uint i = first; i < first + (items & 7u); ++i) {
            vec3 met = on_plane(blockers[i].corner.xyz, blockers[i].to_second.xyz, blockers[i].to_third.xyz, origin, direction);
            if (is_inside(met.yz) && met.x > 0.0 && met.x < high) share *= 1.0 - blockers[i].corner.w;
        }
        ++at;
    }
    return share;
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

// Of an area light: the share of a grid of its points that shines through; as World::visible_part().
float visible_part(Light light, Point point) {
    int side = int(light.direction.w), count = 0;
    vec3 from = off_surface(point);
    float seen = 0.0;
    for (int i = 0; i < side * side; ++i) {
        vec2 uv = vec2(float(i % side) + 0.5, float(i / side) + 0.5) / float(side) * 2.0 - 1.0;
        vec3 to = light.position.xyz + uv.x * light.half_u.xyz + uv.y * light.half_v.xyz;
        if (dot(to - point.position, point.geometric_normal) <= 0.0) continue;
        ++count;
        seen += light_through(from, to - from, 1.0);
    }
    if (count > 0) return seen / float(count);
    vec3 highest = corner_of(light, 0);
    for (int i = 1; i < 4; ++i) {
        vec3 corner = corner_of(light, i);
        if (dot(corner - highest, point.geometric_normal) > 0.0) highest = corner;
    }
    return light_through(from, highest - from, 1.0);
}

float pattern_at(Light light, vec3 position) {
    float along_m = dot(position, light.axis.xyz) - light.half_v.w;
    if (light.half_u.w == kEdge) return along_m >= 0.0 ? 1.0 : 0.0;
    return light.half_u.w == kCosine ? 1.0 + light.axis.w * cos(2.0 * kPi * along_m / light.intensity.w) : 1.0;
}

// GGX with the height-correlated masking of Heitz 2014 and Schlick's Fresnel; without the light's cosine.
float highlight(Material material, vec3 normal, vec3 to_light, vec3 to_eye) {
    float specular = material.albedo_2.w, n_l = dot(normal, to_light), n_v = dot(normal, to_eye);
    if (specular <= 0.0 || n_l <= 0.0 || n_v <= 0.0) return 0.0;
    vec3 half_way = normalize(to_light + to_eye);
    float alpha = material.albedo.w * material.albedo.w, a2 = alpha * alpha;
    float n_h = clamp(dot(normal, half_way), 0.0, 1.0);
    // As n_h * n_h * (a2 - 1) + 1, whose digits cancel where the lobe is narrow.
    vec3 off_half = cross(normal, half_way);
    float base = n_h * n_h * a2 + dot(off_half, off_half);
    float masking = 0.5 / (n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2));
    float grazing = 1.0 - clamp(dot(half_way, to_light), 0.0, 1.0), squared = grazing * grazing;
    return a2 / (kPi * base * base) * masking * (specular + (1.0 - specular) * squared * squared * grazing);
}

// Adds one light to the irradiance over pi and to what is reflected.
void add_light(Light light, Material material, Point point, vec3 to_eye, inout vec3 irradiance, inout vec3 reflected) {
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
        vec3 from = off_surface(point);
        float seen = is_area ? visible_part(light, point)
                             : light_through(from, is_far ? toward : light.position.xyz - from, is_far ? 1e30 : 1.0);
        received *= seen;
        highlighted *= seen;
    }
    irradiance += light.intensity.rgb * (received / kPi);
    if (highlighted > 0.0) reflected += light.intensity.rgb * (highlighted * highlight(material, point.normal, toward, to_eye));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= id_count) return;
    Point point = point_of(ids[index]);
    Material material = materials[point.material];
    vec3 to_eye = normalize(world_from_camera[3].xyz - point.position);
    vec3 irradiance = ambient.rgb, reflected = vec3(0.0);
    for (uint i = 0u; i < light_count; ++i) add_light(lights[i], material, point, to_eye, irradiance, reflected);
    shaded[index] = vec4(point.albedo * irradiance + reflected + material.emission.rgb, 1.0);
    check_loops();
}
