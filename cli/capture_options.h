// CAPTURE, --frames, --profile and the limits, shared by every verb that reads a capture.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/cli11.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "framework/file/exr_file.h"
#include "framework/run/run_options.h"

namespace aftershade {
struct CaptureHeader;
}  // namespace aftershade

namespace aftershade::cli {

struct CaptureOptions {
    std::string capture;
    std::string frames;                      ///< "" for the capture's own
    std::string profile;                     ///< "" for the capture's own
    std::vector<std::string> profile_paths;  ///< folders, searched before the shipped profiles
    std::vector<std::string> role_files;     ///< "depth=z.####.exr"
    std::string alpha;                       ///< "" for the capture's own
    std::string view;                        ///< "" for the capture's own
    std::string layer;                       ///< "" for the capture's own
    std::string color_space;                 ///< "" for the capture's own
    ReadLimits limits;
};

/// The argument CAPTURE; add it where it belongs in the order of the verb's arguments.
CLI::Option* add_capture_argument(CLI::App& app, CaptureOptions& options);
/// --frames (what they are for is the verb's), --profile, --profile-path, --role, --view, --layer,
/// --color-space and the limits.
void add_capture_options(CLI::App& app, CaptureOptions& options, const std::string& frames_help);

/// The profiles of --profile-path and the shipped ones.
std::vector<Profile> load_profiles(const std::vector<std::string>& profile_paths, Diagnostics& diagnostics);

/// nullopt after a fault in capture.json, or after frames were not found while the user has other faults to
/// fix.
std::optional<Sequence> find_sequence(const CaptureOptions& options, const std::vector<Profile>& profiles,
                                      Diagnostics& diagnostics);

/// A warning for each of CaptureHeader::differences, to standard error.
void print_differences(const CaptureHeader& header);

/// Its message counts the faults, which have been printed.
struct FaultyDocuments : Error {
    FaultyDocuments(const std::string& message, std::string faults, bool report)
        : Error(ErrorKind::usage, message), details(std::move(faults)), refuses_report(report) {}
    std::string details;          ///< a line for each fault
    bool refuses_report = false;  ///< the name of --report is at fault: nothing may be written to it
};

/// Throws FaultyDocuments with every fault collected so far.
void stop_at_errors(const Diagnostics& diagnostics, bool refuses_report = false);

/// Where the frames are what lies on disk, not what the user named: adds those that are missing in between,
/// so that `missing` decides on them, and says which they are where that makes them failures.
void add_missing_frames(const CaptureOptions& options, MissingFrame missing, Sequence& sequence,
                        Diagnostics& diagnostics);

}  // namespace aftershade::cli
