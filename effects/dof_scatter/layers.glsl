// How many of the capture's layers are spread: the picture and what lies behind it.
#if defined(HAS_FOURTH) && defined(HAS_FOURTH_DEPTH)
const uint kLayers = 4u;
#elif defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
const uint kLayers = 3u;
#elif defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
const uint kLayers = 2u;
#else
const uint kLayers = 1u;
#endif
