// Marks the symbols that the shared library exports; it hides all others.
#pragma once

#define AFTERSHADE_API __attribute__((visibility("default")))
#define AFTERSHADE_LOCAL __attribute__((visibility("hidden")))
