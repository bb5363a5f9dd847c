#include "framework/compare/compare_area.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/compare/layer_file.h"
#include "framework/file/png_file.h"

namespace aftershade {

namespace {

namespace fs = std::filesystem;

Window moved(const Window& window, int x, int y) {
    return {window.min_x + x, window.min_y + y, window.max_x + x, window.max_y + y};
}

bool has_size_of(const Window& a, const Window& b) {
    return a.width() == b.width() && a.height() == b.height();
}

std::string size_text(const Window& window) {
    return fmt::format("{} x {} px", window.width(), window.height());
}

bool meet(const Window& a, const Window& b) {
    return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
}

/// The layer of a mask's file that has the channel.
struct MaskSource {
    const LayerInfo* layer = nullptr;
    std::vector<std::string> channels;
};

MaskSource source_of(const LayerFile& file, const std::string& channel) {
    std::vector<std::string> names;
    for (const LayerInfo& layer : file.layers())
        for (const std::string& name : layer.channels) {
            if (name == channel || (layer.part + "." + name) == channel) return {&layer, {name}};
            names.push_back(layer.part.empty() ? name : layer.part + "." + name);
        }
    if (channel.empty() && names.size() == 1) return {&file.layers().front(), file.layers().front().channels};
    throw Error(ErrorKind::capture,
                channel.empty()
                    ? fmt::format("{}: a mask has one channel, and this file has {}: name one of {}",
                                  file.path().string(), names.size(), list_of_names(names))
                    : fmt::format("{}: has no channel '{}'{}; it has {}", file.path().string(), channel,
                                  did_you_mean(channel, names), list_of_names(names, "and")));
}

/// The largest of a PNG's colours: alpha is none.
Image brightness_of(const Image& image) {
    const int colors = image.channels() - (image.channels() % 2 == 0 ? 1 : 0);
    Image largest(image.width(), image.height(), 1);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < colors; ++c)
                largest.at(x, y, 0) = std::max(largest.at(x, y, 0), image.at(x, y, c));
    return largest;
}

}  // namespace

AreaShape rectangle_area(int x, int y, int width, int height) {
    return {{x, y, x + width - 1, y + height - 1}, {}, std::nullopt, true};
}

AreaShape covered_area(const Image& coverage, float limit, const Window& window, const Window& display) {
    AreaShape shape{window, {}, display, false};
    for (const float value : coverage.floats()) shape.inside.push_back(value > limit ? 1 : 0);
    return shape;
}

AreaShape mask_area(const fs::path& path, const std::string& channel, const ReadLimits& limits) {
    constexpr float kHalf = 0.5f;
    const LayerFile file(path, limits);
    if (file.format() == "PNG") {
        if (!channel.empty())
            throw Error(ErrorKind::capture,
                        path.string() + ": a PNG's channels have no names; leave '" + channel + "' out");
        PngColor color;  // LayerFile applies it, and a mask's numbers are data
        const Image bright = brightness_of(read_png(path, &color));
        const Window window{0, 0, bright.width() - 1, bright.height() - 1};
        AreaShape shape = covered_area(bright, kHalf, window, window);
        shape.from_corner = true;
        if (const std::string note = color.note_of_data(); !note.empty())
            shape.note = path.string() + ": " + note;
        return shape;
    }
    const MaskSource source = source_of(file, channel);
    if (source.layer->type != ComponentType::float32)
        throw Error(ErrorKind::capture, path.string() + ": the channel holds integers; a mask is of floats");
    return covered_area(file.read(*source.layer, source.channels), kHalf, source.layer->data_window,
                        source.layer->display_window);
}

std::string fault_of(const CompareArea& area, const Window& display) {
    const AreaShape& shape = area.shape;
    if (!shape.display) {
        const Window whole{0, 0, display.width() - 1, display.height() - 1};
        if (meet(shape.window, whole)) return "";
        return fmt::format("the area {} lies outside of the picture, which has {}", area.name,
                           size_text(display));
    }
    const bool fits = shape.from_corner ? has_size_of(*shape.display, display) : *shape.display == display;
    if (fits) return "";
    return fmt::format(
        "the area {} is of a display window of {} from ({}, {}), the picture's has {} from ({}, {})",
        area.name, size_text(*shape.display), shape.display->min_x, shape.display->min_y, size_text(display),
        display.min_x, display.min_y);
}

PixelAreas pixel_areas(const std::vector<CompareArea>& areas, const Window& window, const Window& display,
                       const DifferenceRules& layer) {
    PixelAreas result;
    if (areas.empty()) return result;
    const auto width = std::size_t(window.width());
    result.of_pixel.resize(width * std::size_t(window.height()));
    for (const CompareArea& area : areas) {
        std::uint8_t mark = PixelAreas::kLeftOut;
        if (area.levels) {
            DifferenceRules limits = area.levels->difference_limits();
            limits.nan_equal = layer.nan_equal, limits.forgive = layer.forgive;
            result.limits.push_back(limits);
            assert(result.limits.size() <= PixelAreas::kMost);
            mark = std::uint8_t(result.limits.size());
        }
        const AreaShape& shape = area.shape;
        const Window place =
            shape.from_corner ? moved(shape.window, display.min_x, display.min_y) : shape.window;
        for (int y = std::max(place.min_y, window.min_y); y <= std::min(place.max_y, window.max_y); ++y)
            for (int x = std::max(place.min_x, window.min_x); x <= std::min(place.max_x, window.max_x); ++x) {
                const auto at =
                    std::size_t(y - place.min_y) * std::size_t(place.width()) + std::size_t(x - place.min_x);
                if (!shape.inside.empty() && !shape.inside[at]) continue;
                std::uint8_t& pixel =
                    result.of_pixel[std::size_t(y - window.min_y) * width + std::size_t(x - window.min_x)];
                if (mark == PixelAreas::kLeftOut || pixel == 0) pixel = mark;
            }
    }
    return result;
}

}  // namespace aftershade
