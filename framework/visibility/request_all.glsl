// The pixel of the n-th invocation. The squares at the right and the bottom may be smaller.
uint pixel_at(uint n) {
    uint strip = n / (width_px * order_px), within = n % (width_px * order_px), top = strip * order_px;
    uint rows = min(order_px, pixel_count / width_px - top), left = within / (order_px * rows) * order_px;
    uint columns = min(order_px, width_px - left), in_square = within - left * rows;
    return (top + in_square / columns) * width_px + left + in_square % columns;
}

// Asks the cache's request() where the light of one pixel's ids lies.
void main() {
    if (gl_GlobalInvocationID.x >= pixel_count) return;
    uint pixel = pixel_at(gl_GlobalInvocationID.x);
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
