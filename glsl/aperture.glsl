// The aperture's outline, for a circumradius of 1: a regular polygon with the middle of an edge at rotation_rad from +x
// towards +y, or a disk (fewer than 3 blades). Blades bend: curvature 0 is straight, 1 a disk. A far point's light covers
// the outline times its CoC radius, a near point's the outline turned by 180 degrees, which a negative radius does.
// Sousa 2013, CryEngine 3 Graphics Gems, circle to polygon.

const float kPi = 3.14159265358979;

struct Aperture {
    float blades;     // 0: a disk
    float curvature;
    float rotation_rad;
    float area;       // of the outline
    float inradius;   // nearest the outline comes to the middle
};

Aperture make_aperture(int blades, float curvature, float rotation_rad) {
    if (blades < 3 || curvature >= 1.0) return Aperture(0.0, 1.0, rotation_rad, kPi, 1.0);
    // Integral of the squared outline k (1 - c) / cos(phi) + c over one blade, |phi| <= half.
    float half_blade = kPi / float(blades), inner = cos(half_blade), straight = (1.0 - curvature) * inner;
    float secant = 2.0 * log(tan(half_blade) + 1.0 / inner);
    float blade = straight * straight * 2.0 * tan(half_blade) + 2.0 * straight * curvature * secant
                + curvature * curvature * 2.0 * half_blade;
    return Aperture(float(blades), curvature, rotation_rad, 0.5 * float(blades) * blade, mix(inner, 1.0, curvature));
}

// Distance from the middle to the outline in the direction of angle_rad.
float aperture_outline(Aperture a, float angle_rad) {
    if (a.blades == 0.0) return 1.0;
    float blade = 2.0 * kPi / a.blades;
    float off_middle = angle_rad - a.rotation_rad;
    off_middle -= blade * floor(off_middle / blade + 0.5);
    return mix(cos(0.5 * blade) / cos(off_middle), 1.0, a.curvature);
}

// The factor by which the outline must grow to reach the offset: at most 1 inside.
float aperture_gauge(Aperture a, vec2 offset) {
    float distance = length(offset);
    return distance == 0.0 ? 0.0 : distance / aperture_outline(a, atan(offset.y, offset.x));
}

// Maps the unit disk onto the aperture along its radii; where density is even on a disk, it is nearly so on the aperture.
vec2 aperture_from_disk(Aperture a, vec2 point) {
    float radius = length(point);
    return radius == 0.0 ? point : point * aperture_outline(a, atan(point.y, point.x));
}
