// Groups of 16 tiles in a row, which one invocation of host/list_tiles.comp takes.
const int kTilesOfAGroup = 16;

int tile_group(ivec2 tile, int tiles_in_a_row) {
    return tile.y * ((tiles_in_a_row + kTilesOfAGroup - 1) / kTilesOfAGroup) + tile.x / kTilesOfAGroup;
}
