// Side in px of the tiles of near_tile and near, as module.json declares it.
const int kTile = 16;
