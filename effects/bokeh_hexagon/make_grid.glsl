// Lays out the grid, and tells how large a texture it is in.
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

#ifdef FINE
const float kSpacing = FINE == 1 ? 1.0 : 2.0;

// Texels of the grid's textures, whose scales effect.json declares.
ivec2 target_size() { return FINE == 1 ? (5 * frame.size + 3) / 4 : (11 * frame.size + 15) / 16; }
#else
ivec2 target_size() { return frame.size; }
#endif
