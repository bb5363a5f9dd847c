#include "framework/serve/view_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/image/display.h"
#include "framework/image/false_color.h"
#include "framework/image/role.h"
#include "framework/image/srgb.h"

namespace aftershade::serve {

namespace {

using Json = nlohmann::ordered_json;

/// By `ev` stops, in linear light; alpha stays.
void expose_display(Image& display, double ev) {
    if (ev == 0) return;
    const double factor = std::exp2(ev);
    for (int y = 0; y < display.height(); ++y)
        for (int x = 0; x < display.width(); ++x)
            for (int c = 0; c < std::min(display.channels(), 3); ++c) {
                float& value = display.at(x, y, c);
                value = float(encode_srgb(decode_srgb(double(value)) * factor));
            }
}

void expose_light(Image& color, double ev) {
    if (ev == 0) return;
    const float factor = float(std::exp2(ev));
    for (int y = 0; y < color.height(); ++y)
        for (int x = 0; x < color.width(); ++x)
            for (int c = 0; c < std::min(color.channels(), 3); ++c) color.at(x, y, c) *= factor;
}

Image light_picture(Image color, const View& view) {
    const CaptureHeader& header = view.capture.header;
    expose_light(color, view.exposure_ev);
    return cropped_display(display_of_color(std::move(color), header.primaries), header.data_window,
                           header.display_window);
}

Image false_color_picture(const std::string& role, const Image& image, const CaptureHeader& header) {
    const FalseColor colors(role, image, header.primaries);
    Image picture(image.width(), image.height(), 4);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const DisplayColor color = colors.color(x, y);
            for (int c = 0; c < 3; ++c) picture.at(x, y, c) = color[std::size_t(c)];
            picture.at(x, y, 3) = 1;
        }
    const Window& data = header.data_window;
    if (image.width() != data.width() || image.height() != data.height()) return picture;
    return cropped_display(picture, data, header.display_window);
}

const Image* find_image(const View& view, const std::string& role) {
    const auto made = view.result.images.find(role);
    if (made != view.result.images.end()) return &made->second;
    const auto stored = view.capture.images.find(role);
    return stored == view.capture.images.end() ? nullptr : &stored->second;
}

Image final_picture(const View& view) {
    const auto made = view.result.images.find(kDisplayRole);
    if (made != view.result.images.end()) {
        const CaptureHeader& header = view.capture.header;
        Image display = cropped_display(made->second, header.data_window, header.display_window);
        expose_display(display, view.exposure_ev);
        return display;
    }
    const Image* color = find_image(view, kColorRole);
    if (!color) throw Error(ErrorKind::capture, "the capture has no role 'color'");
    return light_picture(*color, view);
}

Json number(double value) {
    if (std::isfinite(value)) return value;
    return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

Json values_at(const Image& image, int x, int y) {
    Json values = Json::array();
    for (int c = 0; c < image.channels(); ++c) {
        if (image.type() == ComponentType::uint32) values.push_back(image.uint_at(x, y, c));
        else values.push_back(number(double(image.at(x, y, c))));
    }
    return values;
}

/// The place of a picture's pixel in the images of a capture.
std::pair<int, int> place_of(const CaptureHeader& header, int x, int y) {
    return {x + header.display_window.min_x - header.data_window.min_x,
            y + header.display_window.min_y - header.data_window.min_y};
}

bool is_inside(const Image& image, std::pair<int, int> place) {
    return place.first >= 0 && place.second >= 0 && place.first < image.width() &&
           place.second < image.height();
}

}  // namespace

std::string unit_of_role(const std::string& role) {
    switch (kind_of_role(split_layer_role(role).role)) {
        case RoleKind::distance:
        case RoleKind::place: return "m";
        case RoleKind::motion: return "px";
        default: return "";
    }
}

Tap tap_of(const std::string& view, const Pipeline& pipeline) {
    const std::string text = view.substr(view.find(':') + 1);
    const std::size_t dot = text.find('.');
    for (const PipelineStep& step : pipeline.steps) {
        if (dot == std::string::npos || step.name != text.substr(0, dot)) continue;
        const std::string texture = text.substr(dot + 1);
        if (step.manifest->find_texture(texture) || step.manifest->find_output(texture))
            return {step.name, texture};
    }
    throw Error(ErrorKind::usage, "the look has no tap '" + text + "'");
}

namespace {

/// Light with alpha, which is shown as a display shows it.
bool is_picture(const std::string& role) {
    const auto contract = find_role(role);
    return contract && contract->kind == RoleKind::light && !contract->is_share && contract->channels == 4;
}

}  // namespace

bool is_false_color(const std::string& name) {
    if (name.starts_with("tap:")) return true;
    const std::string role = name.starts_with("role:") ? name.substr(5) : "";
    return !role.empty() && role != kDisplayRole && !is_picture(role);
}

Image view_picture(const View& view) {
    if (view.name == "final") return final_picture(view);
    if (view.name == "before") {
        const auto color = view.capture.images.find(kColorRole);
        if (color == view.capture.images.end())
            throw Error(ErrorKind::capture, "the capture has no role 'color'");
        return light_picture(color->second, view);
    }
    const std::string what = view.name.substr(std::min(view.name.find(':') + 1, view.name.size()));
    if (view.name.starts_with("tap:")) {
        const auto tap = view.result.taps.find(what);
        if (tap == view.result.taps.end())
            throw Error(ErrorKind::usage, "no pass made the tap '" + what + "'");
        return false_color_picture(std::string(kDataRole), tap->second, view.capture.header);
    }
    const Image* image = view.name.starts_with("role:") ? find_image(view, what) : nullptr;
    if (!image) throw Error(ErrorKind::usage, "there is no view '" + view.name + "' of this frame");
    if (is_picture(what)) return light_picture(*image, view);
    if (what == kDisplayRole) return final_picture(view);
    return false_color_picture(what, *image, view.capture.header);
}

Json probe_json(const Capture& capture, int x, int y) {
    Json json = {{"x", x}, {"y", y}, {"roles", Json::array()}};
    const auto place = place_of(capture.header, x, y);
    for (const auto& [role, image] : capture.images) {
        Json entry = {{"name", role}, {"unit", unit_of_role(role)}, {"values", Json::array()}};
        if (is_inside(image, place)) entry["values"] = values_at(image, place.first, place.second);
        json["roles"].push_back(std::move(entry));
    }
    return json;
}

Json result_at(const FrameResult& result, const CaptureHeader& header, int x, int y) {
    const auto place = place_of(header, x, y);
    for (const char* role : {kDisplayRole, kColorRole}) {
        const auto made = result.images.find(role);
        if (made != result.images.end() && is_inside(made->second, place))
            return values_at(made->second, place.first, place.second);
    }
    return nullptr;
}

std::optional<std::pair<double, double>> nearest_surface(const Capture& capture) {
    const auto depth = capture.images.find(kDepthRole);
    if (depth == capture.images.end()) return std::nullopt;
    const Window& window = capture.header.display_window;
    double least = std::numeric_limits<double>::infinity();
    std::optional<std::pair<double, double>> nearest;
    for (int y = 0; y < window.height(); ++y)
        for (int x = 0; x < window.width(); ++x) {
            const auto place = place_of(capture.header, x, y);
            if (!is_inside(depth->second, place) ||
                !std::isfinite(depth->second.at(place.first, place.second, 0)))
                continue;
            const auto side = [](int at, int size) { return at == size / 2 ? 0.5 : (at + 0.5) / size; };
            const double u = side(x, window.width()), v = side(y, window.height());
            const double distance = std::hypot(u - 0.5, v - 0.5);
            if (distance < least) {
                least = distance;
                nearest = {u, v};
            }
        }
    return nearest;
}

Json histogram_json(const Image& picture) {
    std::array<std::array<std::uint64_t, 256>, 3> counts{};
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const float value = picture.at(x, y, std::min(c, picture.channels() - 1));
                const double level = std::isnan(value) ? 0 : std::clamp(double(value), 0.0, 1.0) * 255;
                ++counts[std::size_t(c)][std::size_t(std::lround(level))];
            }
    return {{"bins", 256}, {"min", 0}, {"max", 1}, {"r", counts[0]}, {"g", counts[1]}, {"b", counts[2]}};
}

}  // namespace aftershade::serve
