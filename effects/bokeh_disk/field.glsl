// Where the field at hand has its light. What near things hide is of the one behind the focus plane.
#ifdef HAS_BEHIND
#define BEHIND behind
#else
#define BEHIND light
#endif
#if NEAR == 1
#define FIELD light
#else
#define FIELD BEHIND
#endif
