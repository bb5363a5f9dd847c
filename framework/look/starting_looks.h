// Looks that the program ships to start from, and which of them a capture has the roles for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/effect/registry.h"
#include "framework/look/pipeline.h"

namespace aftershade {

struct StartingLook {
    std::filesystem::path file;
    std::string summary;
    std::vector<MissingRole> missing;  ///< of the capture; none: the look fits it

    std::string name() const { return file.stem().string(); }
};

/// The looks of `folder` without faults: those that fit first, each part by name. An absent folder has none.
std::vector<StartingLook> find_starting_looks(const std::filesystem::path& folder, EffectRegistry& effects,
                                              const CaptureHeader& header);

/// Where the shipped ones lie.
inline std::filesystem::path starting_looks_folder(const std::filesystem::path& data) {
    return data / "looks";
}

}  // namespace aftershade
