// Twice the widest d, in px, about as far as light goes. Nearer, a crease would count as a surface of its own.
int bend_step(ScatteringProfileRow row, float depth_m) {
    return int(clamp(2.0 * widest(row.d) * pixels_per_mm(view_lines(), depth_m) + 0.5, 1.0, 64.0));
}

// Normals are the world's, ways the view's. Where nobody knows how the two lie, 0: as if nothing had been passed.
vec3 way_in_world(vec3 way) { return camera.has_matrices ? mat3(camera.world_from_view) * way : vec3(0.0); }
