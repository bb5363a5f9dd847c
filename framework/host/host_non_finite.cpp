#include "framework/host/host_non_finite.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "framework/host/failures.h"
#include "framework/image/role.h"

namespace aftershade::host {

namespace {

NonFiniteInfo info_of_pixels(const std::string& image, bool of_capture, const NonFinitePixels& pixels) {
    return {image,
            of_capture,
            pixels.x,
            pixels.y,
            std::int64_t(pixels.nan),
            std::int64_t(pixels.infinite),
            pixels.mended > 0};
}

}  // namespace

void refuse_non_finite(const NonFiniteInfo& found) {
    fail_at(
        ErrorKind::capture, found.image,
        fmt::format("the {} has {} NaN and {} infinite pixels, the first at ({}, {}) (NonFinite::mend "
                    "replaces such pixels)",
                    found.of_capture ? "capture" : "result", found.nan, found.infinite, found.x, found.y));
}

std::shared_ptr<const Capture::Data> meet_non_finite(std::shared_ptr<const Capture::Data> capture,
                                                     NonFinite policy, std::vector<NonFiniteInfo>& found) {
    if (policy == NonFinite::ignore) return capture;
    const aftershade::Window& window = capture->capture.header.data_window;
    std::vector<NonFiniteInfo> here;
    for (const auto& [role, image] : capture->capture.images)
        if (NonFinitePixels pixels = find_non_finite(image, std::isinf(find_role(role)->outside))) {
            pixels.x += window.min_x;
            pixels.y += window.min_y;
            here.push_back(info_of_pixels(role.name(), true, pixels));
        }
    if (!here.empty() && policy == NonFinite::fail) refuse_non_finite(here.front());
    if (!here.empty() && policy == NonFinite::mend) {
        auto mended = std::make_shared<Capture::Data>(*capture);
        apply_nan_policy(NanPolicy::mend, mended->capture);
        here = non_finite_of(mended->capture);
        capture = std::move(mended);
    }
    found.insert(found.end(), here.begin(), here.end());
    return capture;
}

std::vector<NonFiniteInfo> non_finite_of(const aftershade::Capture& capture) {
    std::vector<NonFiniteInfo> found;
    for (const auto& [role, pixels] : capture.non_finite)
        found.push_back(info_of_pixels(role.name(), true, pixels));
    return found;
}

std::vector<NonFiniteInfo> non_finite_of(const std::vector<NonFiniteOutput>& outputs) {
    std::vector<NonFiniteInfo> found;
    for (const NonFiniteOutput& output : outputs)
        found.push_back(info_of_pixels(output.name, false, output.pixels));
    return found;
}

}  // namespace aftershade::host
