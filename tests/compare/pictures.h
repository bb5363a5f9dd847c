// Pictures for the tests of comparisons, from formulas and from a hash, and the files that hold them.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "framework/file/png_file.h"
#include "framework/image/image.h"
#include "tests/not_finite.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {

/// 0 to 1, the same on every machine: the finaliser of Murmur3 (Appleby, public domain).
inline float hashed(int x, int y, int c, int seed) {
    auto h = std::uint32_t(x) * 0x9e3779b1u ^ std::uint32_t(y) * 0x85ebca6bu ^
             std::uint32_t(c) * 0xc2b2ae35u ^ std::uint32_t(seed) * 0x27d4eb2fu;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    h ^= h >> 16;
    return float(h >> 8) / 16777216.0f;
}

using ValueAt = std::function<float(int x, int y, int c)>;

inline Image picture(int width, int height, int channels, const ValueAt& value) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) image.at(x, y, c) = value(x, y, c);
    return image;
}

inline Image constant(int width, int height, std::vector<float> color) {
    return picture(width, height, int(color.size()), [&](int, int, int c) { return color[std::size_t(c)]; });
}

inline Image row(std::vector<float> values) {
    return picture(int(values.size()), 1, 1, [&](int x, int, int) { return values[std::size_t(x)]; });
}

inline Image ids(std::vector<std::uint32_t> values) {
    Image image(int(values.size()), 1, 1, ComponentType::uint32);
    std::copy(values.begin(), values.end(), image.uints().begin());
    return image;
}

/// One part of full floats (integers of integer images), by channel name, over the whole or another window.
struct Channels {
    std::vector<std::string> names;
    Image image;
};
inline void write_exr_file(const std::filesystem::path& path, const std::vector<Channels>& layers,
                           Window data = {}, Window display = {}) {
    std::vector<ExrOutputChannel> channels;
    for (const Channels& layer : layers)
        for (std::size_t c = 0; c < layer.names.size(); ++c)
            channels.push_back(
                {layer.names[c],
                 layer.image.type() == ComponentType::uint32 ? PixelType::uint32 : PixelType::float32,
                 &layer.image, int(c)});
    const Image& image = layers.front().image;
    if (data.width() == 0) data = {0, 0, image.width() - 1, image.height() - 1};
    if (display.width() == 0) display = data;
    ExrWriteOptions options;
    options.data_window = data;
    options.display_window = display;
    write_exr(path, channels, options);
}

inline void write_rgb(const std::filesystem::path& path, const Image& image) {
    write_exr_file(path, {{{"R", "G", "B"}, image}});
}

/// The same as halfs.
inline void write_rgb_halfs(const std::filesystem::path& path, const Image& image) {
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, image.width() - 1, image.height() - 1};
    write_exr(path, channels, options);
}

}  // namespace aftershade::test
