layout(local_size_x = 64) in;  // a row each, in the order of the rows, so that the bits are always the same

bool has_highlight(ivec2 p) {
#ifdef HAS_SENDS
    if (texelFetch(sends, p / 16, 0).r == 0.0) return false;
#endif
    return texelFetch(highlight, p, 0).a != 0.0;
}
