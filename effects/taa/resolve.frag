#version 450 core
#include <pass>
#include "history.glsl"
#include "light.glsl"

// Beyond this, squares leave the range of float.
const float kMostLight = 1e15;

// What differs by this part of the luma is the same: rounding shall not drop history.
const float kSlack = 1.0 / 1024.0;

// By the bits, whose order is that of floats: what is no number has greater ones than any that is. Compilers may turn comparisons
// of floats around as if there was no NaN.
bool is_light(vec4 texel) {
    ivec4 size = floatBitsToInt(texel) & 0x7FFFFFFF;
    return max(max(size.r, size.g), max(size.b, size.a)) < floatBitsToInt(kMostLight);
}

struct Samples {
    vec4 light[9];
    bool usable[9];
};

// The sampler takes the texel whose centre a place is, or the edge's: on llvmpipe faster than texelFetch() with a clamp.
Samples samples_around(vec2 centre) {
    Samples samples;
    for (int i = 0; i < 9; ++i) {
        samples.light[i] = textureLod(color, (centre + vec2(i % 3, i / 3) - 1.0) * color_size.zw, 0.0);
        samples.usable[i] = is_light(samples.light[i]);
    }
    return samples;
}

// A filter's bell, 1 in its middle, at a distance in px; of two axes the product.
float bell(float distance) {
    float x = distance / param.filter_width;
#if RECONSTRUCTION == RECONSTRUCTION_BLACKMAN_HARRIS
    if (abs(x) >= 0.5) return 0.0;
    float c = cos(6.283185307 * x);
    // Harris 1978, minimum 4 terms, with the cosines of two and three times the angle as powers of c.
    return 0.35875 - 0.14128 + (0.48829 - 3.0 * 0.01168) * c + 2.0 * 0.14128 * c * c + 4.0 * 0.01168 * c * c * c;
#else
    // From 26 on, Mesa would multiply exp()'s log2(e) into the constant.
    precise float exponent = -2.29 * 3.3 * 3.3 * x * x;
    return exp(exponent);
#endif
}

// The mean by `filter_weights`; false where there is nothing to take it of.
bool weighted_mean(Samples samples, float filter_weights[9], out vec4 light) {
    vec4 sum = vec4(0.0);
    float weight_sum = 0.0;
    for (int i = 0; i < 9; ++i) {
        float weight = samples.usable[i] ? filter_weights[i] * weight_of(samples.light[i]) : 0.0;
        if (weight > 0.0) sum += weight * samples.light[i];
        weight_sum += weight;
    }
    light = weight_sum > 0.0 ? sum / weight_sum : vec4(0.0);
    return weight_sum > 0.0;
}

// The frame at the pixel's centre. A sample that is no number does not count; where none of nine is one there is nothing.
bool current_light(Samples samples, out vec4 light) {
    float filter_weights[9];
#if RECONSTRUCTION == RECONSTRUCTION_NONE
    light = samples.light[4];
    if (samples.usable[4]) return true;
#else
    for (int i = 0; i < 9; ++i) {
        vec2 away = vec2(i % 3, i / 3) - 1.0 + camera.jitter_px;
        filter_weights[i] = bell(away.x) * bell(away.y);
    }
    if (weighted_mean(samples, filter_weights, light)) return true;
#endif
    for (int i = 0; i < 9; ++i) filter_weights[i] = 1.0;
    return weighted_mean(samples, filter_weights, light);
}

struct Box {
    vec4 low, high;
};

// Of the samples as they are compared. The filtered frame always lies within, or a lone bright point at rest would be held
// to less than it is.
Box box_of(Samples samples, vec4 current) {
    Box box = Box(compared(current), compared(current));
#if REJECTION == REJECTION_VARIANCE_CLIP
    vec4 mean = vec4(0.0), squares = vec4(0.0);
    float count = 0.0;
    vec4 values[9];
    for (int i = 0; i < 9; ++i) {
        values[i] = samples.usable[i] ? compared(samples.light[i]) : vec4(0.0);
        mean += values[i];
        count += samples.usable[i] ? 1.0 : 0.0;
    }
    mean /= max(count, 1.0);
    for (int i = 0; i < 9; ++i) {
        vec4 away = samples.usable[i] ? values[i] - mean : vec4(0.0);
        squares += away * away;
    }
    vec4 deviation = sqrt(squares / max(count, 1.0));
    if (count > 0.0) {
        box.low = min(box.low, mean - param.gamma * deviation);
        box.high = max(box.high, mean + param.gamma * deviation);
    }
#else
    for (int i = 0; i < 9; ++i) {
        if (!samples.usable[i]) continue;
        vec4 value = compared(samples.light[i]);
        box.low = min(box.low, value);
        box.high = max(box.high, value);
    }
#endif
    vec4 slack = vec4(kSlack * max(abs(box.low.x), abs(box.high.x)));
    return Box(box.low - slack, box.high + slack);
}

// How much of the way from the box's middle to `value` lies in the box.
float part_inside(Box box, vec4 value) {
    if (all(greaterThanEqual(value, box.low)) && all(lessThanEqual(value, box.high))) return 1.0;
    vec4 middle = 0.5 * (box.low + box.high);
    vec4 parts = 0.5 * (box.high - box.low) / max(abs(value - middle), vec4(1e-20));
    return clamp(min(min(parts.x, parts.y), min(parts.z, parts.w)), 0.0, 1.0);
}

// History as the box allows it, and how far it was within.
vec4 held(vec4 history, Box box, float least_weight, out float part) {
    vec4 value = compared(history);
    part = part_inside(box, value);
    if (part == 1.0) return history;
#if REJECTION == REJECTION_CLAMP
    value = clamp(value, box.low, box.high);
#else
    value = mix(0.5 * (box.low + box.high), value, part);
#endif
    return light_of(value, least_weight);
}

#ifdef HAS_LIGHT_CHANGE
// Light that is shifted with its surface's change lags by less, but highlights and hard shadows in what does not scatter lag
// as before: so many frames of history as let that be kLag of the light, and a share of the contrast of the 3 x 3 px, which
// history is there to smooth. Highlights move where scattered light hardly does: on a face beside its brightest part, which
// has no change of its own. So the greatest change within kNearPx counts.
const float kLag = 0.002;
const float kLagOfContrast = 0.01;
const float kNearPx = 18.0;

// The step before averages its light itself, and in its first frames each has less error than those before it: history counts
// as this part of the frames that it has averaged, and less until they are so many. With all of them taa lost 2.6 dB at rest.
const float kPartOfAveraged = 0.25;
const float kSettledFrames = 25.0;
const float kFramesOfContrast = 60.0;  // at a contrast of 1; grows with its square, or noise would pass for contrast

vec3 change_at(vec2 place) { return textureLod(light_change, place * light_change_size.zw, 0.0).rgb; }

float greatest_change(vec3 change) {
    vec3 away = abs(change - 1.0);
    for (int i = 0; i < 8; ++i) {
        float angle = 0.7853982 * float(i);
        vec3 other = change_at(gl_FragCoord.xy + kNearPx * vec2(cos(angle), sin(angle)));
        if (is_light(vec4(other, 1.0))) away = max(away, abs(other - 1.0));
    }
    return max(max(away.r, away.g), away.b);
}

// The standard deviation of the 3 x 3 px as a part of their mean.
float contrast_of(Samples samples) {
    float sum = 0.0, squares = 0.0, count = 1e-20;
    for (int i = 0; i < 9; ++i) {
        float value = samples.usable[i] ? luma(samples.light[i].rgb) : 0.0;
        sum += value;
        squares += value * value;
        count += samples.usable[i] ? 1.0 : 0.0;
    }
    float mean = sum / count;
    return sqrt(max(squares / count - mean * mean, 0.0)) / max(mean, 1e-10);
}

// The most frames of history that count where the picture moved by `motion_px`.
float frames_in_change(Samples samples, vec4 change, vec2 motion_px) {
    // Outlines become smooth by samples that lie elsewhere than in the frame before.
    bool moved = motion_px != vec2(0.0), averages = change.a > 0.0;
    bool smooths = moved || !averages || camera.jitter_px != camera.prev_jitter_px;
    float contrast = smooths ? contrast_of(samples) : 0.0;
    float frames = (kLag + kLagOfContrast * contrast) / max(greatest_change(change.rgb), 1e-6);
    if (!averages) return frames;
    // History between pixels is softer than the frame: behind an average that moves along, a pan lost 3 dB to it.
    float averaged = moved ? 0.0 : kPartOfAveraged * change.a * min(change.a / kSettledFrames, 1.0);
    return min(frames, averaged + kFramesOfContrast * contrast * contrast);
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Samples samples = samples_around(gl_FragCoord.xy);
    vec4 current;
    bool has_current = current_light(samples, current);
    vec4 reprojected = texelFetch(motion, p, 0);
    float frames = reprojected.z, part = 1.0;
    vec4 history = frames > 0.0 ? history_at(gl_FragCoord.xy - reprojected.xy) : current;
#ifdef HAS_LIGHT_CHANGE
    vec4 change = texelFetch(light_change, p, 0);
    if (frames > 0.0 && is_light(change)) {
        history.rgb *= change.rgb;
        frames = min(frames, frames_in_change(samples, change, reprojected.xy));
    }
#endif
#if REJECTION != REJECTION_NONE
    if (has_current && frames > 0.0) {
        float least_weight = weight_of(history);
        for (int i = 0; i < 9; ++i)
            if (samples.usable[i]) least_weight = min(least_weight, weight_of(samples.light[i]));
        history = held(history, box_of(samples, current), least_weight, part);
    }
#endif
    float now = has_current ? weight_of(current) / (frames + 1.0) : 0.0;
    float before = weight_of(history) * frames / (frames + 1.0);
    // Written so that a picture at rest stays as it is, bit for bit.
    vec4 light = history + now / max(now + before, 1e-20) * (current - history);
    out_color = light;
    out_kept = light;
    out_age = has_current ? frames * part + 1.0 : frames;
}
