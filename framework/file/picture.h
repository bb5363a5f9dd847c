// Image files that an effect samples as they are, without roles or a capture.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "framework/image/image.h"

namespace aftershade {

/// The meaning of the numbers of a PNG or JPEG. OpenEXR files are linear, and are read unchanged.
enum class PictureSpace { srgb, data };

/// An OpenEXR, PNG or JPEG file, recognised by its first bytes, as RGBA floats. OpenEXR: channels R, G, B and
/// A of the first part over its data window (a missing colour channel is 0, alpha 1), or its luminance. PNG,
/// 8 or 16 bits: srgb is decoded to linear and premultiplied by alpha, as OpenEXR stores it; data is value /
/// maximum, for any colour chunks of the file. JPEG is as a PNG of 8 bits without chunks. For srgb the chunk
/// gAMA counts; an ICC profile, cICP or cHRM that is not sRGB's is refused. Grey becomes three equal
/// channels. Throws Error(ErrorKind::capture) that begins with the path.
Image read_picture(const std::filesystem::path& path, PictureSpace space);

/// The bytes of a PNG or JPEG, with the numbers as they are stored, over their maximum; 1 to 4 channels. What
/// the file says of its colours is left out. Throws Error(ErrorKind::capture) that begins with `name`.
Image decode_picture(const std::string& name, std::string_view bytes);

}  // namespace aftershade
