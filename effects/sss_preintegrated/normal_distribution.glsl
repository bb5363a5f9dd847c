// The normal distribution: its density, and where its distribution function is p, 0 < p < 1.
float normal_density(float x) { return 0.39894228 * exp(-0.5 * x * x); }

// Giles 2010, Approximating the erfinv function, GPU Computing Gems Jade: relative error below 4e-7 in single precision. Of
// the smaller tail, since 1 - p keeps no digits there.
float normal_quantile(float p) {
    float tail = min(p, 1.0 - p), x = 1.0 - 2.0 * tail;
    float w = -log(4.0 * tail * (1.0 - tail)), q;
    if (w < 5.0) {
        w -= 2.5;
        q = 2.81022636e-08;
        q = 3.43273939e-07 + q * w;
        q = -3.5233877e-06 + q * w;
        q = -4.39150654e-06 + q * w;
        q = 0.00021858087 + q * w;
        q = -0.00125372503 + q * w;
        q = -0.00417768164 + q * w;
        q = 0.246640727 + q * w;
        q = 1.50140941 + q * w;
    } else {
        w = sqrt(w) - 3.0;
        q = -0.000200214257;
        q = 0.000100950558 + q * w;
        q = 0.00134934322 + q * w;
        q = -0.00367342844 + q * w;
        q = 0.00573950773 + q * w;
        q = -0.0076224613 + q * w;
        q = 0.00943887047 + q * w;
        q = 1.00167406 + q * w;
        q = 2.83297682 + q * w;
    }
    float deviations = 1.41421356 * q * x;
    return p < 0.5 ? -deviations : deviations;
}
