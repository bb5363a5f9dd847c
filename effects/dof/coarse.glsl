// Levels 1 to 3 of `light` lie below level 0, side by side: where the level differs from pixel to pixel, a fetch from
// levels of one texture takes software GL twice as long, and two textures take two fetches.
struct Grid {
    ivec2 origin, last;  // texels of `light`; of the level
};

// Smaller frames have no room for three levels.
bool has_coarse_levels() { return min(frame.size.x, frame.size.y) >= 8; }

// The first row of a texture's room.
int room_row() { return frame.size.y + 63 & ~63; }

Grid grid_of(int level) {
    ivec2 origin = ivec2((level > 1 ? frame.size.x >> 1 : 0) + (level > 2 ? frame.size.x >> 2 : 0), level > 0 ? room_row() : 0);
    return Grid(origin, max(frame.size >> level, ivec2(1)) - 1);
}
