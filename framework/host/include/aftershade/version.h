// The version of the headers. The version of the library that a program runs with is library_version().
//
// Versions are semantic (docs/library.md). Before 1.0 a new minor version may break programs; it then has
// another soname, so that the loader never mixes them.
#pragma once

#define AFTERSHADE_VERSION_MAJOR 0
#define AFTERSHADE_VERSION_MINOR 1
#define AFTERSHADE_VERSION_PATCH 0

/// For #if: AFTERSHADE_VERSION_AT_LEAST(0, 2, 0)
#define AFTERSHADE_VERSION_AT_LEAST(major, minor, patch)                                              \
    (AFTERSHADE_VERSION_MAJOR * 1000000 + AFTERSHADE_VERSION_MINOR * 1000 + AFTERSHADE_VERSION_PATCH >= \
     (major)*1000000 + (minor)*1000 + (patch))
