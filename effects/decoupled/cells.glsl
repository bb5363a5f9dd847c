const int kCells = 32;   // across the lens
const int kTimes = 16;   // and one more: at any time
