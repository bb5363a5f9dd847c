// The error function for x >= 0, within 1.5e-7: Abramowitz and Stegun, Handbook of Mathematical Functions, 7.1.26.
vec3 erf_of(vec3 x) {
    vec3 t = 1.0 / (1.0 + 0.3275911 * x);
    return 1.0 -
        t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))) * exp(-x * x);
}
