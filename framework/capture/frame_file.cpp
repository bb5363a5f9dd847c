#include "framework/capture/frame_file.h"

#include <algorithm>

#include "framework/core/diagnostics.h"
#include "framework/core/error.h"
#include "framework/image/window.h"

namespace aftershade {

namespace {

bool is_deep(const ExrPart& part) {
    return part.type.starts_with("deep");
}

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

}  // namespace

FrameFile::FrameFile(const std::filesystem::path& path, const ReadLimits& limits, const std::string& view)
    : file_(path, limits) {
    choose_view(view);
    const std::vector<ExrPart>& parts = file_.parts();
    if (std::all_of(parts.begin(), parts.end(), is_deep))
        throw Error(
            ExitCode::capture,
            path.string() + ": holds nothing but deep data, which is not supported (flatten it first)");
    for (int i = 0; i < int(parts.size()); ++i) add_part(i);
    const auto color = stored_.find("R");
    int hero = color != stored_.end() ? color->second.part : -1;
    for (int i = 0; hero < 0 && i < int(parts.size()); ++i)
        if (!is_deep(parts[std::size_t(i)]) &&
            (parts[std::size_t(i)].view == view_ || parts[std::size_t(i)].view.empty()))
            hero = i;
    describe(std::max(hero, 0));
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
    throw Error(ExitCode::capture, path().string() + ": has no view '" + wanted + "'" +
                                       (views_.empty() ? std::string("; it names no views")
                                                       : "; it has " + list_of_names(views_, "and")));
}

void FrameFile::add_part(int index) {
    const ExrPart& part = file_.parts()[std::size_t(index)];
    if (is_deep(part) || (!part.view.empty() && part.view != view_)) return;
    const bool views_in_names = part.view.empty() && !views_.empty();
    for (const ExrChannel& channel : part.channels) {
        std::string name = views_in_names ? name_in_view(channel.name, views_, view_) : channel.name;
        if (name.empty()) continue;
        if (stored_.contains(name)) name = part.name + "." + name;
        stored_.emplace(name, Stored{index, channel.name});
        ExrChannel named = channel;
        named.name = name;
        merged_.channels.push_back(std::move(named));
    }
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
}

Window FrameFile::window_of(const std::string& channel) const {
    return part_of(channel).data_window;
}

PixelType FrameFile::type_of(const std::string& channel) const {
    for (const ExrChannel& candidate : merged_.channels)
        if (candidate.name == channel) return candidate.type;
    return PixelType::half;
}

Image FrameFile::read_floats(std::span<const std::string> channels, const Window& grid, float outside) const {
    // Mostly all channels of one role lie in one part: then one read serves.
    const int part = stored(channels.front()).part;
    std::vector<std::string> names;
    for (const std::string& channel : channels)
        if (stored(channel).part == part) names.push_back(stored(channel).name);
    if (names.size() == channels.size())
        return place_in_window(file_.read_floats(part, names), part_of(channels.front()).data_window, grid,
                               outside);

    Image image(grid.width(), grid.height(), int(channels.size()));
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Image one = read_floats(channels.subspan(c, 1), grid, outside);
        for (std::size_t i = 0; i < one.floats().size(); ++i)
            image.floats()[i * channels.size() + c] = one.floats()[i];
    }
    return image;
}

Image FrameFile::read_uints(std::span<const std::string> channels, const Window& grid) const {
    const Stored& first = stored(channels.front());
    return place_in_window(file_.read_uints(first.part, std::vector<std::string>{first.name}),
                           part_of(channels.front()).data_window, grid, 0);
}

void FrameFile::prefetch(std::span<const Request> requests) const {
    std::vector<ExrRequest> stored_requests;
    for (const Request& request : requests) {
        if (request.channels.empty()) continue;
        ExrRequest one{stored(request.channels.front()).part, {}, request.type};
        for (const std::string& channel : request.channels)
            if (stored(channel).part == one.part) one.channels.push_back(stored(channel).name);
        if (one.channels.size() == request.channels.size()) stored_requests.push_back(std::move(one));
    }
    file_.prefetch(stored_requests);
}

Image FrameFile::read_luminance_chroma(const std::string& luminance, const Window& grid) const {
    const int part = stored(luminance).part;
    return place_in_window(file_.read_luminance_chroma(part), part_of(luminance).data_window, grid, 0);
}

}  // namespace aftershade
