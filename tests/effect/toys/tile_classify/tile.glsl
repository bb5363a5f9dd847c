// Tiles are numbered by rows from the top left; the last of a row or column may stick out.
const int kTile = 8;

int tiles_a_row() { return (frame.size.x + kTile - 1) / kTile; }
uint tile_number(ivec2 tile) { return uint(tile.y * tiles_a_row() + tile.x); }
ivec2 tile_of_number(uint number) { return ivec2(int(number) % tiles_a_row(), int(number) / tiles_a_row()); }
