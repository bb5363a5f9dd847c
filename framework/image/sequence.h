// Which frames there are, where they lie and how they are read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/image/camera.h"
#include "framework/image/frame_range.h"

namespace aftershade {

/// Ordered captures. Made from a capture.json, a bare EXR file, or a pattern of files.
struct Sequence {
    std::vector<int> frames;       ///< in the order to be run
    FramePattern files{""};        ///< absolute, or relative to the working directory
    std::string profile = "auto";
    double fps = 24;
    Camera camera;                 ///< of capture.json
    std::vector<int> cuts;         ///< frames that begin a shot

    std::filesystem::path path_of(int frame) const { return files.path(frame); }
};

/// `argument` is CAPTURE of the command line. Faults of capture.json go to `diagnostics`; a file or pattern that matches
/// nothing is Error(ExitCode::capture).
std::optional<Sequence> open_sequence(const std::string& argument, Diagnostics& diagnostics);

/// Frames that exist for a pattern, sorted.
std::vector<int> find_frames(const FramePattern& pattern);

}  // namespace aftershade
