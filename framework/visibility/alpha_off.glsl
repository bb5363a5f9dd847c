// Mesa's software GL would run the code of alpha at every triangle.
const bool kHasAlpha = false;
