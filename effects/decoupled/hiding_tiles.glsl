#include "order.glsl"

bool silhouette_tiles(ivec2 tile) {
#ifdef HAS_SENDS
    if (texelFetch(sends, tile, 0).g == 0.0) return false;
#endif
    return texelFetch(reach, tile, 0).g > 0.0 && texelFetch(behind_order, tile, 0).r > texelFetch(orders, tile, 0).r + kClearPx;
}
