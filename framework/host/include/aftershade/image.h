// Pixels: those that the library gives, and arrays of the caller's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "aftershade/export.h"

namespace aftershade::host {

class Access;

enum class ElementType {
    float32,  ///< IEEE single precision
    uint32    ///< ids: the role object_id
};

/// A rectangle of pixels; x to the right, y down, as OpenEXR places data and display windows.
struct Window {
    int x = 0, y = 0;           ///< its upper left pixel; from -1e6 to 1e6
    int width = 0, height = 0;  ///< px; from 1 to HostLimits::max_side_px
    bool operator==(const Window&) const = default;
};

/// Immutable pixels: rows from the top, channels interleaved, no padding. Copies share them, and they live as
/// long as the last copy. [value type; thread-safe]
class AFTERSHADE_API Image {
public:
    /// No pixels: width, height and channels are 0.
    Image() noexcept;
    Image(const Image&) noexcept;
    Image& operator=(const Image&) noexcept;
    ~Image();

    int width() const noexcept;     ///< px
    int height() const noexcept;    ///< px
    int channels() const noexcept;  ///< 1 to 4
    ElementType type() const noexcept;
    bool empty() const noexcept;
    /// The first pixel; nullptr for an empty image. A row takes width * channels * 4 bytes.
    const void* data() const noexcept;
    /// width * height * channels values. Throws Error(usage) where the type is another one.
    std::span<const float> floats() const;
    std::span<const std::uint32_t> uints() const;

    struct AFTERSHADE_LOCAL Data;  ///< what the library keeps; no part of the API

private:
    friend class Access;
    std::shared_ptr<const Data> data_;
};

/// Pixels of the caller's, which the call that takes them copies: they need not outlive it.
struct ArrayView {
    const void* data = nullptr;  ///< the first channel of the upper left pixel; aligned to 4 bytes; not null
    ElementType type = ElementType::float32;
    int width = 0;     ///< px; at least 1
    int height = 0;    ///< px; at least 1
    int channels = 0;  ///< interleaved; from 1 to 4
    /// Bytes from one row to the next: a multiple of 4, and at least width * channels * 4 in magnitude;
    /// negative where rows lie from the bottom up, and `data` is still the top one's. 0: no padding.
    std::ptrdiff_t row_stride = 0;
    /// Bytes that may be read from `data` on; the size is checked against them; 0: not checked. Must be 0
    /// where row_stride is negative.
    std::size_t size_bytes = 0;
};

/// A view without padding. Its use checks the size against the array's.
inline ArrayView view_of(std::span<const float> values, int width, int height, int channels) noexcept {
    return {values.data(), ElementType::float32, width, height, channels, 0, values.size_bytes()};
}
inline ArrayView view_of(std::span<const std::uint32_t> values, int width, int height,
                         int channels = 1) noexcept {
    return {values.data(), ElementType::uint32, width, height, channels, 0, values.size_bytes()};
}

}  // namespace aftershade::host
