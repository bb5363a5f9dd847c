// Of tiles that are traced: the CoC radius and the longest way that reach them, px.
const vec2 kTracedPx = vec2(1.0, 2.5);
// Lens and shutter meet at a pixel whose light both have moved: not below the first distance, wholly above the second, px.
const float kApartPx = 0.75, kMetPx = 1.5;
