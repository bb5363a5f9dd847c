// The average over frames within the step: that of what the two blurs of separable scattering leave over. The blurs have no noise
// and are of this frame's light, so that only what they are wrong by lags behind light that moves.
#include <scattering/facet.glsl>
#include "blur_frames.glsl"
#include "past.glsl"
#include "shares.glsl"

// Beyond this a count of frames decides nothing.
const float kMostFrames = 4096.0;

// The most that the blurs leave over, as a part of the light that there is: on the stills of docs/quality-sss-adaptive.md it is
// more in 10 of 10,000 pixels.
const float kMostLeftOver = 0.5;

// Where light moves, the average lags by more than a frame of many samples is noisy: one of so many counts as much as all before
// it, but no more than kWeightOfChange times the part by which the blurred light changed. Without this, an ear whose light moves
// lost 9 dB.
const float kSamplesOfHalf = 40.0;
const float kWeightOfChange = 8.0;

// What a pixel that scatters comes to after this frame.
struct Guided {
    Gathered sums;
    float frames;   // how many they are of, and kFramesOfBlur
    vec2 residual;  // residual_at() of the pixel
};

// The light of samples that find this share of the profile, of which filled() makes `light`.
vec3 unfilled(vec3 light, Gathered sums) { return light * filling(sums.share / sums.whole) * sums.whole; }

// What the average of the frame before is in this frame's light, of which `now` is. `change`: change of the blurred light, divided by the greater of both values.
Gathered carried(ivec2 p, ivec2 q, Gathered now, out float change) {
    Gathered then = with_shares(texelFetch(guided_prev, q, 0).rgb, texelFetch(guided_shares_prev, q, 0));
    vec3 smooth_now = texelFetch(blurred, p, 0).rgb, smooth_then = texelFetch(blurred_prev, q, 0).rgb;
    vec3 changes = abs(smooth_now - smooth_then) / max(max(smooth_now, smooth_then), 1e-20);
    change = max(changes.r, max(changes.g, changes.b));
    // Where light fades, so does what the blurs are wrong by.
    vec3 left_over = (filled(then) - smooth_then) * min(smooth_now / max(smooth_then, 1e-20), 1.0);
    // Where samples met a highlight that the blurs missed, only they can say that it has gone.
    left_over = min(left_over, kMostLeftOver * max(smooth_now, filled(now)));
    then.light = unfilled(smooth_now + left_over, then);
    return then;
}

// `now`: of the frame's `count` samples. q: where the pixel was, if was_seen, in the frame before. Sums are averaged apart: a ratio
// of few samples is off in the mean, that of the averages less.
Guided guided_light(ivec2 p, Gathered now, float count, ivec2 q, bool was_seen) {
    float frames = was_seen ? texelFetch(guided_prev, q, 0).a : 0.0, change = 0.0;
    Gathered then = frames > 0.0 ? carried(p, q, now, change) : Gathered(unfilled(texelFetch(blurred, p, 0).rgb, now), now.share, now.whole);
    // Frames count alike until the newest would count less than its weight.
    float frames_now = min(max(frames, kFramesOfBlur) + 1.0, kMostFrames), squared = count * count;
    float in_change = min(squared / (squared + kSamplesOfHalf * kSamplesOfHalf), kWeightOfChange * change);
    float weight = max(max(1.0 / frames_now, param.guiding_weight), in_change);
    Gathered sums = Gathered(mix(then.light, now.light, weight), mix(then.share, now.share, weight), mix(then.whole, now.whole, weight));
    vec2 residual = frames > 0.0 ? vec2(q) + 0.5 + residual_at(q) - past_place() : vec2(0.0);
    return Guided(sums, frames_now, (1.0 - weight) * residual);
}

void keep_average(Guided now) {
    out_guided_shares = kept_shares(now.sums, now.residual);
    // Shares are kept rounded, but the light that they come to is not.
    out_guided = vec4(unfilled(filled(now.sums), with_shares(vec3(0.0), out_guided_shares)), now.frames);
}
