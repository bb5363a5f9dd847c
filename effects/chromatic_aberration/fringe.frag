#version 450 core
#include <pass>

// The spectrum goes from -1, blue, over 0, green, to 1, red: at a place t > 0 it has t of red and 1 - t of green, at -t as
// much of blue and green. They sum to 1 everywhere, so that white stays white.
float spectral_place(int tap) { return 2.0 * float(tap) / float(param.taps - 1) - 1.0; }

// Of the places above 0: the first, their sum, and the sum of their squares. Loops test at their end, because llvmpipe runs
// the body of others once more, with every pixel masked.
int first_red() { return (param.taps + 1) / 2; }
vec2 red_moments() {
    vec2 sums = vec2(0.0);
    int i = first_red();
    do {
        float place = spectral_place(i);
        sums += vec2(place, place * place);
    } while (++i < param.taps);
    return sums;
}

void main() {
    vec4 own = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    if (param.amount == 0.0) {
        out_color = own;
        return;
    }
    vec2 half_size_px = 0.5 * vec2(frame.display_size);
    vec2 from_centre_px = gl_FragCoord.xy + vec2(frame.origin) - half_size_px;
    float distance_ = length(from_centre_px) / length(half_size_px);
    vec2 red = red_moments();
    // How much larger than green's the picture of the spectrum's place 1 is. The mean place of red is brought to 1, so that
    // `amount` is what is measured between the channels.
    float magnified = param.amount * (red.x / red.y) / length(half_size_px) * pow(distance_, param.falloff - 1.0);
    vec2 centre = (gl_FragCoord.xy - from_centre_px) * color_size.zw, ray = from_centre_px * color_size.zw;
    bool has_middle = (param.taps & 1) == 1;
    vec4 sum = has_middle ? vec4(0.0, own.g, 0.0, own.a) : vec4(0.0);
    int i = first_red();
    do {
        float place = spectral_place(i), larger = place * magnified;
        // What a lens magnifies was nearer to the centre. The bound holds off the pole of absurd amounts.
        vec4 outer = textureLod(color, centre + ray / max(1.0 + larger, 0.1), 0.0);
        vec4 inner = textureLod(color, centre + ray / max(1.0 - larger, 0.1), 0.0);
        sum.r += place * outer.r;
        sum.b += place * inner.b;
        sum.ga += vec2(1.0 - place, 1.0) * (outer.ga + inner.ga);
    } while (++i < param.taps);
    out_color = sum / vec4(red.x, float(param.taps) - 2.0 * red.x, red.x, float(param.taps));
}
