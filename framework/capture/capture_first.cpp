// What the first frame of a capture decides for all of them.
#include <algorithm>
#include <set>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/capture/capture_internal.h"
#include "framework/capture/common_names.h"
#include "framework/capture/layer_roles.h"
#include "framework/document/units.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

bool has_all(const ExrPart& part, const FoundChannels& channels) {
    return std::ranges::all_of(channels, [&](const std::vector<std::string>& names) {
        return std::ranges::all_of(
            names, [&](const std::string& name) { return name.empty() || has_channel(part, name); });
    });
}

}  // namespace

std::string CaptureReader::text_of(const RoleSource& source) {
    if (source.from_cryptomatte) return "a Cryptomatte";
    if (!source.luminance.empty()) return list_of_names(std::vector{source.luminance});
    return list_of_names(names_of(source.channels), "and");
}

/// Those of the whole capture before those that it does not have.
std::vector<int> CaptureReader::deciding_files() const {
    std::vector<int> files;
    std::set<int> known;
    for (const auto* frames : {&sequence_.whole, &sequence_.frames})
        for (const int frame : *frames)
            if (known.insert(frame).second) files.push_back(sequence_.file_number(frame));
    return files;
}

void CaptureReader::decide(const std::vector<int>& files, FirstFrame& first) const {
    // If every file is gone, each frame reports that itself; searching all of them would take minutes.
    constexpr std::size_t kMostTries = 1000;
    // Looks come and go while a reader lives: what they name does not decide.
    Sequence unnamed = sequence_;
    unnamed.object_names.clear();
    const CaptureReader alone(unnamed, profiles_, limits_, nullptr);
    for (std::size_t i = 0; i < std::min(kMostTries, files.size()); ++i) {
        if (!alone.has_frame(files[i])) continue;
        try {
            const OpenFrame open = alone.open(files[i]);
            first.views[""] = open.main->view();
            for (const auto& [role, file] : open.role_files) first.views[role] = file->view();
            for (const auto& [role, source] : open.roles) {
                first.channels[role] = source.channels;
                first.decodings[role] = source.decoding;
                first.sources[role] = text_of(source);
            }
            const auto color = first.channels.find(kColorRole);
            first.has_alpha = color != first.channels.end() && !color->second.empty() &&
                              color->second[0].size() == 4 && !color->second[0][3].empty();
            first.has_followers = files.size() > 1;
            first.header = open.header;
            return;
        } catch (const Error&) {
            // Reported when the frame itself is read.
        }
    }
}

const CaptureReader::FirstFrame* CaptureReader::first_frame() const {
    if (!first_ || !sequence_.layers.empty()) return nullptr;
    std::call_once(first_->once, [&] {
        const std::vector<int> files = deciding_files();
        if (files.size() > 1 || sequence_.subframes > 1) decide(files, *first_);
    });
    return first_->header ? first_.get() : nullptr;
}

void CaptureReader::hold_to_first_of(const CaptureReader& other) {
    first_ = std::make_shared<FirstFrame>();
    if (other.sequence_.layers.empty())
        std::call_once(first_->once, [&] { other.decide(other.deciding_files(), *first_); });
}

/// Whether a deep frame is read as one flat picture, because the first frame is flat.
bool CaptureReader::is_held_flat() const {
    const FirstFrame* const first = first_frame();
    return first && first->header->layer_roles.empty();
}

void CaptureReader::compare_depths(CaptureHeader& header) const {
    const FirstFrame* const first = first_frame();
    const bool is_deep = !header.layer_roles.empty();
    if (!first || is_deep != is_held_flat()) return;
    const std::string path = first->header->path.string();
    header.differences.push_back(
        is_deep ? "it is deep and " + path + " is flat: its samples are read as one flat picture"
                : "it is flat and " + path + " is deep: it has no layers behind its picture");
    header.layer_roles.clear();
    header.layer_count = 1;
}

std::string CaptureReader::decision(std::span<const RoleId> roles) const {
    std::string text;
    for (std::size_t i = 0; i < sequence_.layers.size(); ++i) {
        const Sequence own = sequence_of_layer(sequence_, i);
        if (const std::string decided = layer_reader(own, i).decision(roles_of_any_layer(roles));
            !decided.empty())
            text += std::to_string(i) + " " + decided + "\n";
    }
    const FirstFrame* const first = first_frame();
    if (!first) return text;
    const CaptureHeader& header = *first->header;
    text = header.profile + "\n" + header.layer + "\n" + (first->has_alpha ? "alpha" : "opaque") +
           (header.layer_roles.empty() ? "" : " deep");
    for (const float number : header.primaries) text += " " + format_number(double(number));
    for (const auto& [role, view] : first->views) text += "\n" + role + " in " + view;
    for (const auto& [role, source] : first->sources)
        if (role == kColorRole || std::find(roles.begin(), roles.end(), role) != roles.end())
            text += "\n" + role + " from " + source;
    return text;
}

std::unique_ptr<FrameFile> CaptureReader::open_file(const std::filesystem::path& path,
                                                    const std::string& role, int deep_layers,
                                                    CaptureHeader& header) const {
    auto file = std::make_unique<FrameFile>(path, limits_, sequence_.view, deep_layers);
    const FirstFrame* const first = sequence_.view.empty() ? first_frame() : nullptr;
    if (!first || !first->views.contains(role) || first->views.at(role) == file->view()) return file;
    const std::string &held = first->views.at(role), of = role.empty() ? "" : role + ": ";
    const std::vector<std::string> views = file->views();
    const std::string there = views.empty() ? "none" : list_of_names(views, "and");
    const std::string& origin = first->header->path.string();
    if (held.empty()) {
        header.differences.push_back(of + "it has the views " + there + "; '" + file->view() +
                                     "' is read, and " + origin + " has no views");
        return file;
    }
    if (std::ranges::find(views, held) == views.end())
        throw Error(ErrorKind::capture, path.string() + ": has no view '" + held +
                                            "', which the first frame, " + origin + ", is read in; it has " +
                                            there + " (choose a view that every frame has with " +
                                            spelled(Option::view) + ", or 'view' in capture.json)");
    header.differences.push_back(of + "it has the views " + there + "; '" + held + "' is read, as in " +
                                 origin);
    return std::make_unique<FrameFile>(path, limits_, held, deep_layers);
}

void CaptureReader::hold_channels(const std::string& role, const FrameFile& file,
                                  std::optional<FoundChannels>& found, RoleDecoding& decoding,
                                  CaptureHeader& header) const {
    const FirstFrame* const first = first_frame();
    if (!first || sequence_.channels.contains(role)) return;
    const auto held = first->channels.find(role);
    if (held == first->channels.end() || held->second.empty() || found == held->second ||
        !has_all(file.merged(), held->second))
        return;
    header.differences.push_back(role + " is read from " + first->sources.at(role) + ", as in " +
                                 first->header->path.string() +
                                 (found ? ", and not from " + list_of_names(names_of(*found), "and") : ""));
    found = held->second;
    decoding = first->decodings.at(role);
}

/// Whether the look decides what the role is read from.
bool CaptureReader::is_named(const std::string& role) const {
    return role == kObjectIdRole && !sequence_.object_names.empty();
}

/// What could not be held.
void CaptureReader::compare_sources(OpenFrame& open) const {
    const FirstFrame* const first = first_frame();
    if (!first) return;
    for (const auto& [role, source] : open.roles) {
        const auto held = first->sources.find(role);
        const std::string text = text_of(source);
        if (held == first->sources.end() || held->second == text || is_named(role)) continue;
        const bool lacks_alpha = role == kColorRole && first->has_alpha && !source.channels.empty() &&
                                 source.channels[0].size() == 4 && source.channels[0][3].empty();
        open.header.differences.push_back(role + " is read from " + text + ", in " +
                                          first->header->path.string() + " from " + held->second +
                                          (lacks_alpha ? "; its alpha is 1" : ""));
    }
}

void CaptureReader::compare_profile(const ExrPart& part, const CaptureHeader& first,
                                    CaptureHeader& header) const {
    std::string own = "no profile";
    try {
        const ProfileChoice choice = detect_profile(profiles_, part, header.path.string());
        if (choice.profile->id == first.profile) return;
        own = "the profile '" + choice.profile->id + "' (" + choice.reason + ")";
    } catch (const Error&) {
        if (sequence_.channels.contains(kColorRole)) return;
    }
    header.differences.push_back("it fits " + own + ", and is read by '" + first.profile + "', as " +
                                 first.path.string());
}

void CaptureReader::compare_with_first(CaptureHeader& header, const Chromaticities& primaries) const {
    const FirstFrame* const first = first_frame();
    if (!first) return;
    compare_depths(header);
    const CaptureHeader& other = *first->header;
    const bool has_other_primaries = primaries != other.primaries;  // before they are replaced
    header.keeps_alpha = first->has_alpha && first->has_followers && !sequence_.alpha_is_opaque;
    header.primaries = other.primaries;
    if (has_other_primaries)
        header.differences.push_back("its colours have other primaries than those of " + other.path.string() +
                                     ", and are converted to these");
    const Window &own = header.display_window, &others = other.display_window;
    if (own.width() != others.width() || own.height() != others.height())
        header.differences.push_back("its display window has " + std::to_string(own.width()) + " x " +
                                     std::to_string(own.height()) + " px, that of " + other.path.string() +
                                     " has " + std::to_string(others.width()) + " x " +
                                     std::to_string(others.height()));
    if (header.pixel_aspect != other.pixel_aspect)
        header.differences.push_back("its pixel aspect is " + format_number(double(header.pixel_aspect)) +
                                     ", that of " + other.path.string() + " is " +
                                     format_number(double(other.pixel_aspect)));
}

void CaptureReader::compare_roles(CaptureHeader& header, std::span<const RoleId> roles) const {
    const FirstFrame* const first = first_frame();
    if (!first) return;
    const auto has = [](const CaptureHeader& of, const std::string& role) {
        return std::ranges::find(of.roles, role) != of.roles.end();
    };
    const std::string path = first->header->path.string();
    for (const RoleId& role : roles) {
        const bool is_there = has(header, role.name());
        if (is_there == has(*first->header, role.name()) || role.is_coverage() || is_named(role.name()))
            continue;
        header.differences.push_back(is_there ? "it has " + role.name() + ", which " + path + " does not have"
                                              : "it has no " + role.name() + ", which " + path + " has");
    }
}

}  // namespace aftershade
