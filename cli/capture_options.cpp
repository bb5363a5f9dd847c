#include "cli/capture_options.h"

#include <algorithm>
#include <iostream>

#include "framework/core/error.h"
#include "framework/image/frame_range.h"

namespace aftershade::cli {

namespace {

void choose_frames(const CaptureOptions& options, Sequence& sequence, Diagnostics& diagnostics) {
    if (options.frames.empty()) return;
    const Place place{"--frames " + options.frames};
    const auto frames = parse_frame_range(options.frames);
    if (!frames) {
        diagnostics.error(place, "not a frame range such as 1-100x2,120");
        return;
    }
    // With a range of its own, the capture says which frames there are; else the files on disk do, when they are read.
    for (const int frame : *frames)
        if (std::find(sequence.frames.begin(), sequence.frames.end(), frame) == sequence.frames.end()) {
            diagnostics.error(place, "the capture has no frame " + std::to_string(frame));
            return;
        }
    sequence.frames = *frames;
}

}  // namespace

void add_capture_argument(CLI::App& app, CaptureOptions& options) {
    app.add_option("capture", options.capture, "capture.json, an EXR file, or a pattern such as frame_####.exr")->required();
}

void add_capture_options(CLI::App& app, CaptureOptions& options, const std::string& frames_help) {
    app.add_option("--frames", options.frames, frames_help);
    app.add_option("--profile", options.profile, "Conventions of the capture's producer (default: the capture's, else auto)");
    app.add_option("--max-size", options.limits.max_side_px, "Refuse images with a side above this, px")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    app.add_option("--max-image-bytes", options.limits.max_image_bytes, "Refuse images of more bytes than this")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
}

std::optional<Sequence> find_sequence(const CaptureOptions& options, const std::vector<Profile>& profiles,
                                      Diagnostics& diagnostics) {
    std::optional<Sequence> sequence;
    try {
        sequence = open_sequence(options.capture, diagnostics);
    } catch (const Error& error) {
        if (!diagnostics.has_errors()) throw;
        diagnostics.error({"CAPTURE"}, error.what());
    }
    if (!sequence) return std::nullopt;
    if (!options.profile.empty()) sequence->profile = options.profile;
    std::vector<std::string> ids{"auto"};
    for (const Profile& profile : profiles) ids.push_back(profile.id);
    if (std::find(ids.begin(), ids.end(), sequence->profile) == ids.end())
        diagnostics.error({options.profile.empty() ? options.capture : "--profile " + options.profile},
                          "no profile '" + sequence->profile + "'" + did_you_mean(sequence->profile, ids) +
                              " (known: " + list_of_names(ids, "and") + ")");
    choose_frames(options, *sequence, diagnostics);
    return sequence;
}

void stop_at_errors(const Diagnostics& diagnostics) {
    if (!diagnostics.has_errors()) return;
    diagnostics.print(std::cerr);
    throw Error(ExitCode::usage, std::to_string(diagnostics.error_count()) +
                                     (diagnostics.error_count() == 1 ? " error" : " errors") + "; nothing was run");
}

}  // namespace aftershade::cli
