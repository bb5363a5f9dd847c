#include "framework/serve/view_picture.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/file/quantized.h"
#include "framework/image/display.h"
#include "framework/image/false_color.h"
#include "framework/image/role.h"
#include "framework/image/srgb.h"

namespace aftershade::serve {

namespace {

using Json = nlohmann::ordered_json;

/// The texture in which effects of a lens have signed radii of circles of confusion (glsl/lens).
constexpr const char* kCoc = "coc";

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

Image painted(const FalseColor& colors, const Image& image, const CaptureHeader& header) {
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

ShownView false_color_view(const std::string& role, const Image& image, const CaptureHeader& header) {
    const FalseColor colors(role, image, header.primaries);
    return {painted(colors, image, header), legend_json(colors)};
}

/// "#440154", as pages write colours.
std::string page_color(const DisplayColor& color) {
    std::string text = "#";
    for (const float channel : color)
        text += fmt::format("{:02x}", std::lround(std::clamp(channel, 0.0f, 1.0f) * 255));
    return text;
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

/// Radius of the largest circle of confusion that counts as sharp, px: the limit of 1/1500 of the picture's
/// diagonal is the usual one (Ray 2002, Applied Photographic Optics, on depth of field).
float sharp_radius_px(const Image& coc) {
    return float(std::hypot(coc.width(), coc.height()) / 1500 / 2);
}

/// -1 in front of what is sharp, 0 in it, 1 behind it.
int side_of(const Image& coc, float limit, int x, int y) {
    const float radius = coc.at(x, y, 0);
    return radius < -limit ? -1 : radius > limit ? 1 : 0;
}

/// What is sharp keeps its colours. What lies in front of it is blue and what lies behind is orange, both
/// grey by their light; the limits are lines of the same colours.
Image sharpness_picture(const Image& coc, const View& view) {
    const CaptureHeader& header = view.capture.header;
    const auto color = view.capture.images.find(kColorRole);
    if (color == view.capture.images.end() || color->second.width() != coc.width() ||
        color->second.height() != coc.height())
        throw Error(ErrorKind::usage, "the limits of sharpness are drawn over pictures with square pixels");
    Image picture = display_of_color(color->second, header.primaries);
    const float limit = sharp_radius_px(coc);
    constexpr std::array<float, 3> kFront = {0.25f, 0.55f, 1}, kBehind = {1, 0.55f, 0.15f};
    for (int y = 0; y < coc.height(); ++y)
        for (int x = 0; x < coc.width(); ++x) {
            const int side = side_of(coc, limit, x, y);
            const int right = side_of(coc, limit, std::min(x + 1, coc.width() - 1), y);
            const int below = side_of(coc, limit, x, std::min(y + 1, coc.height() - 1));
            const int other = side != right ? right : below;
            const bool is_limit = side != other;
            if (side == 0 && !is_limit) continue;
            const auto& tint = std::min(side, is_limit ? other : side) < 0 ? kFront : kBehind;
            float grey = 0;
            for (int c = 0; c < 3; ++c) grey += picture.at(x, y, c) / 3;
            for (int c = 0; c < 3; ++c)
                picture.at(x, y, c) = tint[std::size_t(c)] * (is_limit ? 1 : 0.15f + 0.55f * grey);
        }
    return cropped_display(picture, header.data_window, header.display_window);
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

bool is_inside(const Image& image, std::pair<int, int> place) {
    return place.first >= 0 && place.second >= 0 && place.first < image.width() &&
           place.second < image.height();
}

}  // namespace

Json legend_json(const FalseColor& colors) {
    constexpr int kColors = 12;
    Json legend = {
        {"words", colors.label()}, {"drawing", "none"}, {"colors", Json::array()}, {"faults", Json::array()}};
    if (colors.legend() == Legend::ramp) {
        legend["drawing"] = "ramp";
        for (int i = 0; i < kColors; ++i)
            legend["colors"].push_back(page_color(ramp_color(1 - float(i) / (kColors - 1))));
    } else if (colors.legend() == Legend::wheel) {
        legend["drawing"] = "wheel";
        for (int i = 0; i < kColors; ++i) {
            const float turn = 2 * std::numbers::pi_v<float> * float(i) / kColors;
            legend["colors"].push_back(page_color(wheel_color(std::cos(turn), std::sin(turn))));
        }
    }
    for (const PixelFault fault : kPixelFaults)
        if (colors.fault_count(fault) > 0)
            legend["faults"].push_back(
                {{"name", pixel_fault_name(fault)}, {"color", page_color(pixel_fault_color(fault))}});
    return legend;
}

std::pair<int, int> place_of_pixel(const CaptureHeader& header, int x, int y) {
    return {x + header.display_window.min_x - header.data_window.min_x,
            y + header.display_window.min_y - header.data_window.min_y};
}

std::pair<double, double> sharp_range_m(const Image& coc, const Capture& capture) {
    std::pair<double, double> range(std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity());
    const auto depth = capture.images.find(kDepthRole);
    if (depth == capture.images.end() || depth->second.floats().size() != coc.floats().size()) return range;
    const float limit = sharp_radius_px(coc);
    for (int y = 0; y < coc.height(); ++y)
        for (int x = 0; x < coc.width(); ++x) {
            const auto depth_m = double(depth->second.at(x, y, 0));
            if (side_of(coc, limit, x, y) != 0 || !std::isfinite(depth_m)) continue;
            range = {std::min(range.first, depth_m), std::max(range.second, depth_m)};
        }
    return range;
}

std::string unit_of_role(const RoleId& role) {
    switch (kind_of_role(role)) {
        case RoleKind::distance:
        case RoleKind::place: return "m";
        case RoleKind::motion: return "px";
        default: return "";
    }
}

Tap tap_of(const std::string& view, const Pipeline& pipeline) {
    const std::string text =
        view.substr(view.find(':') + 1) + (view.starts_with(kSharpView) ? std::string(".") + kCoc : "");
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
    if (name.starts_with("tap:") || name.starts_with(kSharpView)) return true;
    const std::string role = name.starts_with("role:") ? name.substr(5) : "";
    return !role.empty() && role != kDisplayRole && !is_picture(role);
}

ShownView view_picture(const View& view) {
    if (view.name == "final" || view.name.starts_with(kBeforeView)) return {final_picture(view), {}};
    if (view.name == "before") {
        const auto color = view.capture.images.find(kColorRole);
        if (color == view.capture.images.end())
            throw Error(ErrorKind::capture, "the capture has no role 'color'");
        return {light_picture(color->second, view), {}};
    }
    const std::string what = view.name.substr(std::min(view.name.find(':') + 1, view.name.size()));
    if (view.name.starts_with(kSharpView)) {
        const auto coc = view.result.taps.find(what + "." + kCoc);
        if (coc == view.result.taps.end())
            throw Error(ErrorKind::usage, "no pass made the circles of confusion of '" + what + "'");
        return {sharpness_picture(coc->second, view), {}};
    }
    if (view.name.starts_with("tap:")) {
        const auto tap = view.result.taps.find(what);
        if (tap == view.result.taps.end())
            throw Error(ErrorKind::usage, "no pass made the tap '" + what + "'");
        return false_color_view(std::string(kDataRole), tap->second, view.capture.header);
    }
    const Image* image = view.name.starts_with("role:") ? find_image(view, what) : nullptr;
    if (!image) throw Error(ErrorKind::usage, "there is no view '" + view.name + "' of this frame");
    if (is_picture(what)) return {light_picture(*image, view), {}};
    if (what == kDisplayRole) return {final_picture(view), {}};
    return false_color_view(what, *image, view.capture.header);
}

Json probe_json(const Capture& capture, int x, int y) {
    Json json = {{"x", x}, {"y", y}, {"roles", Json::array()}};
    const auto place = place_of_pixel(capture.header, x, y);
    for (const auto& [role, image] : capture.images) {
        Json entry = {{"name", role.name()}, {"unit", unit_of_role(role)}, {"values", Json::array()}};
        if (is_inside(image, place)) entry["values"] = values_at(image, place.first, place.second);
        json["roles"].push_back(std::move(entry));
    }
    return json;
}

Json result_at(const FrameResult& result, const CaptureHeader& header, int x, int y) {
    const auto place = place_of_pixel(header, x, y);
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
            const auto place = place_of_pixel(capture.header, x, y);
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

namespace {

std::string big_endian(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

std::string chunk(std::string_view type, std::string_view data) {
    std::string bytes(type);
    bytes += data;
    const auto checksum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), uInt(bytes.size())));
    return big_endian(std::uint32_t(data.size())) + bytes + big_endian(checksum);
}

/// Each byte less the one above it, which smooth pictures make small.
std::vector<std::uint8_t> filtered_rows(const Image& display) {
    constexpr std::uint8_t kUp = 2;
    const std::size_t stride = std::size_t(display.width()) * std::size_t(display.channels());
    std::vector<std::uint8_t> above(stride), row(stride), rows;
    rows.reserve((stride + 1) * std::size_t(display.height()));
    for (int y = 0; y < display.height(); ++y) {
        const auto values = display.floats().subspan(std::size_t(y) * stride, stride);
        rows.push_back(kUp);
        for (std::size_t i = 0; i < stride; ++i) {
            row[i] = quantized<std::uint8_t>(values[i]);
            rows.push_back(std::uint8_t(row[i] - above[i]));
        }
        above.swap(row);
    }
    return rows;
}

}  // namespace

std::string quick_png(const Image& display, bool is_srgb) {
    const std::vector<std::uint8_t> rows = filtered_rows(display);
    uLongf size = compressBound(uLong(rows.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, rows.data(), uLong(rows.size()),
                  Z_BEST_SPEED) != Z_OK)
        throw std::bad_alloc();
    packed.resize(size);
    constexpr std::array<char, 5> kColorTypes = {0, 0, 4, 2, 6};  // of PNG, by channels
    const std::string head = big_endian(std::uint32_t(display.width())) +
                             big_endian(std::uint32_t(display.height())) + '\x08' +
                             kColorTypes[std::size_t(display.channels())] + std::string(3, '\0');
    const std::string_view perceptual("\0", 1);  // the rendering intent
    return std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", head) +
           (is_srgb ? chunk("sRGB", perceptual) : "") + chunk("IDAT", packed) + chunk("IEND", "");
}

}  // namespace aftershade::serve
