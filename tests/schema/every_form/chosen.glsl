bool chosen(ivec2 tile) { return texelFetch(marks, tile, 0).g > 0.5; }
