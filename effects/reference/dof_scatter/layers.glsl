// How many layers of the capture are spread: the picture and those behind it.
uint layer_count() {
    uint count = 1u;
#ifdef HAS_SECOND
    count += uint(textureSize(second, 0).x > 0);
#endif
#ifdef HAS_THIRD
    count += uint(textureSize(third, 0).x > 0);
#endif
#ifdef HAS_FOURTH
    count += uint(textureSize(fourth, 0).x > 0);
#endif
    return count;
}
