const int kTile = 8;  // px
