// Asks the cache's request() where the light of one pixel's ids lies.
void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    uint first_slot = 0u;
    if (tile_px > 0u) {
        uint columns = (width_px + tile_px - 1u) / tile_px;
        first_slot = (pixel / width_px / tile_px * columns + pixel % width_px / tile_px) * slots;
    }
    uint own = 0u;
    for (uint i = 0u; i < sample_count; ++i) {
        uint id = ids[pixel * sample_count + i];
        if (id != kNoShading) ++own;
        places[pixel * sample_count + i] = id == kNoShading ? kNoShading : request(id, first_slot);
    }
    atomicAdd(requests, own);
}
