// Pixels in memory: rows from the top, channels interleaved, floats or unsigned integers.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
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

/// Gives memory that is zero without being written: the system makes its pages where they are first touched,
/// so the threads that fill an image make them, not its constructor.
template <typename Value>
struct ZeroedMemory {
    using value_type = Value;

    ZeroedMemory() = default;
    template <typename Other>
    explicit ZeroedMemory(const ZeroedMemory<Other>&) noexcept {}

    Value* allocate(std::size_t count) {
        if (void* const memory = std::calloc(count, sizeof(Value))) return static_cast<Value*>(memory);
        throw std::bad_alloc();
    }
    void deallocate(Value* memory, std::size_t) noexcept { std::free(memory); }
    /// Of vector(count): zero already.
    template <typename Made>
    void construct(Made*) noexcept {}
    template <typename Made, typename... From>
    void construct(Made* at, From&&... from) {
        ::new (static_cast<void*>(at)) Made(std::forward<From>(from)...);
    }
    bool operator==(const ZeroedMemory&) const = default;
};

/// [value type: safe to read from several threads]
class Image {
public:
    Image() = default;
    /// Zero-filled.
    Image(int width, int height, int channels, ComponentType type = ComponentType::float32)
        : width_(width), height_(height), channels_(channels) {
        const std::size_t count = std::size_t(width) * std::size_t(height) * std::size_t(channels);
        if (type == ComponentType::float32) values_ = Values<float>(count);
        else values_ = Values<std::uint32_t>(count);
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
    template <typename Value>
    using Values = std::vector<Value, ZeroedMemory<Value>>;

    std::size_t index(int x, int y, int channel) const {
        assert(x >= 0 && x < width_ && y >= 0 && y < height_ && channel >= 0 && channel < channels_);
        return (std::size_t(y) * std::size_t(width_) + std::size_t(x)) * std::size_t(channels_) +
               std::size_t(channel);
    }
    int width_ = 0;
    int height_ = 0;
    int channels_ = 0;
    std::variant<Values<float>, Values<std::uint32_t>> values_;
};

}  // namespace aftershade
