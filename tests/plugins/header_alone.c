/* The header by itself; compiled as C11 and as C++20. */
#include "aftershade_plugin.h"
