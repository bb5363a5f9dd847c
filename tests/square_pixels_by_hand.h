// Square pixels for those of a capture that are not, and back, by loops over every pixel: what the renderer's
// passes are held against.
#pragma once

#include <cmath>
#include <string>

#include "framework/capture/capture.h"
#include "framework/image/role.h"

namespace aftershade::test {

/// Aspect 2: every pixel twice along x; 1.5: twice, once, twice, once.
class ByHand {
public:
    explicit ByHand(double aspect) : along_x_(aspect > 1), longer_(aspect > 1 ? aspect : 1 / aspect) {}

    Capture widened(const Capture& capture) const {
        Capture wide = capture;
        CaptureHeader& header = wide.header;
        header.pixel_aspect = 1;
        header.data_window = widened(header.data_window);
        header.display_window = widened(header.display_window);
        if (header.camera.jitter_px) (*header.camera.jitter_px)[along_x_ ? 0 : 1] *= longer_;
        for (auto& [role, image] : wide.images) image = widened(capture, role.name());
        return wide;
    }

    Image narrowed(const Image& wide, const std::string& name, const Capture& capture) const {
        const ChannelRole role = *find_role(name);
        const Window& data = capture.header.data_window;
        Image image(data.width(), data.height(), wide.channels(), wide.type());
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < image.channels(); ++c) {
                    const int begin = begin_of(x, y, data), end = begin_of(x + along_x_, y + !along_x_, data);
                    const auto at = [&](int place) {
                        return double(along_x_ ? wide.at(place, y, c) : wide.at(x, place, c));
                    };
                    double value = at((begin + end) / 2);
                    if (role.filterable) {
                        value = 0;
                        for (int i = begin; i < end; ++i) value += at(i) / (end - begin);
                    }
                    if (role.kind == RoleKind::motion && c == (along_x_ ? 0 : 1)) value /= longer_;
                    image.at(x, y, c) = float(value);
                }
        return image;
    }

private:
    int edge(int px) const { return int(std::floor(px * longer_ + 0.5)); }
    /// The first square pixel of a stored one, both counted from the data window's corner.
    int begin_of(int x, int y, const Window& data) const {
        return along_x_ ? edge(x + data.min_x) - edge(data.min_x) : edge(y + data.min_y) - edge(data.min_y);
    }
    /// The corner of the display window is (0, 0) in all tests.
    Window widened(const Window& window) const {
        if (along_x_) return {edge(window.min_x), window.min_y, edge(window.max_x + 1) - 1, window.max_y};
        return {window.min_x, edge(window.min_y), window.max_x, edge(window.max_y + 1) - 1};
    }
    Image widened(const Capture& capture, const std::string& role) const {
        const Image& image = capture.images.at(role);
        const Window& data = capture.header.data_window;
        const Window window = widened(data);
        Image wide(window.width(), window.height(), image.channels(), image.type());
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int i = begin_of(x, y, data); i < begin_of(x + along_x_, y + !along_x_, data); ++i)
                    for (int c = 0; c < image.channels(); ++c) {
                        const int to_x = along_x_ ? i : x, to_y = along_x_ ? y : i;
                        if (image.type() == ComponentType::uint32) {
                            wide.uint_at(to_x, to_y, c) = image.uint_at(x, y, c);
                            continue;
                        }
                        const bool is_stretched =
                            kind_of_role(role) == RoleKind::motion && c == (along_x_ ? 0 : 1);
                        wide.at(to_x, to_y, c) = image.at(x, y, c) * float(is_stretched ? longer_ : 1);
                    }
        return wide;
    }

    bool along_x_;
    double longer_;
};

}  // namespace aftershade::test
