// Pixels in memory: rows from the top, channels interleaved, floats or unsigned integers.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace aftershade {

enum class ComponentType { float32, uint32 };

/// A rectangle of pixels by its first and last pixel, both inside, as EXR writes windows.
struct Window {
    int min_x = 0;
    int min_y = 0;
    int max_x = -1;
    int max_y = -1;
    int width() const { return max_x - min_x + 1; }
    int height() const { return max_y - min_y + 1; }
    bool contains(int x, int y) const { return x >= min_x && x <= max_x && y >= min_y && y <= max_y; }
    bool operator==(const Window&) const = default;
};

/// [value type: safe to read from several threads]
class Image {
public:
    Image() = default;
    /// Zero-filled.
    Image(int width, int height, int channels, ComponentType type = ComponentType::float32)
        : width_(width), height_(height), channels_(channels) {
        const std::size_t count = std::size_t(width) * std::size_t(height) * std::size_t(channels);
        if (type == ComponentType::float32) values_ = std::vector<float>(count);
        else values_ = std::vector<std::uint32_t>(count);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    bool empty() const { return width_ == 0 || height_ == 0; }
    ComponentType type() const {
        return values_.index() == 0 ? ComponentType::float32 : ComponentType::uint32;
    }

    std::span<float> floats() { return std::get<0>(values_); }
    std::span<const float> floats() const { return std::get<0>(values_); }
    std::span<std::uint32_t> uints() { return std::get<1>(values_); }
    std::span<const std::uint32_t> uints() const { return std::get<1>(values_); }

    float& at(int x, int y, int channel) { return std::get<0>(values_)[index(x, y, channel)]; }
    float at(int x, int y, int channel) const { return std::get<0>(values_)[index(x, y, channel)]; }
    std::uint32_t& uint_at(int x, int y, int channel) { return std::get<1>(values_)[index(x, y, channel)]; }
    std::uint32_t uint_at(int x, int y, int channel) const {
        return std::get<1>(values_)[index(x, y, channel)];
    }

private:
    std::size_t index(int x, int y, int channel) const {
        assert(x >= 0 && x < width_ && y >= 0 && y < height_ && channel >= 0 && channel < channels_);
        return (std::size_t(y) * std::size_t(width_) + std::size_t(x)) * std::size_t(channels_) +
               std::size_t(channel);
    }
    int width_ = 0;
    int height_ = 0;
    int channels_ = 0;
    std::variant<std::vector<float>, std::vector<std::uint32_t>> values_;
};

}  // namespace aftershade
