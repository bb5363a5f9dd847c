// A capture at another scale, or a part of it.
#pragma once

#include <string>

#include "framework/capture/capture.h"

namespace aftershade {

/// The capture at 1/divisor of its size. Pixels of the display window are taken in blocks of divisor x
/// divisor from its top left: roles that may be filtered are the mean over the block's pixels inside the data
/// window, of the others (depth, ids, vectors) one pixel stands for its block: the one nearest its middle.
/// Velocities are in pixels and shrink along.
void scale_capture(Capture& capture, int divisor);

/// `window` at 1/divisor, as scale_capture scales it.
Window scaled_window(const Window& window, const Window& display, int divisor);

/// The pixels of `window` that the data window covers; the display window stays. Throws
/// Error(ErrorKind::capture) where they have none in common.
void crop_capture(Capture& capture, const Window& window);

/// The display window and what the data window has beyond it.
Window whole_picture(const CaptureHeader& header);

/// That a region reaches beyond the whole picture, in a sentence with both; "" where it does not.
std::string region_fault(const CaptureHeader& header, const Window& region);

/// The intersection of two windows; width or height is 0 or below if it is empty.
Window intersection(const Window& a, const Window& b);

}  // namespace aftershade
