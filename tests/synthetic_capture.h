// Captures from formulas, so that a test knows every pixel before it looks: a plane, a sphere, bright points,
// a moving box.
#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/image/role.h"

namespace aftershade::test {

struct Rgb {
    float r = 0, g = 0, b = 0;
};

struct SyntheticPoint {
    int x = 0, y = 0;     ///< px
    float intensity = 1;  ///< of each channel, added to what is there
};

struct SyntheticSphere {
    float x = 0, y = 0, radius_px = 0;  ///< centre and radius in the image
    float depth_m = 1;  ///< of the whole disk: a billboard, so that its circle of confusion is one number
    Rgb color{0.8f, 0.5f, 0.3f};
};

/// An axis-aligned box that moves by whole pixels, so that its coverage is exact.
struct SyntheticBox {
    int x = 0, y = 0, width = 0, height = 0;  ///< at frame 0, px
    int velocity_x = 0, velocity_y = 0;       ///< px a frame
    float depth_m = 1;
    Rgb color{0.9f, 0.2f, 0.1f};
};

struct SyntheticScene {
    int width = 64, height = 36;
    Rgb background{};
    float background_depth_m = std::numeric_limits<float>::infinity();
    float alpha = 1;                          ///< of the background; objects are opaque
    std::optional<SyntheticSphere> sphere{};  ///< object 1
    std::optional<SyntheticBox> box{};        ///< object 2
    std::vector<SyntheticPoint> points{};
};

namespace detail {

inline void set_rgb(Image& image, int x, int y, Rgb value) {
    image.at(x, y, 0) = value.r;
    image.at(x, y, 1) = value.g;
    image.at(x, y, 2) = value.b;
}

/// Writes one surface point into every role. All light is diffuse: albedo is the colour, irradiance 1.
inline void set_surface(Capture& capture, int x, int y, Rgb color, float alpha, float depth_m,
                        std::uint32_t id) {
    auto& images = capture.images;
    const float irradiance = 1;
    set_rgb(images["color"], x, y, {color.r * alpha, color.g * alpha, color.b * alpha});
    images["color"].at(x, y, 3) = alpha;
    images["depth"].at(x, y, 0) = depth_m;
    set_rgb(images["albedo"], x, y, color);
    set_rgb(images["irradiance"], x, y, {irradiance, irradiance, irradiance});
    set_rgb(images["normal"], x, y, {0, 0, 1});
    const float finite_m = std::isfinite(depth_m) ? depth_m : 0;
    set_rgb(images["position"], x, y, {float(x), float(y), -finite_m});
    images["object_id"].uint_at(x, y, 0) = id;
    images["mask"].at(x, y, 0) = id > 0 ? 1.0f : 0.0f;
}

}  // namespace detail

inline Capture make_capture(const SyntheticScene& scene, int frame = 1) {
    Capture capture;
    CaptureHeader& header = capture.header;
    header.frame = frame;
    header.path = "synthetic";
    header.profile = "native";
    header.data_window = header.display_window = {0, 0, scene.width - 1, scene.height - 1};
    for (const ChannelRole& role : channel_roles()) {
        if (role.name == "display") continue;
        capture.images[role.name] = Image(scene.width, scene.height, role.channels, role.type);
        header.roles.push_back(role.name);
    }
    for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x) {
            detail::set_surface(capture, x, y, scene.background, scene.alpha, scene.background_depth_m, 0);
            if (scene.sphere &&
                std::hypot(float(x) - scene.sphere->x, float(y) - scene.sphere->y) <= scene.sphere->radius_px)
                detail::set_surface(capture, x, y, scene.sphere->color, 1, scene.sphere->depth_m, 1);
            if (!scene.box) continue;
            const SyntheticBox& box = *scene.box;
            const int left = box.x + frame * box.velocity_x, top = box.y + frame * box.velocity_y;
            if (x < left || x >= left + box.width || y < top || y >= top + box.height) continue;
            detail::set_surface(capture, x, y, box.color, 1, box.depth_m, 2);
            for (const char* role : {"velocity", "velocity_next"}) {
                capture.images[role].at(x, y, 0) = float(box.velocity_x);
                capture.images[role].at(x, y, 1) = float(box.velocity_y);
            }
        }
    for (const SyntheticPoint& point : scene.points)
        for (int c = 0; c < 3; ++c) capture.images["color"].at(point.x, point.y, c) += point.intensity;
    return capture;
}

/// Writes every role under its native channel names.
inline void write_capture(const Capture& capture, const std::filesystem::path& path) {
    std::vector<ExrOutputChannel> channels;
    for (const auto& [name, image] : capture.images) {
        const ChannelRole role = *find_role(name);
        const PixelType type = role.type == ComponentType::uint32 ? PixelType::uint32 : PixelType::float32;
        for (int c = 0; c < role.channels; ++c)
            channels.push_back({role.native_channels[std::size_t(c)], type, &image, c});
    }
    ExrWriteOptions options;
    options.data_window = capture.header.data_window;
    options.display_window = capture.header.display_window;
    options.pixel_aspect = capture.header.pixel_aspect;
    const Chromaticities& primaries = capture.header.primaries;
    if (primaries != kRec709)
        options.attributes["chromaticities"] = std::vector<float>(primaries.begin(), primaries.end());
    write_exr(path, channels, options);
}

}  // namespace aftershade::test
