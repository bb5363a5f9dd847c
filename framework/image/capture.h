// One frame in memory: images by role, camera and metadata.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "framework/image/camera.h"
#include "framework/image/exr_file.h"
#include "framework/image/image.h"
#include "framework/image/profile.h"
#include "framework/image/sequence.h"

namespace aftershade {

/// The header of one frame, read before its pixels: what it has, and where.
struct CaptureHeader {
    int frame = 0;
    std::filesystem::path path;
    std::string profile;          ///< id
    std::string profile_reason;   ///< why: "chosen by name", "attribute BlenderMultiChannel"
    Window data_window;
    Window display_window;
    float pixel_aspect = 1;
    std::vector<std::string> roles;     ///< that can be read
    std::vector<std::string> channels;  ///< of the file
    Camera camera;                      ///< capture.json's, completed by the file's metadata
    ExrMetadata metadata;
};

/// One frame. Every image has the size of the data window, the working grid.
struct Capture {
    CaptureHeader header;
    std::map<std::string, Image> images;  ///< by role
};

/// Opens frames of a sequence. [one thread at a time; several readers may work side by side]
class CaptureReader {
public:
    CaptureReader(const Sequence& sequence, std::vector<Profile> profiles, ReadLimits limits);

    /// Throws Error(ExitCode::capture): no such file, not readable, no profile.
    CaptureHeader read_header(int frame) const;
    /// Reads the header and the roles asked for. A role that the file lacks is left out of `images`.
    Capture read(int frame, std::span<const std::string> roles) const;

private:
    struct OpenFrame;
    OpenFrame open(int frame) const;
    const Sequence& sequence_;
    std::vector<Profile> profiles_;
    ReadLimits limits_;
};

}  // namespace aftershade
