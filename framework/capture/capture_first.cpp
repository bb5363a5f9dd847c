// What the first frame of a run decides for all of them.
#include <algorithm>
#include <utility>

#include "framework/capture/capture_internal.h"
#include "framework/capture/common_names.h"
#include "framework/core/error.h"
#include "framework/core/units.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

std::string list_of_found(const FoundChannels& found) {
    std::vector<std::string> names;
    for (const auto& layer : found)
        for (const std::string& name : layer)
            if (!name.empty()) names.push_back(name);
    return list_of_names(names, "and");
}

bool has_all(const ExrPart& part, const FoundChannels& channels) {
    return std::ranges::all_of(channels, [&](const std::vector<std::string>& names) {
        return std::ranges::all_of(
            names, [&](const std::string& name) { return name.empty() || has_channel(part, name); });
    });
}

}  // namespace

void CaptureReader::hold_to_first_of(std::vector<int> files) {
    first_ = std::make_shared<FirstFrame>();
    first_->files = std::move(files);
}

const CaptureReader::FirstFrame* CaptureReader::first_frame() const {
    if (!first_ || !sequence_.layers.empty()) return nullptr;
    std::call_once(first_->once, [&] {
        // Of a run whose files are gone each frame says so; a search of all would take minutes.
        constexpr std::size_t kMostTries = 1000;
        const CaptureReader alone(sequence_, profiles_, limits_);
        for (std::size_t i = 0; i < std::min(kMostTries, first_->files.size()); ++i) {
            const int file = first_->files[i];
            if (!alone.has_frame(file)) continue;
            try {
                const OpenFrame open = alone.open(file);
                for (const auto& [role, source] : open.roles) first_->channels[role] = source.channels;
                const auto color = first_->channels.find(kColorRole);
                first_->has_alpha = color != first_->channels.end() && !color->second.empty() &&
                                    color->second[0].size() == 4 && !color->second[0][3].empty();
                first_->header = open.header;
                return;
            } catch (const Error&) {
                // Reported when the frame itself is read.
            }
        }
    });
    return first_->header ? first_.get() : nullptr;
}

void CaptureReader::hold_channels(const std::string& role, const FrameFile& file, FoundChannels& found,
                                  CaptureHeader& header) const {
    const FirstFrame* const first = first_frame();
    if (!first || sequence_.channels.contains(role)) return;
    const auto held = first->channels.find(role);
    if (held == first->channels.end() || held->second.empty() || held->second == found) return;
    const std::string path = first->header->path.string();
    if (has_all(file.merged(), held->second)) {
        header.differences.push_back(role + " is read from " + list_of_found(held->second) + ", as in " +
                                     path + ", and not from " + list_of_found(found));
        found = held->second;
        return;
    }
    const bool lacks_alpha =
        role == kColorRole && first->has_alpha && found[0].size() == 4 && found[0][3].empty();
    header.differences.push_back(role + " is read from " + list_of_found(found) + ", in " + path + " from " +
                                 list_of_found(held->second) + (lacks_alpha ? "; its alpha is 1" : ""));
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
    const CaptureHeader& other = *first->header;
    const bool has_other_primaries = primaries != other.primaries;  // before they are replaced
    header.keeps_alpha = first->files.size() > 1 && first->has_alpha && !sequence_.alpha_is_opaque;
    header.primaries = other.primaries;
    if (has_other_primaries)
        header.differences.push_back("its colours have other primaries than those of " + other.path.string() +
                                     ", and are converted to these");
    const Window &own = header.display_window, &others = other.display_window;
    if (own.width() != others.width() || own.height() != others.height())
        header.differences.push_back(
            "its display window has " + std::to_string(own.width()) + " x " + std::to_string(own.height()) +
            " px, that of " + other.path.string() + " has " + std::to_string(others.width()) + " x " +
            std::to_string(others.height()));
    if (header.pixel_aspect != other.pixel_aspect)
        header.differences.push_back("its pixel aspect is " + format_number(double(header.pixel_aspect)) +
                                     ", that of " + other.path.string() + " is " +
                                     format_number(double(other.pixel_aspect)));
}

void CaptureReader::compare_roles(CaptureHeader& header, std::span<const std::string> roles) const {
    const FirstFrame* const first = first_frame();
    if (!first) return;
    const auto has = [](const CaptureHeader& of, const std::string& role) {
        return std::ranges::find(of.roles, role) != of.roles.end();
    };
    const std::string path = first->header->path.string();
    for (const std::string& role : roles) {
        const bool is_there = has(header, role);
        if (is_there == has(*first->header, role) || is_coverage_role(role)) continue;
        header.differences.push_back(is_there ? "it has " + role + ", which " + path + " does not have"
                                              : "it has no " + role + ", which " + path + " has");
    }
}

}  // namespace aftershade
