// The share of light that comes through what stands on a ray: the twin of World::light_through().
uint ray_moment;

// Past one object, before `high`.
float light_through_object(Object object, uint number, vec3 origin, vec3 direction, float high) {
    LocalRay ray = local_ray(origin, direction, ray_moment, number);
    vec3 inverse = 1.0 / ray.direction;
    uint at = 0u;
    float share = 1.0;
    for (uint step = 0u; step < object.node_count && at < object.node_count && share > 0.0; ++step) {
        Node node = mesh_node(object.first_node + at);
        if (!meets(ray.origin, inverse, node.low_skip.xyz, node.high_items.xyz, high)) {
            at = floatBitsToUint(node.low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(node.high_items.w), begin = object.first_triangle + (items >> 3);
        for (uint i = begin; i < begin + (items & 7u); ++i) {
            Hit hit = no_hit(high);
            meet_triangle(i, object, number, ray, 0.0, hit);
            if (hit.surface == kNoShading) continue;
            share *= 1.0 - (kHasAlpha && object.is_mixed ? mixed_opacity(hit.surface, weights_of(hit), mat2(0.0)) : object.opacity);
        }
        ++at;
    }
    return share;
}

float light_through(vec3 origin, vec3 direction, float high) {
    vec3 inverse = 1.0 / direction;
    float share = 1.0;
    uint at = 0u;
    for (uint step = 0u; step < top_count && at < top_count && share > 0.0; ++step) {
        Node node = top_node(at);
        if (!meets(origin, inverse, node.low_skip.xyz, node.high_items.xyz, high)) {
            at = floatBitsToUint(node.low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(node.high_items.w), number = items >> 3;
        if ((items & 7u) != 0u) {
            Object object = object_at(number);
            if (object.casts_shadow) share *= light_through_object(object, number, origin, direction, high);
        }
        ++at;
    }
    return share;
}
