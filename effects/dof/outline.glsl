// The aperture's outline as a gauge: the factor by which the outline must grow to reach an offset. prepare_outline_at comes
// before the others.
#include <aperture.glsl>

// Opposite edges of an even polygon share one.
const int kNormals = BLADES % 2 == 0 ? BLADES / 2 : BLADES;
#if BLADES >= 3
vec2 edge_normals[kNormals];  // over the inradius
#endif
#if BLADES >= 4 && BLADES % 2 == 0
vec2 edge_slants[kNormals];   // y over x of a normal, and 1 over x
#endif
Aperture aperture;
vec2 rim;          // middle of the lens's rim, in radii of the aperture
float open_area;   // of the outline within the rim, for a radius of 1

void prepare_outline_at(vec2 pixel) {
    aperture = make_aperture(BLADES, CURVATURE, radians(param.rotation));
#if BLADES >= 3
    // One sine and one cosine for all normals, which lie at fixed angles to the first: software GL computes them for each pixel.
    float turn = radians(param.rotation);
    vec2 first = vec2(cos(turn), sin(turn)) / cos(kPi / float(BLADES));
    for (int i = 0; i < kNormals; ++i) {
        float angle = 2.0 * kPi * float(i) / float(BLADES);
        edge_normals[i] = first * cos(angle) + vec2(-first.y, first.x) * sin(angle);
#if BLADES >= 4 && BLADES % 2 == 0
        float x = edge_normals[i].x, across = 1.0 / (x < 0.0 ? min(x, -1e-4) : max(x, 1e-4));
        edge_slants[i] = vec2(edge_normals[i].y * across, across);
#endif
    }
#endif
    rim = vec2(0.0);
    open_area = aperture.area;
    if (CAT_EYE > 0.0) {
        // Off the middle of the picture the rim of the lens hides the aperture's outer side.
        vec2 middle = 0.5 * vec2(frame.display_size);
        rim = CAT_EYE * (middle - (pixel + vec2(frame.origin))) / length(middle);
        // Two circles' common area, as a share of one.
        float apart = min(length(rim), 2.0);
        open_area *= (2.0 * acos(0.5 * apart) - 0.5 * apart * sqrt(4.0 - apart * apart)) / kPi;
    }
}

// offset: of the lit pixel from the light's own; a light in front of the focus plane is turned by 180 degrees.
float gauge(vec2 offset, float coc) {
    if (coc < 0.0 && (BLADES % 2 != 0 || CAT_EYE > 0.0)) offset = -offset;
    float distance = length(offset), outline = distance;
#if BLADES >= 3
    float straight = 0.0;
    for (int i = 0; i < kNormals; ++i) {
        float along = dot(edge_normals[i], offset);
        straight = max(straight, BLADES % 2 == 0 ? abs(along) : along);
    }
    outline = CURVATURE == 0.0 ? straight : distance / mix(distance / max(straight, 1e-6), 1.0, CURVATURE);
#endif
    if (CAT_EYE > 0.0) {
        // |offset / t - rim| = 1, solved for t.
        float along = dot(offset, rim), rest = 1.0 - dot(rim, rim);
        outline = max(outline, (sqrt(along * along + rest * distance * distance) - along) / rest);
    }
    return outline;
}

// The gauge in apothems, at places of a row: in these units cover() has a slope of 1 px. What the row shares stands once.
const bool kIsEvenPolygon = BLADES >= 4 && BLADES % 2 == 0 && CURVATURE == 0.0 && CAT_EYE == 0.0;
struct GaugeRow {
    float dy;
    float along[max(kNormals, 1)];
};

GaugeRow gauge_row(float dy) {
    GaugeRow row;
    row.dy = dy;
#if BLADES >= 3
    for (int i = 0; i < kNormals; ++i) row.along[i] = aperture.inradius * edge_normals[i].y * dy;
#endif
    return row;
}

float gauge_apothem(GaugeRow row, float dx, float coc) {
#if BLADES >= 3
    if (kIsEvenPolygon) {
        float straight = 0.0;
        for (int i = 0; i < kNormals; ++i) straight = max(straight, abs(aperture.inradius * edge_normals[i].x * dx + row.along[i]));
        return straight;
    }
#endif
    return aperture.inradius * gauge(vec2(dx, row.dy), coc);
}

// Sum of cover() over the pixels that a light of this CoC radius reaches, at least one: the aperture's area in px, and what the rim's
// slope of 1 px adds to it.
float spread_area(float radius_px) {
    float slope = 1.0 / (12.0 * aperture.inradius * aperture.inradius);
    return max(open_area * (radius_px * radius_px + slope), 1.0);
}

float spread_area_apothem(float apothem) { return max(open_area / (aperture.inradius * aperture.inradius) * (apothem * apothem + 1.0 / 12.0), 1.0); }

// Coverage of a pixel whose gauge is this by the outline of this radius: 1 inside, half on the outline.
float cover(float radius_px, float gauge_px) {
    return clamp((radius_px - gauge_px) * aperture.inradius + 0.5, 0.0, 1.0);
}

// A CoC radius as a half, of 64 px; and what rounding adds.
const float kHalfErrorPx = 0.05;

// Columns, from the middle of an outline of at most this radius, that it may cover in a row this far from its middle.
vec2 columns(float radius_px, float dy) {
    float gauge_px = radius_px + 0.5 / aperture.inradius + kHalfErrorPx;
    // A polygon's own edges bound them closer than the circle around it.
    const bool kIsPolygon = BLADES >= 4 && BLADES % 2 == 0 && CURVATURE == 0.0;
    float across = kIsPolygon ? gauge_px : sqrt(max(gauge_px * gauge_px - dy * dy, 0.0));
    vec2 range = vec2(-across, across);
#if BLADES >= 4 && BLADES % 2 == 0
    if (CURVATURE == 0.0)
        for (int i = 0; i < kNormals; ++i) {
            float middle = -edge_slants[i].x * dy, half_width = gauge_px * abs(edge_slants[i].y);
            range = vec2(max(range.x, middle - half_width), min(range.y, middle + half_width));
        }
#endif
    return range;
}
