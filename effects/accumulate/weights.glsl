const float kPi = 3.14159265358979;

// Weight of sub-frame `index` of `count`, in the middle of its part of the exposure, over the sum of its own and of all weights
// before it. The sums are closed forms, so that no sub-frame has to count those before.
float share(int index, int count) {
    float n = float(count), i = float(index);
#if SHAPE == SHAPE_BOX
    return 1.0 / (i + 1.0);
#elif SHAPE == SHAPE_TRIANGLE
    // Times n: 1, 3, 5, ... up to the middle, whose sums are squares, and the same down again.
    float left = n - i - 1.0;
    float weight = n - abs(2.0 * i + 1.0 - n);
    float whole = floor(0.5 * n * n + 0.5);
    return weight / (2 * index + 1 <= count ? (i + 1.0) * (i + 1.0) : whole - left * left);
#else
    // sin(x) + sin(3 x) + ... of k terms = sin(k x)^2 / sin(x)
    float x = 0.5 * kPi / n;
    float root = sin((i + 1.0) * x);
    return sin((2.0 * i + 1.0) * x) * sin(x) / (root * root);
#endif
}
