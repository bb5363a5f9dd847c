// Pixels in memory: rows from the top, channels interleaved, floats or unsigned integers.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <utility>
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

/// Numbers in memory that is zero without being written: the system makes its pages where they are first
/// touched, so the threads that fill an image make them, not its constructor. A std::vector would walk over
/// all numbers where it begins and ends.
template <typename Value>
class PixelValues {
public:
    PixelValues() = default;
    explicit PixelValues(std::size_t count)
        : PixelValues(count, static_cast<Value*>(std::calloc(count, sizeof(Value)))) {}
    static PixelValues unfilled(std::size_t count) {
        return {count, static_cast<Value*>(std::malloc(count * sizeof(Value)))};
    }
    PixelValues(const PixelValues& other) : PixelValues(unfilled(other.size_)) {
        if (size_ > 0) std::memcpy(memory_.get(), other.memory_.get(), size_ * sizeof(Value));
    }
    PixelValues(PixelValues&& other) noexcept
        : size_(std::exchange(other.size_, 0)), memory_(std::move(other.memory_)) {}
    PixelValues& operator=(PixelValues other) noexcept {
        std::swap(size_, other.size_);
        std::swap(memory_, other.memory_);
        return *this;
    }
    ~PixelValues() = default;

    Value* begin() { return memory_.get(); }
    const Value* begin() const { return memory_.get(); }
    Value* end() { return memory_.get() + size_; }
    const Value* end() const { return memory_.get() + size_; }
    Value& operator[](std::size_t index) { return memory_.get()[index]; }
    const Value& operator[](std::size_t index) const { return memory_.get()[index]; }

private:
    PixelValues(std::size_t count, Value* memory) : size_(count), memory_(memory) {
        if (count > 0 && !memory) throw std::bad_alloc();
    }
    struct Free {
        void operator()(Value* memory) const noexcept { std::free(memory); }
    };
    std::size_t size_ = 0;
    std::unique_ptr<Value, Free> memory_;
};

/// [value type: safe to read from several threads]
class Image {
public:
    Image() = default;
    /// Zero-filled.
    Image(int width, int height, int channels, ComponentType type = ComponentType::float32)
        : width_(width), height_(height), channels_(channels) {
        const std::size_t count = std::size_t(width) * std::size_t(height) * std::size_t(channels);
        if (type == ComponentType::float32) values_ = PixelValues<float>(count);
        else values_ = PixelValues<std::uint32_t>(count);
    }
    /// Floats for who writes every one of them.
    static Image unfilled(int width, int height, int channels) {
        Image image;
        image.width_ = width;
        image.height_ = height;
        image.channels_ = channels;
        image.values_ =
            PixelValues<float>::unfilled(std::size_t(width) * std::size_t(height) * std::size_t(channels));
        return image;
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
    std::variant<PixelValues<float>, PixelValues<std::uint32_t>> values_;
};

}  // namespace aftershade
