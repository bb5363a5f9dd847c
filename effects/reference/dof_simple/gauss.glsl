// Binomial weights 1 4 6 4 1 over 16: a Gaussian of standard deviation 1 px.
const int kReach = 2;
const float kWeights[3] = float[](0.375, 0.25, 0.0625);
