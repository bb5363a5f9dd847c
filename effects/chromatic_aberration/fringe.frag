#version 450 core
#include <pass>

// Red, green and blue of a place in the spectrum from -1 (blue) to 1 (red). They sum to 1 everywhere, so that white stays
// white.
vec3 spectrum(float t) { return vec3(max(t, 0.0), 1.0 - abs(t), max(-t, 0.0)); }

float spectral_place(int tap) { return 2.0 * float(tap) / float(param.taps - 1) - 1.0; }

// Brings the mean place of red to 1 and of blue to -1, so that `amount` is what is measured between the channels.
float spread() {
    float sum = 0.0, moment = 0.0;
    for (int i = 0; i < param.taps; ++i) {
        float red = spectrum(spectral_place(i)).r;
        sum += red;
        moment += red * spectral_place(i);
    }
    return sum / moment;
}

void main() {
    if (param.amount == 0.0) {
        out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
        return;
    }
    vec2 half_size_px = 0.5 * vec2(frame.display_size);
    vec2 from_centre_px = gl_FragCoord.xy + vec2(frame.origin) - half_size_px;
    float distance_ = length(from_centre_px) / length(half_size_px);
    // How much larger than green's the picture of the spectrum's place 1 is.
    float magnified = param.amount * spread() / length(half_size_px) * pow(distance_, param.falloff - 1.0);
    vec4 sum = vec4(0.0), weights = vec4(0.0);
    for (int i = 0; i < param.taps; ++i) {
        float place = spectral_place(i);
        vec4 weight = vec4(spectrum(place), 1.0);
        // What a lens magnifies was nearer to the centre. The bound holds off the pole of absurd amounts.
        vec2 source_px = from_centre_px / max(1.0 + place * magnified, 0.1);
        sum += weight * textureLod(color, (gl_FragCoord.xy + source_px - from_centre_px) * color_size.zw, 0.0);
        weights += weight;
    }
    out_color = sum / weights;
}
