// Light at what one visibility sample of every pixel of a band meets, at the sample's own moment.
struct Corners {
    vec4 normals[3];  // in the object's space, of any length; w: u
    vec4 v_material;  // v of the three; the material, as bits
};
layout(std430, binding = 3) readonly buffer CornersOfTriangles { Corners corners[]; };  // of the triangles of all objects
layout(std430, binding = 6) buffer Sums { vec4 sums[]; };                               // of a pixel's light; w: the samples that met something

Point point_of(Hit hit, vec3 origin, vec3 direction, uint seed) {
    Corners of = corners[hit.surface];
    // Normals go by the inverse's transpose, whose columns these rows are.
    mat3 normal_matrix = mat3(object_from_world(ray_moment, hit.object));
    Triangle triangle = triangle_at(hit.triangle);
    vec3 weights = weights_of(hit);
    mat3x2 uvs = mat3x2(of.normals[0].w, of.v_material.x, of.normals[1].w, of.v_material.y, of.normals[2].w, of.v_material.z);
    Material material = material_at(floatBitsToUint(of.v_material.w));
    TexturePoint at = texture_point(hit.surface, weights, has_maps(material) ? weights_of_pixel(hit, direction, ray_moment) : mat2(0.0), uvs);
    Point point;
    point.position = origin + hit.t * direction;
    point.geometric_normal = normalize(normal_matrix * cross(triangle.to_second.xyz, triangle.to_third.xyz)) * (hit.from_behind ? -1.0 : 1.0);
    vec3 smooth_normal = normalize(normal_matrix * (mat3(of.normals[0].xyz, of.normals[1].xyz, of.normals[2].xyz) * weights));
    point.normal = smooth_normal;
    if (material.normal_map != kNoMap) {
        vec4 tangent = tangent_at(at);
        point.normal = mapped_normal(material, at, smooth_normal, inverse(transpose(normal_matrix)) * tangent.xyz, tangent.w);
    }
    if (dot(point.geometric_normal, smooth_normal) < 0.0) point.normal = -point.normal;
    point.seed = seed;
    point.finish = finish_at(material, at);
    return point;
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    vec3 origin = rays[pixel].origin.xyz, direction = rays[pixel].direction.xyz;
    ray_moment = floatBitsToUint(rays[pixel].origin.w);
    Hit hit = stopped(pixel, origin, direction, ray_moment);
    vec4 light = vec4(background.rgb, 0.0);
    if (hit.surface != kNoShading) {
        uint seed = pcg3d(uvec3(floatBitsToUint(rays[pixel].direction.w), sample_index, 0x2545f491u)).x;  // as scene::light_seed()
        light = vec4(light_at(point_of(hit, origin, direction, seed), origin, ambient, ray_moment * light_count, light_count), 1.0);
    }
    sums[pixel] = light + (sample_index == 0u ? vec4(0.0) : sums[pixel]);
    check_loops();
}
