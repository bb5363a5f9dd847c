// What the shared library exports; every other symbol of it is hidden.
#pragma once

#define AFTERSHADE_API __attribute__((visibility("default")))
#define AFTERSHADE_LOCAL __attribute__((visibility("hidden")))
