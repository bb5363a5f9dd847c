// Roles in files of their own, checked against the file of the colour.
#pragma once

#include <string>
#include <vector>

namespace aftershade {

class FrameFile;

/// A file of other windows covers another part of the picture only where it says so: by the main file's
/// display window around its own data window. Else its pixels belong to a picture of another size. Throws
/// Error(ErrorKind::capture).
void require_one_picture(const std::string& role, const FrameFile& file, const FrameFile& main);

/// Signs that the pixels may be those of another picture of this size: another shape of pixels, display
/// window, view or camera. In whole sentences.
std::vector<std::string> role_file_faults(const std::string& role, const FrameFile& file,
                                          const FrameFile& main);

}  // namespace aftershade
