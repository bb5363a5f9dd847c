// What is shown, and whether it is there.
#if SHOW == SHOW_VELOCITY || SHOW == SHOW_ARROWS || SHOW == SHOW_TILES
#define SHOWS_VECTORS
#endif

#if SHOW == SHOW_OBJECT_ID
#ifdef HAS_OBJECT_ID
#define HAS_DATA
#endif
#elif defined(HAS_IMAGE)
#define HAS_DATA
#elif defined(SHOWS_VECTORS)
#ifdef HAS_VELOCITY
#define HAS_DATA
#endif
#elif SHOW == SHOW_DEPTH
#ifdef HAS_DEPTH
#define HAS_DATA
#endif
#elif SHOW == SHOW_NORMAL
#ifdef HAS_NORMAL
#define HAS_DATA
#endif
#elif SHOW == SHOW_LIGHT
#ifdef HAS_COLOR
#define HAS_DATA
#endif
#endif

// Bits of `faults`; NaN outweighs infinity, that a value below 0.
const int kNegative = 1, kInfinite = 2, kNan = 4, kNothingHit = 8;
