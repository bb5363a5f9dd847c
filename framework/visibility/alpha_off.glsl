const bool kHasAlpha = false;  // Mesa's software GL would run through what that needs at every triangle.
