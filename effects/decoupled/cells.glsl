const int kCells = 32;   // across the lens
const int kTimes = 16;   // and one more: at any time
const int kFirst = 64;   // samples of the first band

// The sample of the first band that is nearest to a point of the lens at a time, 0 to kTimes.
int sample_near(vec2 point, int time) {
    ivec2 cell = clamp(ivec2(floor((0.5 * point + 0.5) * float(kCells))), ivec2(0), ivec2(kCells - 1));
    return int(texelFetch(cells, cell + ivec2(0, kCells * time), 0).r);
}
