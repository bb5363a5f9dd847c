// Where surfaces end, by tiles, for shaders that give block(p, texel): the CoC radii of 2 x 2 texels as textureGather orders them, lower
// left, lower right, upper right, upper left; `texel` are the sides of one, in the texture's. Needs highlight.glsl.

const int kSide = kRepairTile + 2;  // with 1 px around

float smallest_of(vec4 v) { return min(min(v.x, v.y), min(v.z, v.w)); }
float largest_of(vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }

// Two rows of half a tile, with 1 px to both sides, in registers: each texel is fetched once, with the three beside it, which takes
// software GL little longer.
struct Row { vec4 a, b; vec2 c; };
struct Rows { Row upper, lower; };

Rows rows_at(ivec2 p, vec2 texel) {
    Rows rows;
    vec4 l = block(p, texel), r = block(p + ivec2(2, 0), texel);
    rows.upper.a = vec4(l.wz, r.wz);
    rows.lower.a = vec4(l.xy, r.xy);
    l = block(p + ivec2(4, 0), texel), r = block(p + ivec2(6, 0), texel);
    rows.upper.b = vec4(l.wz, r.wz);
    rows.lower.b = vec4(l.xy, r.xy);
    l = block(p + ivec2(8, 0), texel);
    rows.upper.c = l.wz;
    rows.lower.c = l.xy;
    return rows;
}

float step_along(Row row) {
    vec4 ab = abs(row.a - vec4(row.a.yzw, row.b.x)), bc = abs(row.b - vec4(row.b.yzw, row.c.x));
    return max(largest_of(max(ab, bc)), abs(row.c.x - row.c.y));
}

float step_across(Row row, Row above) {
    vec2 c = abs(row.c - above.c);
    return max(largest_of(max(abs(row.a - above.a), abs(row.b - above.b))), max(c.x, c.y));
}

// Of the tile's own columns.
float smallest_own(Row row) { return min(min(smallest_of(row.b), min(row.a.y, row.a.z)), min(row.a.w, row.c.x)); }
float largest_own(Row row) { return max(max(largest_of(row.b), max(row.a.y, row.a.z)), max(row.a.w, row.c.x)); }

// As coc_step holds it.
vec4 step_of(ivec2 tile) {
    ivec2 corner = kRepairTile * tile - 1;
    float step_px = 0.0, smallest = 1e30, greatest = -1e30;
    // Once: software GL fetches members of a block anew wherever they stand.
    vec2 texel = texel_of_blocks();
    ivec2 last = ivec2(color_size.xy) - 1;
    int x = corner.x;
    // Both halves by one loop, as the rows are: the more code, the longer it takes to compile.
    do {
        Row above = Row(vec4(0.0), vec4(0.0), vec2(0.0));
        int y = 0;
        do {
            Rows rows = rows_at(ivec2(x, corner.y + y), texel);
            float across = step_across(rows.lower, rows.upper);
            if (y > 0) across = max(across, step_across(rows.upper, above));
            step_px = max(max(step_px, across), max(step_along(rows.upper), step_along(rows.lower)));
            if (y > 0) {
                smallest = min(smallest, smallest_own(rows.upper));
                greatest = max(greatest, largest_own(rows.upper));
            }
            if (y < kRepairTile) {
                smallest = min(smallest, smallest_own(rows.lower));
                greatest = max(greatest, largest_own(rows.lower));
            }
            above = rows.lower;
        } while ((y += 2) < kSide);
    } while ((x += kRepairTile / 2) < corner.x + kRepairTile);
    vec4 found = vec4(step_px, 0.0, smallest, greatest);
    if (!is_repaired(step_px)) return found;
    float sum = 0.0, brightest = 0.0;
    // From a place that varies, so that a compiler does not unroll it.
    ivec2 p = corner;
    do {
        p.x = corner.x;
        do {
            float light = amount(texelFetch(color, clamp(p, ivec2(0), last), 0).rgb);
            brightest = max(brightest, light);
            ivec2 own = p - corner;
            if (own.x > 0 && own.x <= kRepairTile && own.y > 0 && own.y <= kRepairTile) sum += max(light, 0.0);
        } while (++p.x < corner.x + kSide);
    } while (++p.y < corner.y + kSide);
    found.g = sum / float(kRepairTile * kRepairTile);
#ifndef SHARES_PIXELS
    if (brightest <= kOutshinesTile * found.g) found.g = kNothingOutshines;
#endif
    return found;
}
