#include "aftershade/image.h"

#include <cstdlib>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "framework/host/failures.h"
#include "framework/host/image_data.h"

namespace aftershade::host {

namespace {

template <typename Element>
void copy_rows(const ArrayView& view, std::ptrdiff_t stride, std::span<Element> to) {
    const auto* from = static_cast<const std::byte*>(view.data);
    const std::size_t row = std::size_t(view.width) * std::size_t(view.channels);
    for (int y = 0; y < view.height; ++y)
        std::memcpy(&to[std::size_t(y) * row], from + y * stride, row * sizeof(Element));
}

}  // namespace

Image::Image() noexcept = default;
Image::Image(const Image&) noexcept = default;
Image& Image::operator=(const Image&) noexcept = default;
Image::~Image() = default;

int Image::width() const noexcept {
    return data_ ? data_->pixels->width() : 0;
}
int Image::height() const noexcept {
    return data_ ? data_->pixels->height() : 0;
}
int Image::channels() const noexcept {
    return data_ ? data_->pixels->channels() : 0;
}
bool Image::empty() const noexcept {
    return !data_ || data_->pixels->empty();
}
ElementType Image::type() const noexcept {
    return data_ && data_->pixels->type() == ComponentType::uint32 ? ElementType::uint32
                                                                   : ElementType::float32;
}
const void* Image::data() const noexcept {
    if (empty()) return nullptr;
    if (type() == ElementType::uint32) return data_->pixels->uints().data();
    return data_->pixels->floats().data();
}

std::span<const float> Image::floats() const {
    if (!data_) return {};
    if (type() != ElementType::float32) fail(ErrorKind::usage, "this image holds uint32; take uints()");
    return data_->pixels->floats();
}

std::span<const std::uint32_t> Image::uints() const {
    if (!data_) return {};
    if (type() != ElementType::uint32) fail(ErrorKind::usage, "this image holds float32; take floats()");
    return data_->pixels->uints();
}

Image Access::image(std::shared_ptr<const aftershade::Image> pixels) {
    Image image;
    if (pixels && !pixels->empty())
        image.data_ = std::make_shared<const Image::Data>(Image::Data{std::move(pixels)});
    return image;
}

aftershade::Image copy_of(const ArrayView& view, const std::string& what) {
    const auto refuse = [&](const std::string& why) { fail_at(ErrorKind::usage, what, why); };
    if (!view.data) refuse("the array is null");
    if (reinterpret_cast<std::uintptr_t>(view.data) % sizeof(float) != 0)
        refuse("the array is not aligned to 4 bytes");
    if (view.type != ElementType::float32 && view.type != ElementType::uint32)
        refuse("the element type is neither float32 nor uint32");
    if (view.width < 1 || view.height < 1 || view.width > kMaxSide_px || view.height > kMaxSide_px)
        refuse(
            fmt::format("{} x {} px; each side must be from 1 to {}", view.width, view.height, kMaxSide_px));
    if (view.channels < 1 || view.channels > 4)
        refuse(fmt::format("{} channels; there must be from 1 to 4", view.channels));
    const std::ptrdiff_t row = std::ptrdiff_t(view.width) * view.channels * 4;
    const std::ptrdiff_t stride = view.row_stride == 0 ? row : view.row_stride;
    if (stride % 4 != 0) refuse(fmt::format("a row stride of {} bytes is not a multiple of 4", stride));
    if (std::abs(stride) < row)
        refuse(fmt::format("a row stride of {} bytes is below the {} bytes that a row takes", stride, row));
    if (view.size_bytes != 0 && stride < 0) refuse("size_bytes must be 0 where the row stride is negative");
    const std::uint64_t needed =
        std::uint64_t(std::abs(stride)) * std::uint64_t(view.height - 1) + std::uint64_t(row);
    if (view.size_bytes != 0 && view.size_bytes < needed)
        refuse(fmt::format("the array has {} bytes; {} x {} px of {} channels take {}", view.size_bytes,
                           view.width, view.height, view.channels, needed));
    const bool is_uint = view.type == ElementType::uint32;
    aftershade::Image image(view.width, view.height, view.channels,
                            is_uint ? ComponentType::uint32 : ComponentType::float32);
    if (is_uint) copy_rows(view, stride, image.uints());
    else copy_rows(view, stride, image.floats());
    return image;
}

}  // namespace aftershade::host
