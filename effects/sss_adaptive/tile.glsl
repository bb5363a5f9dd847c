const int kTile = 8;  // px

// Tiles beside one that something within so many px may lie in.
int tiles_of(float reach_px) { return int(ceil(min(reach_px, 65536.0) / float(kTile))); }
