// The report of `inspect` on a capture, as text for people and as JSON.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/capture/capture.h"
#include "framework/file/exr_file.h"
#include "framework/inspect/channel_statistics.h"

namespace aftershade::cli {

struct InspectedPart {
    ExrPart header;
    std::vector<InspectedChannel> channels;
    std::vector<SampleCount> sample_counts;  ///< of deep parts that can be read
    PixelSamples at_pixel;                   ///< where one was requested
};

struct Inspection {
    std::filesystem::path file;
    std::vector<InspectedPart> parts;
    bool lists_channels = false;           ///< in the text, also where a profile fits
    std::optional<CaptureHeader> capture;  ///< nullopt where no profile fits
    std::string no_profile_reason;         ///< without the file's name
    std::string no_profile_message;        ///< with it
    ErrorKind no_profile_kind = ErrorKind::capture;
    std::string depth_kind;             ///< "planar, fits position to 0.02 %"; "" where no position shows it
    std::vector<std::string> warnings;  ///< of values that are wrong, in whole sentences
    std::optional<std::array<int, 2>> pixel;  ///< that was requested, in the file's coordinates
    std::vector<CryptomatteLayer> cryptomattes;
    std::string coverage_of;               ///< the Cryptomatte of `coverage`; "" where none was requested
    std::vector<ObjectCoverage> coverage;  ///< of its objects

    /// The fixed roles that the capture lacks; all where no profile fits.
    std::vector<std::string> missing_roles() const;
    /// The producer's settings that write these roles, by role.
    std::map<std::string, std::string> remedies() const;
    /// The first channel that could not be read for a fault of the file; nullptr where all could.
    const InspectedChannel* first_unreadable() const;
};

std::string text_of(const Inspection& inspection);
/// {file, parts, pixel, profile, layer, layers, layer_count, notes, warnings, roles, depth_kind, missing,
/// camera, lights, cryptomattes}, indented, without a line end.
std::string json_of(const Inspection& inspection);

}  // namespace aftershade::cli
