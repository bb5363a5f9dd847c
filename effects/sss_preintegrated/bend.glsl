// Half of the widest d, in px: a surface bends for scattered light over about that far, and the rounding of stored normals
// counts less over more pixels.
int bend_step(uint key, float depth_m) {
    vec3 d = scattering_profile(key - 1u).d;
    float px = key != 0u ? 0.5 * max(d.r, max(d.g, d.b)) * pixels_per_mm(view_lines(), depth_m) : 1.0;
    return int(clamp(px + 0.5, 1.0, 16.0));
}
