// History between two runs: so that a sequence cut into chunks continues exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/graph/executor.h"
#include "framework/image/camera.h"
#include "framework/image/image.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// One texture or buffer that survives a frame. Texels are numbers as a shader fetches them, 4 bytes each:
/// floats, or integers where the format is of integers; every level, and of a level every layer.
struct SavedResource {
    gpu::TextureDesc desc;  ///< width 0: a buffer
    std::vector<std::byte> bytes;
};

/// The file is one line "aftershade-history 1", one line of JSON that describes what follows, and the bytes
/// of the resources, little-endian, in the order of that description; a checksum guards against damage.
struct SavedHistory {
    std::filesystem::path path;  ///< that it was read from
    std::string look;            ///< history_identity() of its pipeline
    std::string fingerprint;     ///< of the last frame (framework/run/fingerprint.h); "" where unknown
    int frame = 0;               ///< the last one rendered
    Window window;               ///< its data window
    Camera camera;
    std::map<std::string, SavedResource> resources;  ///< by name: "taa.accumulated"

    void take_from(const graph::Executor::History& history);
    /// The name of a resource that this lacks or has with another description; "" if none.
    std::string give_to(const graph::Executor::History& history) const;
};

/// Facts that a history depends on besides its frames, one line each: steps, effects with versions, wiring,
/// values.
std::string history_identity(const Pipeline& pipeline);
/// The first line in which two identities differ, for messages.
std::string difference_of_identities(const std::string& saved, const std::string& now);

/// Throws Error(ErrorKind::output). The file appears by rename.
void write_history(const std::filesystem::path& path, const SavedHistory& history);
/// Throws Error(ErrorKind::usage): no such file, none of ours, damaged.
SavedHistory read_history(const std::filesystem::path& path);

/// "1920x1080 at (0, 0)".
std::string window_text(const Window& window);

}  // namespace aftershade
