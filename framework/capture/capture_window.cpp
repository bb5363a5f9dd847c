#include "framework/capture/capture_window.h"

#include <algorithm>
#include <utility>

#include "framework/base/error.h"
#include "framework/image/role.h"
#include "framework/image/window.h"

namespace aftershade {

namespace {

int floor_divided(int value, int by) {
    return value >= 0 ? value / by : -((-value + by - 1) / by);
}

/// The pixels of one block, as a window of the full image.
Window block_of(int x, int y, const Window& display, int divisor) {
    const int left = display.min_x + (x - display.min_x) * divisor;
    const int top = display.min_y + (y - display.min_y) * divisor;
    return {left, top, left + divisor - 1, top + divisor - 1};
}

void average(const Image& image, const Window& data, const Window& block, float* result) {
    const int channels = image.channels();
    for (int c = 0; c < channels; ++c) {
        double sum = 0;
        for (int y = block.min_y; y <= block.max_y; ++y)
            for (int x = block.min_x; x <= block.max_x; ++x)
                sum += double(image.at(x - data.min_x, y - data.min_y, c));
        result[c] = float(sum / (double(block.width()) * block.height()));
    }
}

Image scaled(const Image& image, const ChannelRole& role, const CaptureHeader& header, const Window& window,
             int divisor) {
    Image result(window.width(), window.height(), image.channels(), image.type());
    const Window& data = header.data_window;
    const bool is_in_px = role.kind == RoleKind::motion;
    for (int y = window.min_y; y <= window.max_y; ++y)
        for (int x = window.min_x; x <= window.max_x; ++x) {
            const Window whole = block_of(x, y, header.display_window, divisor);
            const Window block = intersection(whole, data);
            const int to_x = x - window.min_x, to_y = y - window.min_y;
            if (role.filterable && image.type() == ComponentType::float32) {
                average(image, data, block, &result.at(to_x, to_y, 0));
                continue;
            }
            const int from_x = std::clamp(whole.min_x + divisor / 2, block.min_x, block.max_x) - data.min_x;
            const int from_y = std::clamp(whole.min_y + divisor / 2, block.min_y, block.max_y) - data.min_y;
            for (int c = 0; c < image.channels(); ++c) {
                if (image.type() == ComponentType::uint32)
                    result.uint_at(to_x, to_y, c) = image.uint_at(from_x, from_y, c);
                else
                    result.at(to_x, to_y, c) =
                        image.at(from_x, from_y, c) / (is_in_px ? float(divisor) : 1.0f);
            }
        }
    return result;
}

std::string text_of(const Window& window) {
    return std::to_string(window.width()) + " x " + std::to_string(window.height()) + " px at (" +
           std::to_string(window.min_x) + ", " + std::to_string(window.min_y) + ")";
}

}  // namespace

Window whole_picture(const CaptureHeader& header) {
    const Window &a = header.display_window, &b = header.data_window;
    return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
            std::max(a.max_y, b.max_y)};
}

std::string region_fault(const CaptureHeader& header, const Window& region) {
    const Window within = intersection(region, whole_picture(header));
    if (within == region) return "";
    return "the region, " + text_of(region) + ", reaches beyond the picture, " +
           text_of(whole_picture(header)) + "; " + text_of(within) + " of it are written";
}

Window intersection(const Window& a, const Window& b) {
    return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
            std::min(a.max_y, b.max_y)};
}

Window scaled_window(const Window& window, const Window& display, int divisor) {
    const auto side = [&](int value, int origin) { return origin + floor_divided(value - origin, divisor); };
    return {side(window.min_x, display.min_x), side(window.min_y, display.min_y),
            side(window.max_x, display.min_x), side(window.max_y, display.min_y)};
}

void scale_capture(Capture& capture, int divisor) {
    if (divisor == 1) return;
    CaptureHeader& header = capture.header;
    const Window data = scaled_window(header.data_window, header.display_window, divisor);
    for (auto& [name, image] : capture.images) image = scaled(image, *find_role(name), header, data, divisor);
    header.display_window = scaled_window(header.display_window, header.display_window, divisor);
    header.data_window = data;
    if (header.camera.jitter_px)
        for (double& offset_px : *header.camera.jitter_px) offset_px /= divisor;
}

void crop_capture(Capture& capture, const Window& window) {
    CaptureHeader& header = capture.header;
    const Window common = intersection(window, header.data_window);
    if (common.width() < 1 || common.height() < 1)
        throw Error(ErrorKind::capture, header.path.string() +
                                            ": the region has no pixel of the data window (" +
                                            text_of(window) + " against " + text_of(header.data_window) +
                                            "; choose one within it)");
    if (common == header.data_window) return;
    for (auto& [name, image] : capture.images)
        image = place_in_window(std::move(image), header.data_window, common, 0);
    header.data_window = common;
}

}  // namespace aftershade
