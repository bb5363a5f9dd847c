// Slices of depth, numbered from near to far: as many of them in front of the focus plane as behind it in proportion to the
// CoC that the picture has there, even in CoC, and between them one of the pixels in focus.
const int kSlices = 32;  // as effect.json declares
const int kTile = 64;    // px a side of the tiles of range_tile
// Pixels with a smaller CoC radius are in focus, and spread over no other pixel, px.
const float kSharp = 0.5;

int slice_of(vec2 largest_px, float coc) {
    vec2 blurred_px = max(largest_px - kSharp, 0.0);
    int near_count = clamp(int(float(kSlices - 1) * blurred_px.x / max(blurred_px.x + blurred_px.y, 1e-6) + 0.5),
                           blurred_px.x > 0.0 ? 1 : 0, kSlices - (blurred_px.y > 0.0 ? 2 : 1));
    float radius = abs(coc);
    if (radius < kSharp) return near_count;
    if (coc < 0.0) {
        float from_front = 1.0 - (radius - kSharp) / max(blurred_px.x, 1e-6);
        return clamp(int(float(near_count) * from_front), 0, max(near_count - 1, 0));
    }
    int far_count = kSlices - 1 - near_count;
    float from_focus = (radius - kSharp) / max(blurred_px.y, 1e-6);
    return near_count + 1 + clamp(int(float(far_count) * from_focus), 0, max(far_count - 1, 0));
}

// Px by which pixels beyond the picture can reach it.
int margin_px(vec2 largest_px) { return int(ceil(max(largest_px.x, largest_px.y) + 0.5)); }
