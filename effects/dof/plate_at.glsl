// The clean plate: what a pixel shows where no silhouette hides it.
Light plate_at(ivec2 p) {
    Light patched = unpack_plate(texelFetch(plate, p, 0));
    return is_patch(patched) ? patched : tap_light(p);
}

// The same at half size, which lies below it.
Light half_plate_at(ivec2 p) {
    Light patched = unpack_plate(texelFetch(plate, p + ivec2(0, room_row()), 0));
    return is_patch(patched) ? patched : tap_level(p, grid_of(1));
}
