// Moving images between windows.
#pragma once

#include "framework/image/image.h"

namespace aftershade {

/// The pixels of `to`, out of an image that covers `from`; float pixels that it does not cover are `outside`,
/// ids 0. Returns the image itself where the windows are equal.
Image place_in_window(Image image, const Window& from, const Window& to, float outside);

}  // namespace aftershade
