// How far behind a pixel lies: by its CoC, and by its depth where everything is in focus.
const float kPxPerOctave = 8.0;
const float kClearPx = 1.0;  // what lies further behind is another surface

float order_at(ivec2 p) {
    float depth_m = texelFetch(depth, p, 0).r;
    return texelFetch(coc, p, 0).r + kPxPerOctave * (depth_m > 0.0 ? min(log2(depth_m), 14.0) : 14.0);
}
