#include "framework/capture/frame_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/channel_names.h"
#include "framework/capture/common_names.h"
#include "framework/image/window.h"

namespace aftershade {

namespace {

/// "forward.left.u" without the view "left"; the view stands before the last component. "" where it is not in
/// the name.
std::string without_view(const std::string& name, const std::string& view) {
    const std::size_t last_dot = name.rfind('.');
    if (last_dot == std::string::npos) return "";
    const std::string head = name.substr(0, last_dot), tail = name.substr(last_dot);
    if (head == view) return tail.substr(1);
    if (head.size() <= view.size() + 1 || !head.ends_with("." + view)) return "";
    return head.substr(0, head.size() - view.size() - 1) + tail;
}

/// What a channel of a single-part multi-view file is called in `view`; "" where it belongs to another.
std::string name_in_view(const std::string& name, const std::vector<std::string>& views,
                         const std::string& view) {
    if (const std::string plain = without_view(name, view); !plain.empty()) return plain;
    for (const std::string& other : views)
        if (!without_view(name, other).empty()) return "";
    // Names without any view are the default view's if they have no layer, else every view's.
    const bool is_default = view == views.front();
    return is_default || name.find('.') != std::string::npos ? name : "";
}

bool holds_depth_alone(const ExrPart& part) {
    return std::all_of(part.channels.begin(), part.channels.end(), [](const ExrChannel& channel) {
        const std::string name = canonical_name(channel.name);
        return name == "z" || name == "zback";
    });
}

/// The part's name without its view: "depth" for "depth.main" or "depth_main" in the view "main".
std::string layer_of(const ExrPart& part, const std::string& view) {
    const std::string& name = part.name;
    if (view.empty()) return name;
    if (name == view) return "";
    const bool ends_in_view = name.size() > view.size() + 1 && name.ends_with(view);
    const std::size_t end = name.size() - view.size() - 1;
    return ends_in_view && (name[end] == '.' || name[end] == '_') ? name.substr(0, end) : name;
}

bool is_color_layer(const std::string& layer) {
    constexpr std::array<std::string_view, 8> kNames = {"",      "rgba", "rgb",      "beauty",
                                                        "color", "main", "combined", "c"};
    const std::string lower = lower_case(layer);
    return std::find(kNames.begin(), kNames.end(), lower) != kNames.end() || lower.starts_with("rgba");
}

}  // namespace

FrameFile::FrameFile(const std::filesystem::path& path, const ReadLimits& limits, const std::string& view,
                     int deep_layers)
    : file_(path, limits) {
    choose_view(view);
    const std::vector<ExrPart>& parts = file_.parts();
    const int color_part = find_color_part();
    // A flat picture beside its deep one is the picture.
    for (const bool deep : {false, true})
        for (int i = 0; i < int(parts.size()); ++i) {
            const ExrPart& part = parts[std::size_t(i)];
            if (part.is_deep() != deep || !is_in_view(part)) continue;
            if (deep) deep_[i] = std::make_unique<DeepPart>(file_, i, deep_layers);
            add_part(i, color_part);
        }
    for (const auto& [other, name] : merged_.other_names) stored_.emplace(other, stored_.at(name));
    const auto color = stored_.find("R");
    int hero = color != stored_.end() ? color->second.part : -1;
    for (int i = 0; hero < 0 && i < int(parts.size()); ++i)
        if (is_in_view(parts[std::size_t(i)])) hero = i;
    describe(std::max(hero, 0));
}

bool FrameFile::is_in_view(const ExrPart& part) const {
    return part.view.empty() || part.view == view_;
}

/// The part that "R" is taken from: the first that has it and is called as a picture usually is, else the
/// first that has it; -1 where none has.
int FrameFile::find_color_part() const {
    int first = -1;
    for (const bool deep : {false, true})
        for (int i = 0; i < int(file_.parts().size()); ++i) {
            const ExrPart& part = file_.parts()[std::size_t(i)];
            if (part.is_deep() != deep || !is_in_view(part) || !has_channel(part, "R")) continue;
            if (is_color_layer(layer_of(part, view_))) return i;
            if (first < 0) first = i;
        }
    return first;
}

std::vector<std::string> FrameFile::other_color_parts() const {
    const int chosen = find_color_part();
    std::vector<std::string> others;
    if (chosen < 0 || is_color_layer(layer_of(file_.parts()[std::size_t(chosen)], view_))) return others;
    for (int i = 0; i < int(file_.parts().size()); ++i) {
        const ExrPart& part = file_.parts()[std::size_t(i)];
        const bool has_colors = has_channel(part, "R") && has_channel(part, "G") && has_channel(part, "B");
        if (i != chosen && !part.is_deep() && is_in_view(part) && has_colors) others.push_back(part.name);
    }
    return others;
}

void FrameFile::choose_view(const std::string& wanted) {
    const std::vector<ExrPart>& parts = file_.parts();
    for (const ExrPart& part : parts)
        if (!part.view.empty() && std::find(views_.begin(), views_.end(), part.view) == views_.end())
            views_.push_back(part.view);
    if (const auto names = parts.front().metadata.texts("multiView"); views_.empty() && names)
        views_ = *names;
    view_ = wanted.empty() && !views_.empty() ? views_.front() : wanted;
    if (wanted.empty() || std::find(views_.begin(), views_.end(), wanted) != views_.end()) return;
    throw Error(ErrorKind::capture, path().string() + ": has no view '" + wanted + "'" +
                                        (views_.empty() ? std::string("; it names no views")
                                                        : "; it has " + list_of_names(views_, "and")));
}

void FrameFile::add_part(int index, int color_part) {
    const ExrPart& part = file_.parts()[std::size_t(index)];
    const bool views_in_names = part.view.empty() && !views_.empty();
    const bool is_layer = file_.parts().size() > 1;
    const std::string layer = is_layer ? layer_of(part, view_) : "";
    for (const ExrChannel& channel : part.channels) {
        std::string name = views_in_names ? name_in_view(channel.name, views_, view_) : channel.name;
        if (name.empty()) continue;
        const bool names_no_layer = name.find('.') == std::string::npos;
        const bool keeps_name = layer.empty() || !names_no_layer || index == color_part;
        add_channel(index, channel, keeps_name ? name : layer + "." + name,
                    names_no_layer && !layer.empty() ? layer : "");
    }
}

/// Under `name`; and, if it names no layer in its part, which is called `layer`, under its other name.
void FrameFile::add_channel(int index, const ExrChannel& channel, std::string name,
                            const std::string& layer) {
    const ExrPart& part = file_.parts()[std::size_t(index)];
    if (stored_.contains(name)) name = part.name + "." + name;
    stored_.insert_or_assign(name, Stored{index, channel.name});
    if (!layer.empty() && name == channel.name) merged_.other_names.emplace(layer + "." + name, name);
    else if (!layer.empty() && holds_depth_alone(part)) merged_.other_names.emplace(channel.name, name);
    ExrChannel named = channel;
    named.name = std::move(name);
    merged_.channels.push_back(std::move(named));
}

void FrameFile::describe(int hero_part) {
    const ExrPart& hero = file_.parts()[std::size_t(hero_part)];
    merged_.name = hero.name;
    merged_.view = view_;
    merged_.type = hero.type;
    merged_.compression = hero.compression;
    merged_.data_window = hero.data_window;
    merged_.display_window = hero.display_window;
    merged_.pixel_aspect = hero.pixel_aspect;
    merged_.metadata = hero.metadata;
    // Some producers write what is true of the whole file into its first part only. Of another view the
    // camera differs, but not what its texts tell: the producer.
    for (const ExrPart& part : file_.parts())
        if (part.view.empty() || part.view == view_) merged_.metadata.complete_from(part.metadata, false);
    for (const ExrPart& part : file_.parts()) merged_.metadata.complete_from(part.metadata, true);
}

Window FrameFile::window_of(const std::string& channel) const {
    return part_of(channel).data_window;
}

const std::string& FrameFile::compression_of(const std::string& channel) const {
    return part_of(channel).compression;
}

const ExrMetadata& FrameFile::metadata_of(const std::string& channel) const {
    return part_of(channel).metadata;
}

PixelType FrameFile::type_of(const std::string& channel) const {
    for (const ExrChannel& candidate : merged_.channels)
        if (candidate.name == channel) return candidate.type;
    return PixelType::half;
}

DeepPart* FrameFile::deep_part_of(const std::string& channel) const {
    const auto found = deep_.find(stored(channel).part);
    return found == deep_.end() ? nullptr : found->second.get();
}

Image FrameFile::read_floats(std::span<const std::string> channels, const Window& grid, float outside,
                             const DeepRead& how) const {
    // Mostly all channels of one role lie in one part: then one read serves.
    const int part = stored(channels.front()).part;
    std::vector<std::string> names;
    for (const std::string& channel : channels)
        if (stored(channel).part == part) names.push_back(stored(channel).name);
    if (names.size() == channels.size()) {
        DeepPart* const deep = deep_part_of(channels.front());
        return place_in_window(deep ? deep->read_floats(names, how, outside) : file_.read_floats(part, names),
                               part_of(channels.front()).data_window, grid, outside);
    }

    Image image(grid.width(), grid.height(), int(channels.size()));
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Image one = read_floats(channels.subspan(c, 1), grid, outside, how);
        for (std::size_t i = 0; i < one.floats().size(); ++i)
            image.floats()[i * channels.size() + c] = one.floats()[i];
    }
    return image;
}

Image FrameFile::read_uints(std::span<const std::string> channels, const Window& grid,
                            const DeepRead& how) const {
    const Stored& first = stored(channels.front());
    DeepPart* const deep = deep_part_of(channels.front());
    Image ids = deep ? deep->read_uints(first.name, how)
                     : file_.read_uints(first.part, std::vector<std::string>{first.name});
    return place_in_window(std::move(ids), part_of(channels.front()).data_window, grid, 0);
}

Image FrameFile::read_deep_alpha(const std::string& channel, const Window& grid, const DeepRead& how) const {
    return place_in_window(deep_part_of(channel)->read_alpha(how), part_of(channel).data_window, grid, 0);
}

void FrameFile::prefetch(std::span<const Request> requests) const {
    std::vector<ExrRequest> stored_requests;
    for (const Request& request : requests) {
        if (request.channels.empty()) continue;
        ExrRequest one{stored(request.channels.front()).part, {}, request.type};
        for (const std::string& channel : request.channels)
            if (stored(channel).part == one.part) one.channels.push_back(stored(channel).name);
        if (DeepPart* const deep = deep_part_of(request.channels.front())) deep->expect(one.channels);
        else if (one.channels.size() == request.channels.size()) stored_requests.push_back(std::move(one));
    }
    file_.prefetch(stored_requests);
}

Image FrameFile::read_luminance_chroma(const std::string& luminance, const Window& grid) const {
    const int part = stored(luminance).part;
    return place_in_window(file_.read_luminance_chroma(part), part_of(luminance).data_window, grid, 0);
}

}  // namespace aftershade
