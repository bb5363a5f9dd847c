// How far behind a pixel lies, px: by its CoC, and by its depth where everything is in focus.
const float kPxPerOctave = 8.0;
const float kInfinityOctaves = 14.0;
const float kClearPx = 1.0;  // what lies further behind is another surface
