#include "framework/file/picture.h"

#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/file/exr_file.h"
#include "framework/file/jpeg_file.h"
#include "framework/file/png_file.h"
#include "framework/image/srgb.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr int kRgba = 4;
constexpr int kAlpha = 3;
const std::vector<std::string> kExrChannels = {"R", "G", "B", "A"};

Image read_exr_picture(const fs::path& path) {
    const ExrFile file(path);
    const ExrPart& part = file.parts().at(0);
    const auto has = [&](const std::string& name) {
        return std::any_of(part.channels.begin(), part.channels.end(),
                           [&](const ExrChannel& channel) { return channel.name == name; });
    };
    std::vector<std::string> present;
    std::copy_if(kExrChannels.begin(), kExrChannels.end(), std::back_inserter(present), has);
    if (!has("R") && !has("G") && !has("B") && has("Y")) return file.read_luminance_chroma(0);
    if (present.empty() || present[0] == "A") {
        std::vector<std::string> names;
        for (const ExrChannel& channel : part.channels) names.push_back(channel.name);
        throw Error(ErrorKind::capture, path.string() +
                                            ": the first part has no channel R, G, B or Y; it has " +
                                            list_of_names(names, "and"));
    }
    const Image stored = file.read_floats(0, present);
    Image image(stored.width(), stored.height(), kRgba);
    for (int c = 0; c < kRgba; ++c) {
        const auto found = std::find(present.begin(), present.end(), kExrChannels[std::size_t(c)]);
        const int source = int(found - present.begin());
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                image.at(x, y, c) =
                    found != present.end() ? stored.at(x, y, source) : (c == kAlpha ? 1.0f : 0.0f);
    }
    return image;
}

Image read_encoded_picture(const fs::path& path, PictureSpace space) {
    PngColor color;
    const Image stored = is_jpeg_file(path) ? read_jpeg(path) : read_png(path, &color);
    if (space == PictureSpace::srgb && !color.is_srgb())
        throw Error(ErrorKind::capture, path.string() + ": its colours are not sRGB but of " + color.space +
                                            ", which is not converted; save the picture as sRGB");
    const auto light = [&](float value) {
        return color.gamma ? std::pow(double(value), 1 / *color.gamma) : decode_srgb(double(value));
    };
    const bool grey = stored.channels() <= 2;
    const bool has_alpha = stored.channels() % 2 == 0;
    Image image(stored.width(), stored.height(), kRgba);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const float alpha = has_alpha ? stored.at(x, y, stored.channels() - 1) : 1.0f;
            for (int c = 0; c < kAlpha; ++c) {
                const float value = stored.at(x, y, grey ? 0 : c);
                image.at(x, y, c) = space == PictureSpace::data ? value : float(light(value) * double(alpha));
            }
            image.at(x, y, kAlpha) = alpha;
        }
    return image;
}

}  // namespace

Image read_picture(const fs::path& path, PictureSpace space) {
    return is_exr_file(path) ? read_exr_picture(path) : read_encoded_picture(path, space);
}

Image decode_picture(const std::string& name, std::string_view bytes) {
    if (bytes.starts_with("\x89PNG")) return decode_png(name, bytes);
    if (bytes.starts_with("\xff\xd8\xff")) return decode_jpeg(name, bytes);
    throw Error(ErrorKind::capture, name + ": neither PNG nor JPEG; save it as one of these");
}

}  // namespace aftershade
