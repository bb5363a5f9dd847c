// Lays out the grid.
#include "grid.glsl"

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
