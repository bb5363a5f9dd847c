#include "framework/compare/difference_picture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "framework/base/error.h"
#include "framework/file/exr_file.h"
#include "framework/file/png_file.h"
#include "framework/image/window.h"

namespace aftershade {

namespace {

namespace fs = std::filesystem;

// matplotlib's magma at seventeenths (Smith and van der Walt 2015, CC0), 0xrrggbb; between them it is off by
// less than 3 / 255.
constexpr std::array<std::uint32_t, 18> kMagma = {0x000004, 0x090720, 0x1a1042, 0x311165, 0x4a1079, 0x621980,
                                                  0x792282, 0x912b81, 0xaa337d, 0xc23b75, 0xd9466b, 0xec5860,
                                                  0xf7725c, 0xfc8e64, 0xfeaa74, 0xfec68a, 0xfde2a3, 0xfcfdbf};

float difference_of(float reference, float test, const DifferenceOptions& options) {
    if (reference == test) return 0;  // infinities too
    if (std::bit_cast<std::uint32_t>(reference) == std::bit_cast<std::uint32_t>(test)) return 0;
    const double difference = (double(reference) - double(test)) * options.scale;
    return float(options.absolute ? std::abs(difference) : difference);
}

/// "left:forward.uv" has its part before the channels' own names.
std::string part_prefix(const std::string& label) {
    const std::size_t colon = label.find(':');
    return colon == std::string::npos ? "" : label.substr(0, colon) + ".";
}

std::string layer_prefix(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? "" : channel.substr(0, dot + 1);
}

const FlipResult* flip_of(const LayerComparison& layer) {
    if (layer.hdr_flip) return &*layer.hdr_flip;
    return layer.ldr_flip ? &*layer.ldr_flip : nullptr;
}

Window hull(const Window& a, const Window& b) {
    return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
            std::max(a.max_y, b.max_y)};
}

/// No difference where none is looked at.
void clear_left_out(const PixelAreas& areas, Image& difference) {
    for (int y = 0; y < difference.height(); ++y)
        for (int x = 0; x < difference.width(); ++x)
            if (areas.is_left_out(x, y, difference.width()))
                for (int c = 0; c < difference.channels(); ++c) difference.at(x, y, c) = 0;
}

}  // namespace

DisplayColor magma_color(float t) {
    const float at = (t > 0 ? std::min(t, 1.0f) : 0) * float(kMagma.size() - 1);
    const auto low = std::min(std::size_t(at), kMagma.size() - 2);
    const float share = at - float(low);
    DisplayColor color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const int shift = 16 - 8 * int(c);
        const auto byte = [&](std::size_t i) { return float((kMagma[i] >> shift) & 255u) / 255; };
        color[c] = byte(low) + share * (byte(low + 1) - byte(low));
    }
    return color;
}

Image difference_image(const Image& reference, const Image& test, LayerRole role,
                       const DifferenceOptions& options) {
    Image result(reference.width(), reference.height(), reference.channels());
    const bool integers = reference.type() == ComponentType::uint32;
    for (std::size_t i = 0; i < result.floats().size(); ++i) {
        const bool ids_differ = integers ? reference.uints()[i] != test.uints()[i]
                                         : std::bit_cast<std::uint32_t>(reference.floats()[i]) !=
                                               std::bit_cast<std::uint32_t>(test.floats()[i]);
        if (integers || role == LayerRole::id) result.floats()[i] = ids_differ ? float(options.scale) : 0;
        else result.floats()[i] = difference_of(reference.floats()[i], test.floats()[i], options);
    }
    return result;
}

void ComparisonPictures::add(const LayerComparison& layer, const LayerImages& images) {
    if (images.reference.empty()) return;
    const bool colors = is_perceptual(layer.role);
    const std::string prefix = part_prefix(layer.label);
    if (difference_) {
        Plane plane{
            {}, difference_image(images.reference, images.test, layer.role, options_), layer.window, colors};
        clear_left_out(images.areas, plane.image);
        for (const std::string& channel : layer.channels) plane.channels.push_back(prefix + channel);
        differences_.push_back(std::move(plane));
    }
    if (const FlipResult* flip = flip_of(layer); heat_map_ && flip)
        flips_.push_back(
            {{prefix + layer_prefix(layer.channels[0]) + "flip"}, flip->error, layer.window, true});
    if (side_by_side_) rows_.push_back(side_by_side_row(layer, images));
}

void ComparisonPictures::write_planes(const fs::path& path, const std::vector<Plane>& planes) {
    Window window = planes.front().window;
    for (const Plane& plane : planes) window = hull(window, plane.window);
    std::vector<Image> images;
    for (const Plane& plane : planes) images.push_back(place_in_window(plane.image, plane.window, window, 0));
    std::vector<ExrOutputChannel> channels;
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t c = 0; c < planes[i].channels.size(); ++c)
            channels.push_back({planes[i].channels[c], PixelType::float32, &images[i], int(c)});
    ExrWriteOptions options;
    options.data_window = options.display_window = window;
    write_exr(path, channels, options);
}

void ComparisonPictures::write_difference(const fs::path& path) const {
    if (differences_.empty())
        throw Error(ErrorKind::output, path.string() + ": the files have no pixel in common to subtract");
    if (path.extension() != ".png") {
        write_planes(path, differences_);
        return;
    }
    auto chosen = std::ranges::find(differences_, true, &Plane::colors);
    if (chosen == differences_.end()) chosen = differences_.begin();
    const Image& difference = chosen->image;
    const int stored = difference.channels();
    Image picture(difference.width(), difference.height(), 3);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                // Two channels are red and green; one is grey.
                const bool absent = stored == 2 && c == 2;
                const float value = absent ? 0 : difference.at(x, y, std::min(c, stored - 1));
                // What cannot be subtracted is the brightest.
                picture.at(x, y, c) = std::isnan(value) ? 1 : std::abs(value);
            }
    write_png(path, picture);
}

void ComparisonPictures::write_heat_map(const fs::path& path) const {
    if (flips_.empty())
        throw Error(ErrorKind::output,
                    path.string() + ": no layer has FLIP to draw (only layers with colours have)");
    if (path.extension() != ".png") {
        write_planes(path, flips_);
        return;
    }
    const Image& error = flips_.front().image;
    Image picture(error.width(), error.height(), 3);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            fill_rectangle(picture, x, y, 1, 1, magma_color(error.at(x, y, 0)));
    write_png(path, picture);
}

void ComparisonPictures::write_side_by_side(const fs::path& path, const std::string& title) const {
    if (rows_.empty())
        throw Error(ErrorKind::output, path.string() + ": the files have no pixel in common to show");
    write_png(path, draw_side_by_side(rows_, title));
}

}  // namespace aftershade
