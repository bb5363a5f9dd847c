const uint kStill = 0u, kEven = 1u, kUneven = 2u, kCrowded = 3u, kVeiled = 4u;
