// What tests of the public API share.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "aftershade/host.h"

namespace aftershade::test {

inline host::HostOptions on_software() {
    return {.data = AFTERSHADE_SOURCE_DIR, .backend = host::Backend::software};
}

inline constexpr const char* kBlurLook = R"({"aftershade": 1, "steps": [
    {"effect": "bokeh", "params": {"f_number": 0.5, "focus_distance": "6.4 m"}},
    {"effect": "vignette"}]})";

inline void write_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

inline bool same_bits(const host::Image& a, const host::Image& b) {
    return a.width() == b.width() && a.height() == b.height() && a.channels() == b.channels() &&
           a.type() == b.type() && !a.empty() &&
           std::memcmp(a.data(), b.data(),
                       std::size_t(a.width()) * std::size_t(a.height()) * std::size_t(a.channels()) * 4) == 0;
}

/// A frame of color and depth from a formula: the left half near, the right half far, with bright dots.
inline host::Capture small_capture(int width = 48, int height = 32, float brightness = 1) {
    std::vector<float> color(std::size_t(width * height) * 4), depth(std::size_t(width * height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = std::size_t(y * width + x);
            const bool dot = x % 11 == 5 && y % 9 == 4;
            color[i * 4] = brightness * (dot ? 20.0f : 0.1f + 0.01f * float(x));
            color[i * 4 + 1] = brightness * (dot ? 18.0f : 0.2f + 0.01f * float(y));
            color[i * 4 + 2] = brightness * 0.3f;
            color[i * 4 + 3] = 1;
            depth[i] = x < width / 2 ? 2.0f : 9.0f;
        }
    host::Capture capture(width, height);
    capture.set_image("color", host::view_of(color, width, height, 4));
    capture.set_image("depth", host::view_of(depth, width, height, 1));
    return capture;
}

}  // namespace aftershade::test
