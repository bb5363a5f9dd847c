#include "framework/image/window.h"

#include <algorithm>
#include <cassert>

namespace aftershade {

namespace {

template <typename T>
void copy_overlap(std::span<const T> source, const Window& from, std::span<T> target, const Window& to,
                  int channels) {
    const int min_x = std::max(from.min_x, to.min_x), max_x = std::min(from.max_x, to.max_x);
    const int min_y = std::max(from.min_y, to.min_y), max_y = std::min(from.max_y, to.max_y);
    if (min_x > max_x) return;
    const auto offset = [channels](const Window& window, int x, int y) {
        return (std::size_t(y - window.min_y) * std::size_t(window.width()) + std::size_t(x - window.min_x)) *
               std::size_t(channels);
    };
    const std::size_t count = std::size_t(max_x - min_x + 1) * std::size_t(channels);
    for (int y = min_y; y <= max_y; ++y)
        std::copy_n(source.begin() + std::ptrdiff_t(offset(from, min_x, y)), count,
                    target.begin() + std::ptrdiff_t(offset(to, min_x, y)));
}

}  // namespace

Image place_in_window(Image image, const Window& from, const Window& to, float outside) {
    assert(image.width() == from.width() && image.height() == from.height());
    if (from == to) return image;
    Image placed(to.width(), to.height(), image.channels(), image.type());
    if (image.type() == ComponentType::float32) {
        std::fill(placed.floats().begin(), placed.floats().end(), outside);
        copy_overlap<float>(image.floats(), from, placed.floats(), to, image.channels());
    } else {
        copy_overlap<std::uint32_t>(image.uints(), from, placed.uints(), to, image.channels());
    }
    return placed;
}

}  // namespace aftershade
