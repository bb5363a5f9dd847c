// What `inspect` shows of a capture, as text for people and as JSON.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/core/error.h"
#include "framework/file/exr_file.h"
#include "framework/inspect/channel_statistics.h"

namespace aftershade::cli {

struct InspectedPart {
    ExrPart header;
    std::vector<InspectedChannel> channels;
};

struct Inspection {
    std::filesystem::path file;
    std::vector<InspectedPart> parts;
    std::optional<CaptureHeader> capture;  ///< nullopt where no profile fits
    std::string no_profile_reason;         ///< without the file's name
    std::string no_profile_message;        ///< with it
    ExitCode no_profile_code = ExitCode::capture;
    std::string depth_kind;  ///< "planar, fits position to 0.02 %"; "" where no position tells it
    std::vector<CryptomatteLayer> cryptomattes;
    std::string coverage_of;               ///< the Cryptomatte of `coverage`; "" where none was asked for
    std::vector<ObjectCoverage> coverage;  ///< of its objects

    /// The fixed roles that the capture lacks; all where no profile fits.
    std::vector<std::string> missing_roles() const;
    /// The first channel that could not be read for a fault of the file; nullptr where all could.
    const InspectedChannel* first_unreadable() const;
};

std::string text_of(const Inspection& inspection);
/// {file, parts, profile, layer, layers, notes, roles, depth_kind, missing, camera, lights, cryptomattes},
/// indented, without a line end.
std::string json_of(const Inspection& inspection);

}  // namespace aftershade::cli
