// A grid of equilateral triangles whose sides are parallel to the lines from the hexagon's middle to its corners: the blurs
// step from point to point, and the three rhombi meet without a gap or an overlap at any rotation.
//
// Point (u, v) lies at spacing * (u a + v b). Two shears by whole texels lay the points out in a texture so that a texel is
// always within about a px of spacing of where it lies in the picture.
const float kSixthTurn = 1.04719755119660;
const float kCell = 0.86602540378444;  // area of the parallelogram of a and b
const int kMargin = 2;                 // texels before the picture's first

struct Grid {
    float spacing;  // px
    vec2 a, b;
    vec2 shear;
    int sign;       // corners of the hexagon lie at sign times (1, 0), (-1, 1) and (0, -1), and opposite
};

Grid make_grid(float spacing) {
    Grid grid;
    grid.spacing = spacing;
    float corner = radians(90.0 + param.rotation), best = corner;
    for (int i = 1; i < 3; ++i)
        if (abs(cos(corner + 2.0 * float(i) * kSixthTurn)) > abs(cos(best)) + 1e-4) best = corner + 2.0 * float(i) * kSixthTurn;
    grid.sign = cos(best) < 0.0 ? -1 : 1;
    grid.a = float(grid.sign) * vec2(cos(best), sin(best));
    float s = sin(kSixthTurn), c = cos(kSixthTurn);
    grid.b = vec2(c * grid.a.x - s * grid.a.y, s * grid.a.x + c * grid.a.y);
    grid.shear = vec2(grid.b.x / grid.a.x, grid.a.y * grid.a.x / kCell);
    return grid;
}

ivec2 texel_of(Grid grid, ivec2 point) {
    int x = point.x + int(floor(grid.shear.x * float(point.y) + 0.5));
    return ivec2(x, point.y + int(floor(grid.shear.y * float(x) + 0.5))) + kMargin;
}

ivec2 point_of(Grid grid, ivec2 texel) {
    texel -= kMargin;
    int v = texel.y - int(floor(grid.shear.y * float(texel.x) + 0.5));
    return ivec2(texel.x - int(floor(grid.shear.x * float(v) + 0.5)), v);
}

vec2 position_of(Grid grid, ivec2 point) {
    return grid.spacing * (float(point.x) * grid.a + float(point.y) * grid.b);
}

// Fractional (u, v) of an offset in px.
vec2 coordinates_of(Grid grid, vec2 offset) {
    vec2 scaled = offset / (grid.spacing * kCell);
    return vec2(scaled.x * grid.b.y - scaled.y * grid.b.x, grid.a.x * scaled.y - grid.a.y * scaled.x);
}

// Share of a point in the light at an offset of `coordinates` from it: linear in each triangle, 1 in all.
float share_at(vec2 coordinates) {
    return 1.0 - max(max(abs(coordinates.x), abs(coordinates.y)), abs(coordinates.x + coordinates.y));
}

bool is_in(ivec2 texel, ivec2 size) { return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size)); }

#ifdef FINE
const float kSpacing = FINE == 1 ? 1.0 : 2.0;

// The tile's texel of `grids` if the point is needed by the grid at hand; else its third and fourth parts are 0.
vec4 grids_at(vec2 position) {
    vec2 last = vec2(frame.size) - 1.0;
    if (any(lessThan(position, vec2(-2.0))) || any(greaterThan(position, last + 3.0))) return vec4(0.0);
    return texelFetch(grids, ivec2(clamp(position, vec2(0.0), last)) / kTile, 0);
}

bool is_needed(vec4 tile) { return (FINE == 1 ? tile.z : tile.w) > 0.0; }
#endif
