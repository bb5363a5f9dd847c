// Sum of R, G and B: what light means where only its amount matters.
float amount(vec3 rgb) { return rgb.r + rgb.g + rgb.b; }

// A texel of light that outshines the rest this many times is a highlight.
const float kHighlight = 4.0;
// Neighbours whose CoC radii differ by no more are of one surface.
const float kOneSurfacePx = 1.0;
// Side in px of the tiles of coc_step, as module.json declares it.
const int kRepairTile = 16;
// Whether a tile may hold the edge of a surface, by the largest difference of CoC radius in coc_step. Two steps lead to a
// diagonal neighbour.
bool is_repaired(float step_px) { return step_px > 0.5 * kOneSurfacePx; }

// Light may have come across an edge from what outshines its tile this many times; coc_step has this mean of a tile where nothing does.
const float kOutshinesTile = 3.0;
const float kNothingOutshines = 1e30;
// By the texel of coc_step.
bool may_be_repaired(vec4 tile) { return is_repaired(tile.r) && !(tile.g >= kNothingOutshines); }
