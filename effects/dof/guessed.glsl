#include "loads.glsl"
#include "near_tile.glsl"

struct Hidden {
    Light light;
    bool is_there;
};

const float kLeastLikeness = 0.01;  // of a guess for another surface, which is better than none

// From the guesses around it for the pixel's surface; the nearest says which surface is hidden. Half of them must be there, so that
// no patch reaches further than what it is of.
Hidden hidden_at(ivec2 p, float coc_px) {
    ivec2 corner = (p - 1) >> 1, last = textureSize(guessed, 0) - 1, to_nearest = p - 2 * corner - 1;
    Light nearest = Light(vec4(0.0), 2.0 * kHalfInfinity), taps[4];
    float weights[4], most = 0.0, all = 0.0, found = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 to = ivec2(i & 1, i >> 1), texel = clamp(corner + to, ivec2(0), last);
        vec2 linear = abs(vec2(1 - to) - 0.25 - 0.5 * vec2(to_nearest)), unlike_px = abs(texelFetch(guessed_of, texel, 0).rg - coc_px);
        bool is_drawn = is_near(2 * texel / kTile);
        uvec4 near = is_drawn ? texelFetch(guessed, texel, 0) : kNoPatch, far = is_drawn ? texelFetch(guessed_far, texel, 0) : kNoPatch;
        taps[i] = unpack_light(unlike_px.x <= unlike_px.y ? near : far);
        weights[i] = max(1.0 - 0.5 * min(unlike_px.x, unlike_px.y), kLeastLikeness) * linear.x * linear.y;
        all += weights[i];
        if (!is_patch(taps[i])) weights[i] = 0.0;
        found += weights[i];
        if (weights[i] > most) {
            most = weights[i];
            nearest = taps[i];
        }
    }
    Light sum = Light(vec4(0.0), 0.0);
    float weight = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (weights[i] == 0.0 || abs(taps[i].coc - nearest.coc) > kClear) continue;
        sum.color += weights[i] * taps[i].color;
        sum.coc += weights[i] * taps[i].coc;
        weight += weights[i];
    }
    return Hidden(Light(sum.color / weight, sum.coc / weight), found > 0.5 * all && nearest.coc > coc_px + kClear);
}
