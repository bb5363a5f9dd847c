#include "framework/scene/rate_image.h"

#include <array>
#include <cmath>

#include "framework/file/exr_file.h"
#include "framework/file/png_file.h"
#include "framework/image/false_color.h"
#include "framework/scene/visibility.h"

namespace aftershade::scene {

void write_rate_exr(const std::filesystem::path& path, const Image& rate) {
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, rate.width() - 1, rate.height() - 1};
    const std::array channels = {ExrOutputChannel{"rate", PixelType::float32, &rate, 0}};
    write_exr(path, channels, options);
}

void write_rate_png(const std::filesystem::path& path, const Image& rate) {
    Image picture(rate.width(), rate.height(), 3);
    for (int y = 0; y < rate.height(); ++y)
        for (int x = 0; x < rate.width(); ++x) {
            const float part = std::log2(1 + rate.at(x, y, 0)) / std::log2(1.0f + kMaxVisibilitySamples);
            const DisplayColor color = ramp_color(part);
            for (int c = 0; c < 3; ++c) picture.at(x, y, c) = color[std::size_t(c)];
        }
    write_png(path, picture);
}

}  // namespace aftershade::scene
