#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/capture_options.h"
#include "cli/check_velocity.h"
#include "cli/inspect_report.h"
#include "cli/inspect_sheet.h"
#include "cli/verbs.h"
#include "framework/base/cores.h"
#include "framework/base/data_path.h"
#include "framework/base/input_files.h"
#include "framework/capture/sample_means.h"
#include "framework/file/png_file.h"
#include "framework/image/role.h"
#include "framework/inspect/channel_statistics.h"
#include "framework/inspect/contact_sheet.h"
#include "framework/inspect/depth_kind.h"
#include "framework/inspect/role_faults.h"

namespace aftershade::cli {

namespace {

struct InspectOptions {
    CaptureOptions capture;
    std::string contact_sheet;
    int columns = 0;  ///< of a contact sheet of frames; 0: as many as fit
    std::vector<std::string> check_velocity;
    std::optional<std::string> cryptomatte;
    std::vector<int> pixel;  ///< x and y; empty: none
    bool json = false, channels = false;
};

void check_options(const InspectOptions& options, const std::optional<Sequence>& sequence,
                   Diagnostics& diagnostics) {
    if (!options.contact_sheet.empty() && !options.contact_sheet.ends_with(".png"))
        diagnostics.error({"--contact-sheet " + options.contact_sheet}, "a contact sheet is a .png file");
    if (options.columns > 0 && options.contact_sheet.empty())
        diagnostics.error({"--columns"}, "is for a contact sheet of frames; add --contact-sheet FILE.png");
    if (sequence && !options.capture.frames.empty() && sequence->frames.size() > 1 &&
        options.contact_sheet.empty())
        diagnostics.error({"--frames " + options.capture.frames},
                          std::to_string(sequence->frames.size()) +
                              " frames; inspect shows one; --contact-sheet shows several");
}

/// Whether the contact sheet has frames rather than the roles of one frame.
bool wants_frames(const InspectOptions& options, const Sequence& sequence) {
    const bool has_pictures = sequence.path_of(0).extension() == ".png";
    return !options.contact_sheet.empty() &&
           (has_pictures || options.columns > 0 ||
            (sequence.frames.size() > 1 && !options.capture.frames.empty()));
}

std::string without_path(const std::string& message, const std::filesystem::path& path) {
    const std::string prefix = path.string() + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

InspectedPart inspect_part(const ExrFile& file, int index, const InspectOptions& options) {
    InspectedPart part{
        file.parts()[std::size_t(index)], inspect_channels(file, index, options.capture.limits), {}, {}};
    const bool readable = std::ranges::all_of(part.channels, &InspectedChannel::readable);
    if (readable && part.header.is_deep()) part.sample_counts = sample_histogram(file, index);
    if (readable && !options.pixel.empty())
        part.at_pixel = samples_at(file, index, options.pixel[0], options.pixel[1]);
    return part;
}

/// Throws Error(ErrorKind::capture) where the frame's file, or that of one of its roles, cannot be opened.
Inspection inspect_frame(const Sequence& sequence, int frame, const CaptureReader& reader,
                         const InspectOptions& options) {
    const ReadLimits& limits = options.capture.limits;
    Inspection inspection;
    inspection.file = sequence.path_of(frame);
    if (!options.pixel.empty()) inspection.pixel = {options.pixel[0], options.pixel[1]};
    const ExrFile file(inspection.file, limits);
    for (const auto& [role, pattern] : sequence.role_files) ExrFile(pattern.path(frame), limits);
    for (std::size_t i = 0; i < file.parts().size(); ++i)
        inspection.parts.push_back(inspect_part(file, int(i), options));
    try {
        inspection.capture = reader.read_header(frame);
        for (const std::string& difference : inspection.capture->differences)
            inspection.capture->warnings.push_back(difference);
        inspection.cryptomattes = reader.cryptomattes(frame);
    } catch (const Error& error) {
        // The files are sound, but what they mean is not known: no profile, several, no such view; or of the
        // profile all but a Cryptomatte's manifest.
        if (inspection.capture) inspection.warnings.emplace_back(error.what());
        inspection.no_profile_kind = error.kind();
        inspection.no_profile_message = error.what();
        inspection.no_profile_reason = without_path(error.what(), inspection.file);
    }
    return inspection;
}

/// A depth in mid air at its edges, of which no profile and no capture.json says that it is averaged.
void note_averaged_depth(const Image& depth, Inspection& inspection) {
    const DepthEdges edges = find_depth_edges(depth);
    if (!edges.are_of_means()) return;
    inspection.capture->notes.push_back(fmt::format(
        "the depth is averaged over samples: at {} of {} edges pixels have a depth between the two "
        "surfaces; set \"sampling\": \"mean\" next to the depth's channels in capture.json to repair them",
        edges.mixed, edges.mixed + edges.sharp));
}

/// What becomes of deep samples, as many layers as there may be.
void note_deep_reduction(const CaptureReader& reader, Inspection& inspection) {
    if (!inspection.capture || inspection.capture->layer_roles.empty()) return;
    try {
        const std::vector<RoleId> roles = {inspection.capture->layer_roles.back()};
        const Capture capture = reader.read(inspection.capture->frame, roles);
        if (capture.deep) inspection.capture->notes.push_back(capture.deep->text(capture.deep_layers));
    } catch (const Error&) {
        // Said where the channels are listed, or by whoever needs the role.
    }
}

/// What the stored values of the roles' channels show: NaN, and halves that overflowed.
void warn_of_stored_values(Inspection& inspection) {
    if (!inspection.capture) return;
    for (const auto& [role, names] : inspection.capture->role_channels) {
        const RoleKind kind = kind_of_role(role);
        for (const InspectedPart& part : inspection.parts)
            for (const auto& [channel, statistics, reason, readable] : part.channels) {
                if (!statistics || std::ranges::find(names, channel.name) == names.end()) continue;
                if (statistics->nan > 0)
                    inspection.warnings.push_back(
                        fmt::format("{} (role '{}') has {} NaN{}; run --on-nan fail leaves such frames out",
                                    channel.name, role, statistics->nan,
                                    kind == RoleKind::distance ? ", read as no hit"
                                    : kind == RoleKind::motion ? ", read as no motion data"
                                                               : ""));
                if (kind == RoleKind::distance && channel.type == PixelType::half && statistics->infinite > 0)
                    inspection.warnings.push_back(
                        fmt::format("{} (role '{}') is half and has {} infinite values: a half ends at "
                                    "65504, so far depth "
                                    "and marks such as 1e10 look like no hit; have the producer write float",
                                    channel.name, role, statistics->infinite));
            }
    }
}

void add_warning(std::string warning, Inspection& inspection) {
    if (!warning.empty()) inspection.warnings.push_back(std::move(warning));
}

/// Roles that other channels could give, too: their pixels say whether it matters.
void warn_of_other_channels(const CaptureReader& reader, Inspection& inspection) {
    if (!inspection.capture || inspection.capture->other_channels.empty()) return;
    std::vector<std::string> roles;
    for (const auto& [role, others] : inspection.capture->other_channels) roles.push_back(role);
    try {
        for (const std::string& warning : reader.read(inspection.capture->frame, roles).header.warnings)
            if (std::ranges::find(inspection.capture->warnings, warning) ==
                inspection.capture->warnings.end())
                inspection.capture->warnings.push_back(warning);
    } catch (const Error&) {
        // Said where the channels are listed, or by whoever needs the roles.
    }
}

void warn_of_normals(const CaptureReader& reader, Inspection& inspection) {
    if (!inspection.capture) return;
    for (const std::string& role : inspection.capture->roles) {
        if (kind_of_role(role) != RoleKind::direction) continue;
        try {
            const Capture capture = reader.read(inspection.capture->frame, std::vector{role});
            add_warning(find_normal_fault(capture.images.at(role)), inspection);
        } catch (const Error&) {
            // Said where the role's channels are listed, or by whoever needs the role.
        }
    }
}

/// Whether the depth is one of the position's channels, which then shows nothing of it.
bool is_of_position(const CaptureHeader& capture, const std::string& depth, const std::string& position) {
    const auto of_depth = capture.role_channels.find(depth),
               of_position = capture.role_channels.find(position);
    if (of_depth == capture.role_channels.end() || of_position == capture.role_channels.end()) return false;
    return std::ranges::find_first_of(of_depth->second, of_position->second) != of_depth->second.end();
}

/// The depth as the profile decodes it, held to its own edges and to the positions of its pixels.
void find_depth_kind_of(const CaptureReader& reader, Inspection& inspection) {
    if (!inspection.capture) return;
    std::string depth, position;
    for (const std::string& role : inspection.capture->roles) {
        if (kind_of_role(role) == RoleKind::distance) depth = role;
        if (kind_of_role(role) == RoleKind::place) position = role;
    }
    if (depth.empty()) return;
    std::vector<std::string> roles = {depth};
    if (!position.empty()) roles.push_back(position);
    try {
        const Capture capture = reader.read(inspection.capture->frame, roles);
        note_averaged_depth(capture.images.at(depth), inspection);
        for (const std::string& warning : capture.header.warnings)
            if (std::ranges::find(inspection.capture->warnings, warning) ==
                inspection.capture->warnings.end())
                add_warning(warning, inspection);
        if (position.empty() || is_of_position(*inspection.capture, depth, position)) return;
        const Image& positions = capture.images.at(position);
        add_warning(find_position_fault(capture.images.at(depth), positions, inspection.capture->camera),
                    inspection);
        const DepthKind kind = find_depth_kind(capture.images.at(depth), positions);
        inspection.depth_kind = kind.text();
        if (kind.verdict() == DepthKind::Verdict::radial)
            inspection.depth_kind += "; declare it in the profile or capture.json: \"kind\": \"radial\"";
    } catch (const Error&) {
        // Said where the role's channels are listed, or by whoever needs the role.
    }
}

/// The files are shown, but what the user asked of them is not there: a layer, a view, the role of a file.
void require_what_was_asked(const Sequence& sequence, const Inspection& inspection) {
    const bool asks = !sequence.layer.empty() || !sequence.view.empty() || !sequence.role_files.empty();
    if (!inspection.capture && asks) throw Error(inspection.no_profile_kind, inspection.no_profile_message);
}

/// "" is the only Cryptomatte, or the one of objects.
void add_coverage(const std::string& name, const CaptureReader& reader, Inspection& inspection) {
    if (!inspection.no_profile_message.empty())
        throw Error(inspection.no_profile_kind, inspection.no_profile_message);
    if (inspection.cryptomattes.empty())
        throw Error(ErrorKind::capture, inspection.file.string() + ": has no Cryptomatte");
    const int frame = inspection.capture->frame;
    inspection.coverage_of = reader.cryptomatte_name(frame, name);
    inspection.coverage = reader.cryptomatte_coverage(frame, inspection.coverage_of);
}

/// One role that cannot be decoded does not hide the others.
Capture read_role_by_role(const CaptureHeader& header, const CaptureReader& reader,
                          std::map<std::string, std::string>& unreadable) {
    Capture capture;
    capture.header = header;
    for (const std::string& role : header.roles) {
        try {
            capture.images.merge(reader.read(header.frame, std::vector{role}).images);
        } catch (const Error& error) {
            unreadable[role] = without_path(error.what(), header.path);
        }
    }
    return capture;
}

void write_contact_sheet(const std::string& path, const CaptureHeader& header, const CaptureReader& reader) {
    Capture capture;
    std::map<std::string, std::string> unreadable;
    std::vector<RoleId> roles = role_ids(header.roles);
    roles.insert(roles.end(), header.layer_roles.begin(), header.layer_roles.end());
    try {
        capture = reader.read(header.frame, roles);
    } catch (const Error&) {
        capture = read_role_by_role(header, reader, unreadable);
    }
    if (capture.images.empty() && unreadable.empty())
        throw Error(ErrorKind::capture,
                    header.path.string() + ": has no role, so there is nothing to put on a contact sheet");
    write_png(path, draw_contact_sheet(capture, unreadable));
}

ExitCode inspect(const InspectOptions& options) {
    Diagnostics diagnostics;
    std::vector<Profile> profiles = load_profiles(options.capture.profile_paths, diagnostics);
    const std::optional<Sequence> sequence = find_sequence(options.capture, profiles, diagnostics);
    check_options(options, sequence, diagnostics);
    InputFiles inputs;
    inputs.add(diagnostics.documents());
    if (sequence) inputs.add(files_of_sequence(*sequence));
    inputs.check_output({"--contact-sheet " + options.contact_sheet}, options.contact_sheet, diagnostics);
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);

    set_exr_threads(allotted_cores());
    const CaptureReader reader(*sequence, std::move(profiles), options.capture.limits);
    if (wants_frames(options, *sequence))
        return write_frame_sheet(options.contact_sheet, options.columns, *sequence, reader);
    Inspection inspection =
        inspect_frame(*sequence, sequence->file_number(sequence->frames.front()), reader, options);
    inspection.lists_channels = options.channels;
    note_deep_reduction(reader, inspection);
    warn_of_stored_values(inspection);
    warn_of_other_channels(reader, inspection);
    warn_of_normals(reader, inspection);
    find_depth_kind_of(reader, inspection);
    if (options.cryptomatte) add_coverage(*options.cryptomatte, reader, inspection);
    std::cout << (options.json ? json_of(inspection) + "\n" : text_of(inspection)) << std::flush;
    const std::string file = inspection.file.string() + ": ";
    if (const InspectedChannel* channel = inspection.first_unreadable())
        throw Error(ErrorKind::capture, file + channel->reason);
    require_what_was_asked(*sequence, inspection);
    if (options.contact_sheet.empty()) return ExitCode::done;
    if (!inspection.capture)
        throw Error(ErrorKind::capture,
                    file + inspection.no_profile_reason + ", so there is no role for a contact sheet");
    write_contact_sheet(options.contact_sheet, *inspection.capture, reader);
    std::cerr << "contact sheet: " << options.contact_sheet << "\n";
    return ExitCode::done;
}

}  // namespace

Verb add_inspect(CLI::App& app) {
    auto options = std::make_shared<InspectOptions>();
    CLI::Option* capture = add_capture_argument(app, options->capture);
    CLI::Option* check = app.add_option(
        "--check-velocity", options->check_velocity,
        "Check the motion vectors of two consecutive frames against the profile; exits 1 on a mismatch");
    check->expected(2)->type_name("A B");
    capture->required(false)->excludes(check);
    add_capture_options(app, options->capture,
                        "The frame to show (default: the first), or the frames of a contact sheet");
    app.add_flag("--channels", options->channels,
                 "List the channels of each part, with their types and their smallest and largest values");
    app.add_flag("--json", options->json, "Print JSON");
    app.add_option(
           "--cryptomatte", options->cryptomatte,
           "List the objects of this Cryptomatte by coverage (without a name: of the Cryptomatte of objects)")
        ->expected(0, 1);
    app.add_option("--pixel", options->pixel,
                   "List what the file stores at this pixel: every sample of a deep one")
        ->expected(2)
        ->delimiter(',')
        ->type_name("X,Y");
    app.add_option("--contact-sheet", options->contact_sheet,
                   "Write all roles in false colour to this .png; for several frames or PNG files, "
                   "thumbnails of the colour");
    app.add_option("--columns", options->columns,
                   "Number of columns of a contact sheet of frames (default: as many as fit); shows all "
                   "frames unless --frames is given")
        ->check(CLI::Range(1, kMostSheetFrames));
    return [options] {
        if (!options->check_velocity.empty())
            return check_velocity_of_files(options->check_velocity, options->capture, options->json);
        if (options->capture.capture.empty())
            throw Error(ErrorKind::usage, "inspect: name a capture, or two files with --check-velocity");
        return inspect(*options);
    };
}

}  // namespace aftershade::cli
