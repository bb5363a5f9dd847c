const bool kHasAlpha = true;  // of triangles or textures
