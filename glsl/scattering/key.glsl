// What a pixel's object is called. Needs the texture object_id where there is one.

uint id_at(ivec2 p) {
#ifdef HAS_OBJECT_ID
    return texelFetch(object_id, p, 0).r;
#else
    return 0u;
#endif
}

// The object's id + 1, never 0; without ids all is one. Light goes between pixels of one key only.
uint key_at(ivec2 p) { return min(id_at(p), 0xFFFFFFFEu) + 1u; }

bool is_surface(float depth_m) { return depth_m > 0.0 && depth_m < 1e30; }

bool is_listed(ivec2 p) {
    bool listed = object_ids(id_at(p));
#ifdef HAS_MASK
    listed = listed && texelFetch(mask, p, 0).r > 0.0;
#endif
    return listed;
}

// Whether a surface that is there, at the given light, is to scatter.
bool may_scatter(ivec2 p, vec3 light) { return is_listed(p) && !any(isnan(light)) && !any(isinf(light)); }
