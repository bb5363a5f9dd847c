#include "cli/capture_options.h"

#include <algorithm>
#include <iostream>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/slip_hints.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/capture.h"
#include "framework/capture/capture_grammar.h"
#include "framework/capture/frame_range.h"
#include "framework/image/color_space.h"

namespace aftershade::cli {

namespace {

void choose_frames(const CaptureOptions& options, Sequence& sequence, Diagnostics& diagnostics) {
    if (options.frames.empty()) return;
    const Place place{"--frames " + options.frames};
    const auto frames = parse_frame_range(options.frames);
    if (!frames) {
        diagnostics.error(place, frame_range_fault(options.frames));
        return;
    }
    // A capture with a range says which frames there are; else the disk does, when they are read.
    for (const int frame : sequence.frames_declared ? *frames : std::vector<int>{})
        if (std::find(sequence.frames.begin(), sequence.frames.end(), frame) == sequence.frames.end()) {
            diagnostics.error(place, "the capture has no frame " + std::to_string(frame));
            return;
        }
    sequence.frames = *frames;
}

void choose_color_space(const CaptureOptions& options, Sequence& sequence, Diagnostics& diagnostics) {
    if (options.color_space.empty()) return;
    std::vector<std::string> names = color_space_names();
    names.insert(names.begin(), "auto");
    if (std::find(names.begin(), names.end(), options.color_space) == names.end())
        diagnostics.error({"--color-space " + options.color_space},
                          "must be " + list_of_names(names) + did_you_mean(options.color_space, names));
    else sequence.color_space = options.color_space;
}

}  // namespace

CLI::Option* add_capture_argument(CLI::App& app, CaptureOptions& options) {
    return app
        .add_option("capture", options.capture,
                    "capture.json, an EXR file, a pattern such as frame_####.exr, or a folder")
        ->required();
}

void add_capture_options(CLI::App& app, CaptureOptions& options, const std::string& frames_help) {
    app.add_option("--frames", options.frames, frames_help);
    app.add_option("--profile", options.profile,
                   "Conventions of the capture's producer (default: as the capture declares, else auto)");
    app.add_option("--profile-path", options.profile_paths,
                   "Search this folder for profiles before the shipped ones; repeatable")
        ->allow_extra_args(false);
    app.add_option("--role", options.role_files,
                   "ROLE=FILE: read a role from its own file or pattern; repeatable")
        ->allow_extra_args(false);
    app.add_option("--view", options.view, "View of a multi-view file (default: the first)");
    app.add_option("--layer", options.layer,
                   "Layer of a file with several, such as a Blender view layer (default: the first)");
    app.add_option("--alpha", options.alpha,
                   "keep the alpha of color, or set it to opaque where the stored one is meaningless "
                   "(default: as the capture declares)")
        ->check(CLI::IsMember(alpha_names()));
    app.add_option("--color-space", options.color_space,
                   "Primaries of the stored colours: auto, rec709, acescg, ap0, rec2020 or p3d65");
    app.add_option("--max-size", options.limits.max_side_px,
                   "Refuse images with a side longer than this, in px")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    app.add_option("--max-image-bytes", options.limits.max_image_bytes,
                   "Refuse images larger than this, in bytes")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
}

std::vector<Profile> load_profiles(const std::vector<std::string>& profile_paths, Diagnostics& diagnostics) {
    std::vector<std::filesystem::path> folders(profile_paths.begin(), profile_paths.end());
    folders.push_back(data_path() / "profiles");
    return read_profiles(folders, diagnostics);
}

std::optional<Sequence> find_sequence(const CaptureOptions& options, const std::vector<Profile>& profiles,
                                      Diagnostics& diagnostics) {
    std::error_code unreadable;
    if (options.capture.find('*') != std::string::npos &&
        !std::filesystem::exists(options.capture, unreadable)) {
        diagnostics.error({options.capture},
                          "a sequence is written with # for each digit of its frames, not with *: '" +
                              frame_pattern(options.capture) + "'");
        return std::nullopt;
    }
    std::optional<Sequence> sequence;
    try {
        sequence = open_sequence(options.capture, diagnostics);
    } catch (const Error& error) {
        if (!diagnostics.has_errors()) throw;
        diagnostics.error({"CAPTURE"}, error.what());
    }
    if (!sequence) return std::nullopt;
    if (!options.profile.empty()) sequence->profile = options.profile;
    if (!options.view.empty()) sequence->view = options.view;
    if (!options.layer.empty()) sequence->layer = options.layer;
    if (!options.alpha.empty()) sequence->alpha_is_opaque = options.alpha == kOpaqueAlpha;
    for (const std::string& text : options.role_files) add_role_file(*sequence, text, diagnostics);
    choose_color_space(options, *sequence, diagnostics);
    std::vector<std::string> ids{"auto"};
    for (const Profile& profile : profiles) ids.push_back(profile.id);
    if (std::find(ids.begin(), ids.end(), sequence->profile) == ids.end())
        diagnostics.error({options.profile.empty() ? options.capture : "--profile " + options.profile},
                          "no profile '" + sequence->profile + "'" + did_you_mean(sequence->profile, ids) +
                              " (known: " + list_of_names(ids, "and") + ")");
    choose_frames(options, *sequence, diagnostics);
    return sequence;
}

void print_differences(const CaptureHeader& header) {
    for (const std::string& difference : header.differences)
        std::cerr << "aftershade: warning: " << printable(header.path.string() + ": " + difference) << "\n";
}

void stop_at_errors(const Diagnostics& diagnostics, bool refuses_report) {
    if (!diagnostics.has_errors()) return;
    diagnostics.print(std::cerr);
    std::ostringstream faults;
    diagnostics.print(faults);
    throw FaultyDocuments(counted(std::size_t(diagnostics.error_count()), "error") + "; nothing was run",
                          faults.str(), refuses_report);
}

namespace {

/// "2nd", "3rd", "12th".
std::string ordinal(int number) {
    const int last = number / 10 % 10 == 1 ? 0 : number % 10;
    return std::to_string(number) + (last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th");
}

}  // namespace

void add_missing_frames(const CaptureOptions& options, MissingFrame missing, Sequence& sequence,
                        Diagnostics& diagnostics) {
    if (sequence.frames_declared || !options.frames.empty() || sequence.frames.empty()) return;
    const Place place{options.capture};
    const FrameGaps gaps = find_gaps(sequence.frames);
    const std::string range =
        std::to_string(sequence.frames.front()) + "-" + std::to_string(sequence.frames.back());
    if (gaps.step > 1)
        diagnostics.warning(place, "only every " + ordinal(gaps.step) + " frame of " + range +
                                       " is there; the sequence is taken to have that step (--frames " +
                                       range + " runs all frames)");
    if (gaps.count == 0) return;
    if (gaps.whole.empty()) {
        const std::string text = std::to_string(gaps.count) + " frames of " + range + " are missing";
        if (missing == MissingFrame::skip) diagnostics.warning(place, text + "; they are left out");
        else diagnostics.error(place, text + "; choose frames with --frames");
        return;
    }
    if (missing == MissingFrame::error)
        diagnostics.warning(place, (gaps.count == 1 ? "frame " : "frames ") +
                                       format_frame_range(gaps.missing) + " of " + range +
                                       (gaps.count == 1 ? " is" : " are") +
                                       " missing (--missing skip leaves such frames out, --missing hold "
                                       "repeats the one before)");
    sequence.frames = gaps.whole;
}

}  // namespace aftershade::cli
