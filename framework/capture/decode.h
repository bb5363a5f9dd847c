// From a producer's stored values to the canonical image of a role, and back.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "framework/capture/profile.h"
#include "framework/image/camera.h"
#include "framework/image/image.h"

namespace aftershade {

/// Inputs of a decoding besides the stored values.
struct DecodeContext {
    std::string file;  ///< begins the message of an error
    Window grid;       ///< of the image
    Window display;
    Camera camera;
    const Image* color = nullptr;   ///< RGBA of the same grid, for premultiplied vectors
    int threads = 1;                ///< that may work on the image at a time
    const Image* albedo = nullptr;  ///< of the same grid, as stored, for light times albedo
};

/// Why what the file stores of a role cannot be what its decoding says: a depth or a mask outside of 0 to 1.
/// "" where it can. Without figures, so that a sequence says it once.
std::string range_fault(const std::string& role, const Image& stored, const RoleDecoding& decoding);

/// Depth in m along the view axis; +inf where nothing was hit. Throws Error(ErrorKind::capture) where near
/// and far, or the lens of a radial depth, are needed and not known.
void decode_depth(Image& depth, const RoleDecoding& decoding, const DecodeContext& context = {});

/// Current minus previous (velocity_next: next minus current) position, px, +y down. Returns the row-major
/// indices of the pixels that have no motion data (not finite, or the producer's mark); they are 0.
std::vector<std::size_t> decode_velocity(Image& velocity, const RoleDecoding& decoding,
                                         const DecodeContext& context = {});

/// From light that a surface reflects to light that reaches it, over pi. Both images are as stored, with
/// three channels. An albedo below the floor, or NaN, counts as the floor. Returns how many pixels have light
/// there: the quotient of these is not exact.
std::size_t divide_by_albedo(Image& light, const Image& albedo, float floor);

/// The way back.
void multiply_by_albedo(Image& light, const Image& albedo, float floor);

/// The way back: values whose decoding is the depth, to float precision. +inf becomes the producer's mark for
/// nothing hit. Throws as decode_depth does.
void encode_depth(Image& depth, const RoleDecoding& decoding, const DecodeContext& context = {});

/// The way back. Pixels that had no motion data get the motion that they were filled with.
void encode_velocity(Image& velocity, const RoleDecoding& decoding, const DecodeContext& context = {});

/// Floats as unsigned integers. Throws Error(ErrorKind::capture) naming the first pixel that is not a whole
/// number.
Image decode_ids(const Image& stored, const std::string& file, int threads = 1);

}  // namespace aftershade
