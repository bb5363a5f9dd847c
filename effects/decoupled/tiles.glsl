const int kTile = 16;

// Between two tiles.
float gap_px(ivec2 apart) { return float((max(max(abs(apart.x), abs(apart.y)), 1) - 1) * kTile); }
