// Sum of R, G and B: what light means where only its amount matters.
float amount(vec3 rgb) { return rgb.r + rgb.g + rgb.b; }

// A texel of light that outshines the rest this many times is a highlight.
const float kHighlight = 4.0;
