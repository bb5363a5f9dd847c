// Light of a pixel at a silhouette, without what antialiasing brought in from across it. Left there, it would stay as an outline
// where the nearer surface's blur dissolves.
#include <lens/highlight.glsl>

float coc_inside(ivec2 p) { return texelFetch(coc, clamp(p, ivec2(0), frame.size - 1), 0).r; }
vec3 color_inside(ivec2 p) { return texelFetch(color, clamp(p, ivec2(0), frame.size - 1), 0).rgb; }

const float kLeastShare = 0.1, kMostShare = 0.7;
const float kLeastBlurredPx = 2.0;
const float kContrast = 0.15;  // of two surfaces, below which a mixture cannot be seen
const float kOffLine = 0.03;   // squared distance from the line between both colours, of its length squared

vec3 unmixed(ivec2 p, vec3 own, float coc_px) {
    float most = kLeastShare;
    vec3 result = own;
    for (int i = 0; i < 9; ++i) {
        ivec2 to = ivec2(i % 3, i / 3) - 1;
        float across_coc = coc_inside(p + to);
        if (abs(across_coc - coc_px) <= kOneSurfacePx || abs(coc_inside(p - 2 * to) - coc_px) > kOneSurfacePx) continue;
        if (abs(min(across_coc, coc_px)) < kLeastBlurredPx) continue;  // a nearer one in focus keeps its antialiasing
        bool is_thick = abs(coc_inside(p + 2 * to) - across_coc) <= kOneSurfacePx;
        vec3 self = color_inside(p - 2 * to), change = self - color_inside(p - 3 * to);
        vec3 difference = color_inside(is_thick ? p + 2 * to : p + to) - self;
        float length_2 = dot(difference, difference);
        if (amount(abs(difference)) < kContrast * (amount(abs(self)) + amount(abs(self + difference)))) continue;
        // Shading that continues as it does inside the surface is not a mixture.
        float share = (dot(own - self, difference) - 2.0 * max(dot(change, difference), 0.0)) / length_2;
        vec3 rest = own - self - share * difference;
        if (share <= most || share > kMostShare || max(dot(rest, rest), dot(change, change)) > kOffLine * length_2) continue;
        most = share;
        result = max(own - share * difference, min(own, self));
    }
    return result;
}
