// Light of a pixel at a silhouette, without what antialiasing brought in from across it. Left there, it would stay as an outline
// where the nearer surface's blur dissolves.
#include "horizon.glsl"

vec3 color_inside(ivec2 p) { return texelFetch(color, clamp(p, ivec2(0), frame.size - 1), 0).rgb; }

// Of light from across, in a mixture. A pixel's depth is that of its middle, so that most of its light is its own surface's; but wires that
// miss the middle may cover more of it.
const float kLeastShare = 0.1, kMostShare = 0.5, kMostShareOfNear = 0.6;
const float kLeastBlurredPx = 2.0;
// What is nearer and in focus keeps its antialiasing before the blur: wholly up to the first CoC radius, and no more from the second on,
// where its own side, which stays mixed, is blurred as widely as a mixture.
const float kWhollyKeptPx = 0.8, kNotKeptPx = 1.2;
const float kContrast = 0.15;  // of two surfaces, below which a mixture cannot be seen
const float kOffLine = 0.03;   // squared distance from the line between both colours, of its length squared

bool is_across(ivec2 p, float coc_px) { return abs(coc_inside(p) - coc_px) > kOneSurfacePx; }

// Whether a pixel near p, of its surface and off the silhouette, has p's colour, which then is the surface's own. Upscaled
// captures repeat a mixed pixel up to kTexturePx - 1 times.
const float kSameColor = 0.003;  // squared difference, of the squared one of both surfaces
const int kTexturePx = 3;
bool is_texture(ivec2 p, vec3 own, float coc_px, ivec2 to, float length_2) {
    ivec2 side = ivec2(-to.y, to.x);
    int count = to == ivec2(0) ? 0 : 9;
    for (int i = 0; i < count; ++i) {
        ivec2 q = p + kTexturePx * (ivec2(i % 3, i / 3) - 1);
        if (i == 4 || is_across(q, coc_px) || is_across(q + to, coc_px) || is_across(q + side, coc_px) || is_across(q - side, coc_px)) continue;
        vec3 off = color_inside(q) - own;
        if (dot(off, off) < kSameColor * length_2) return true;
    }
    return false;
}

struct Mixture {
    vec3 rest;       // light without what came from across
    float share;     // of that
    float length_2;
    float off_line;  // as kOffLine; 1 where p is no mixture
};

bool differ(vec3 self, vec3 across) {
    return amount(abs(across - self)) > kContrast * (amount(abs(self)) + amount(abs(across)));
}

// p as a mixture of a colour of its own surface and one from across. beyond: further inside than self.
Mixture mixture_of(vec3 own, vec3 self, vec3 beyond, vec3 across, float most_share) {
    vec3 difference = across - self, change = self - beyond;
    float length_2 = dot(difference, difference);
    const Mixture none = Mixture(vec3(0.0), 0.0, 0.0, 1.0);
    if (!differ(self, across)) return none;
    // Shading that continues as it does inside the surface is not a mixture.
    float share = (dot(own - self, difference) - 2.0 * max(dot(change, difference), 0.0)) / length_2;
    vec3 rest = own - self - share * difference;
    float off_line = max(dot(rest, rest), dot(change, change)) / length_2;
    if (!(share > kLeastShare && share <= most_share && off_line <= kOffLine)) return none;
    return Mixture(max(own - share * difference, min(own, self)), share, length_2, off_line);
}

// Whether what lies across reaches a pixel of the surface from one of its sides.
bool is_beside(ivec2 p, ivec2 to, float coc_px) {
    ivec2 side = ivec2(-to.y, to.x);
    return is_across(p + side, coc_px) || is_across(p - side, coc_px);
}

// Whether a colour differs from both of its neighbours'.
bool is_other(vec3 color, vec3 a, vec3 b, vec3 across) {
    vec3 off_a = color - a, off_b = color - b, whole = across - a;
    return min(dot(off_a, off_a), dot(off_b, off_b)) > kSameColor * dot(whole, whole);
}

// As the texture `mixture` keeps them.
const float kNoEdge = 0.0, kEdge = 0.5, kNearMixture = 0.8, kMixture = 1.0;

struct Unmixed {
    vec3 color;
    float kind;
    vec4 kept;  // as the texture has it
};

Unmixed unmixed(ivec2 p, vec3 own, float coc_px) {
    Mixture best = Mixture(own, 0.0, 0.0, 1.0);
    ivec2 way = ivec2(0);
    float kind = kNoEdge, best_coc = 0.0;
    // Software GL ends a loop once no pixel of a group goes on, but runs what an if leaves out: so each takes its own neighbours in turn.
    uint across_edge = 0u;
    for (int i = 0; i < 9; ++i)
        if (is_across(p + ivec2(i % 3, i / 3) - 1, coc_px)) across_edge |= 1u << i;
    for (; across_edge != 0u; across_edge &= across_edge - 1u) {
        int i = findLSB(across_edge);
        ivec2 to = ivec2(i % 3, i / 3) - 1;
        float across_coc = coc_inside(p + to);
        // The surface has its own colour 2 px inside, where antialiasing does not reach. Between near objects a gap of 2 px has it 1 px
        // inside alone, and one of 1 px beyond the next object.
        bool is_beside_own = !is_across(p - to, coc_px);
        int inside = !is_across(p - 2 * to, coc_px) ? 2 : is_beside_own ? 1 : 3;
        if (inside == 3 && is_across(p - 3 * to, coc_px)) continue;
        if (coc_px < across_coc && abs(coc_px) < kLeastBlurredPx) continue;  // in focus, it keeps its antialiasing
        vec3 beside = color_inside(p - to);
        vec3 self = color_inside(p - inside * to), across = color_inside(p + to);
        if (abs(coc_inside(p + 2 * to) - across_coc) <= kOneSurfacePx) {
            // The pixel across may be mixed too, or the only one of a lit rim.
            vec3 inner = color_inside(p + 2 * to) - self, outer = across - self;
            if (dot(inner, inner) > dot(outer, outer)) across = inner + self;
        }
        float most_share = across_coc < coc_px ? kMostShareOfNear : kMostShare;
        if (differ(self, across)) kind = kEdge;
        Mixture mixture = mixture_of(own, self, inside == 2 ? color_inside(p - 3 * to) : self, across, most_share);
        // An edge of the surface's own may lie that near. Beyond the silhouette's own pixels nothing is mixed, so that another colour
        // than both of its neighbours' is such an edge.
        if (is_beside_own && inside == 2 && (mixture.off_line > kOffLine || !is_beside(p - to, to, coc_px) && is_other(beside, self, own, across)))
            mixture = mixture_of(own, beside, self, across, most_share);
        if (mixture.off_line >= best.off_line) continue;  // the two colours that explain the pixel best
        best = mixture;
        best_coc = across_coc;
        way = to;
    }
    if (way == ivec2(0) || is_texture(p, own, coc_px, way, best.length_2)) return Unmixed(own, kind, vec4(0.0));
    bool is_far = best_coc < coc_px;
    float near_px = is_far ? abs(best_coc) : kLeastBlurredPx;
    float seen = near_px < kLeastBlurredPx ? clamp((kNotKeptPx - near_px) / (kNotKeptPx - kWhollyKeptPx), 0.0, 1.0) : 0.0;
    vec4 near = seen * vec4(max(own - (1.0 - best.share) * best.rest, vec3(0.0)), best.share);
    return Unmixed(near_px < kLeastBlurredPx ? mix(own, best.rest, seen) : best.rest, is_far ? kMixture : kNearMixture, near);
}
