// Pixels in memory: rows from the top, channels interleaved, floats or unsigned integers.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "framework/image/pixel_memory.h"

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

/// Numbers that are zero at first without being written where their memory is fresh: the system makes its
/// pages where they are first touched, so the threads that fill an image make them, not its constructor. Not
/// a vector, which goes through the elements one by one to make, copy and end them, however little there is
/// to do for each. [value type: safe to read from several threads]
template <typename Value>
requires std::is_arithmetic_v<Value>
class PixelArray {
public:
    PixelArray() = default;
    explicit PixelArray(std::size_t count, FirstValues first = FirstValues::zero)
        : values_(static_cast<Value*>(take_pixel_memory(count, sizeof(Value), first))), count_(count) {}
    PixelArray(const PixelArray& other) : PixelArray(other.count_, FirstValues::unwritten) {
        if (count_ > 0) std::memcpy(values_, other.values_, count_ * sizeof(Value));
    }
    PixelArray(PixelArray&& other) noexcept
        : values_(std::exchange(other.values_, nullptr)), count_(std::exchange(other.count_, 0)) {}
    PixelArray& operator=(PixelArray other) noexcept {
        std::swap(values_, other.values_);
        std::swap(count_, other.count_);
        return *this;
    }
    ~PixelArray() { give_pixel_memory(values_, count_ * sizeof(Value)); }

    std::span<Value> values() { return {values_, count_}; }
    std::span<const Value> values() const { return {values_, count_}; }

private:
    Value* values_ = nullptr;
    std::size_t count_ = 0;
};

/// [value type: safe to read from several threads]
class Image {
public:
    Image() = default;
    /// `first`: `unwritten` for a caller that writes every value.
    Image(int width, int height, int channels, ComponentType type = ComponentType::float32,
          FirstValues first = FirstValues::zero)
        : width_(width), height_(height), channels_(channels) {
        const std::size_t count = std::size_t(width) * std::size_t(height) * std::size_t(channels);
        if (type == ComponentType::float32) values_ = PixelArray<float>(count, first);
        else values_ = PixelArray<std::uint32_t>(count, first);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    bool empty() const { return width_ == 0 || height_ == 0; }
    ComponentType type() const {
        return values_.index() == 0 ? ComponentType::float32 : ComponentType::uint32;
    }

    std::span<float> floats() { return std::get<0>(values_).values(); }
    std::span<const float> floats() const { return std::get<0>(values_).values(); }
    std::span<std::uint32_t> uints() { return std::get<1>(values_).values(); }
    std::span<const std::uint32_t> uints() const { return std::get<1>(values_).values(); }

    float& at(int x, int y, int channel) { return floats()[index(x, y, channel)]; }
    float at(int x, int y, int channel) const { return floats()[index(x, y, channel)]; }
    std::uint32_t& uint_at(int x, int y, int channel) { return uints()[index(x, y, channel)]; }
    std::uint32_t uint_at(int x, int y, int channel) const { return uints()[index(x, y, channel)]; }

private:
    std::size_t index(int x, int y, int channel) const {
        assert(x >= 0 && x < width_ && y >= 0 && y < height_ && channel >= 0 && channel < channels_);
        return (std::size_t(y) * std::size_t(width_) + std::size_t(x)) * std::size_t(channels_) +
               std::size_t(channel);
    }
    int width_ = 0;
    int height_ = 0;
    int channels_ = 0;
    std::variant<PixelArray<float>, PixelArray<std::uint32_t>> values_;
};

/// The least normal half (glsl/coverage.glsl has the same). A smaller alpha, which filters leave, has lost
/// its digits: what is divided by it would be noise.
inline constexpr float kLeastAlpha = 6.103515625e-5f;

}  // namespace aftershade
