#include "framework/compare/perceptual.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "framework/base/parallel.h"
#include "framework/compare/ssim.h"
#include "framework/image/srgb.h"

namespace aftershade {

namespace {

/// Most encoded pictures have 8 bits, whose powers are soon told.
float decoded(float value) {
    static const std::array<float, 256> of_bytes = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i) table[i] = float(decode_srgb(double(i) / 255));
        return table;
    }();
    const float byte = std::round(value * 255);
    if (byte >= 0 && byte <= 255 && byte / 255.0f == value) return of_bytes[std::size_t(byte)];
    return float(decode_srgb(std::clamp(value, 0.0f, 1.0f)));
}

float encoded(float value, LayerRole role) {
    const float clamped = std::clamp(value, 0.0f, 1.0f);
    if (role == LayerRole::display) return clamped;
    return clamped <= 0.0031308f ? 12.92f * clamped : 1.055f * std::pow(clamped, 1 / 2.4f) - 0.055f;
}

/// What SSIM sees of both images.
std::array<Image, 2> encoded_pair(const Image& reference, const Image& test, LayerRole role, int threads) {
    std::array<Image, 2> pair = {Image(reference.width(), reference.height(), reference.channels()),
                                 Image(reference.width(), reference.height(), reference.channels())};
    const std::size_t row = std::size_t(reference.width()) * std::size_t(reference.channels());
    for_each_row(reference.height(), thread_count(threads), [&](int y) {
        for (std::size_t i = std::size_t(y) * row; i < std::size_t(y + 1) * row; ++i) {
            const float r = reference.floats()[i], t = test.floats()[i];
            const bool same = r == t || (std::isnan(r) && std::isnan(t));
            const bool finite = std::isfinite(r) && std::isfinite(t);
            pair[0].floats()[i] = finite ? encoded(r, role) : 0;
            pair[1].floats()[i] = finite ? encoded(t, role) : (same ? 0.0f : 1.0f);
        }
    });
    return pair;
}

struct Choice {
    bool ldr = false, hdr = false;
    Choice(FlipChoice choice, LayerRole role) {
        const bool light = role == LayerRole::color;
        ldr = choice == FlipChoice::ldr || choice == FlipChoice::both ||
              (choice == FlipChoice::automatic && !light);
        hdr = choice == FlipChoice::hdr || choice == FlipChoice::both ||
              (choice == FlipChoice::automatic && light);
    }
};

FlipResult no_difference(const Image& image) {
    FlipResult result;
    result.error = Image(image.width(), image.height(), 1);
    return result;
}

void measure_flip(const Image& reference, const Image& test, LayerRole role, bool equal,
                  const CompareRules& rules, LayerComparison& comparison) {
    const Choice choice(rules.flip_choice, role);
    if (!choice.ldr && !choice.hdr) return;
    FlipOptions options = rules.flip;
    options.threads = thread_count(rules.threads);
    const Image r = linear_rgb(reference, role, rules.threads);
    const Image t = linear_rgb(test, role, rules.threads);
    if (choice.ldr) comparison.ldr_flip = equal ? no_difference(r) : ldr_flip(r, t, options);
    if (!choice.hdr) return;
    if (!equal) {
        comparison.hdr_flip = hdr_flip(r, t, options);
        return;
    }
    const FlipExposures exposures = flip_exposures(r, t, options);
    comparison.hdr_flip = no_difference(r);
    comparison.hdr_flip->start_exposure = exposures.start;
    comparison.hdr_flip->stop_exposure = exposures.stop;
    comparison.hdr_flip->exposures = exposures.count;
}

/// The test image with the reference's values where pixels are left out.
Image with_reference_values(const LayerImages& images) {
    Image test = images.test;
    for (int y = 0; y < test.height(); ++y)
        for (int x = 0; x < test.width(); ++x) {
            if (!images.areas.is_left_out(x, y, test.width())) continue;
            for (int c = 0; c < test.channels(); ++c) test.at(x, y, c) = images.reference.at(x, y, c);
        }
    return test;
}

/// Of the pixels that count alone.
void leave_out(const PixelAreas& areas, FlipResult& flip) {
    double sum = 0;
    std::uint64_t pixels = 0;
    flip.max = -1;
    for (int y = 0; y < flip.error.height(); ++y)
        for (int x = 0; x < flip.error.width(); ++x) {
            float& error = flip.error.at(x, y, 0);
            if (areas.is_left_out(x, y, flip.error.width())) {
                error = 0;
                continue;
            }
            sum += error, ++pixels;
            if (error > flip.max) flip.max = error, flip.max_x = x, flip.max_y = y;
        }
    flip.mean = sum / double(pixels);
}

/// Keeps pixels that are not finite: a matrix would spread one channel's fault over all three.
Image in_rec709(const Image& image, const Chromaticities& primaries) {
    Image converted = image;
    convert_colors(converted, conversion_matrix(primaries, kRec709));
    const std::span<const float> stored = image.floats();
    for (std::size_t i = 0; i + 2 < stored.size(); i += 3)
        if (!std::ranges::all_of(stored.subspan(i, 3), [](float value) { return std::isfinite(value); }))
            std::ranges::copy(stored.subspan(i, 3), converted.floats().begin() + std::ptrdiff_t(i));
    return converted;
}

std::optional<LayerImages> in_srgb(const LayerImages& images) {
    if (images.reference_display == kSrgbDisplay && images.test_display == kSrgbDisplay) return std::nullopt;
    LayerImages converted = images;
    for (const auto& [image, encoding] : {std::pair{&converted.reference, &converted.reference_display},
                                          {&converted.test, &converted.test_display}}) {
        if (*encoding != kSrgbDisplay) encode_display_as_srgb(*image, *encoding);
        *encoding = kSrgbDisplay;
    }
    return converted;
}

/// Decodes values of sRGB, which may be above 1.
void decode(LayerImages& images) {
    for (Image* image : {&images.reference, &images.test})
        for (float& value : image->floats()) value = float(decode_srgb(double(value)));
}

}  // namespace

std::optional<LayerImages> in_rec709(const LayerImages& images, LayerRole role) {
    const int channels = images.reference.channels();
    if (images.reference.type() != ComponentType::float32) return std::nullopt;
    if (role == LayerRole::display && (channels == 1 || channels == 3)) return in_srgb(images);
    if (channels != 3 || role != LayerRole::color ||
        (images.reference_primaries == kRec709 && images.test_primaries == kRec709))
        return std::nullopt;
    LayerImages converted = images;
    for (const auto& [image, primaries] : {std::pair{&converted.reference, &converted.reference_primaries},
                                           {&converted.test, &converted.test_primaries}}) {
        if (*primaries != kRec709) *image = in_rec709(*image, *primaries);
        *primaries = kRec709;
    }
    return converted;
}

Image linear_rgb(const Image& image, LayerRole role, int threads) {
    Image rgb(image.width(), image.height(), 3);
    const auto stored = std::size_t(image.channels());
    const auto width = std::size_t(image.width());
    for_each_row(image.height(), thread_count(threads), [&](int y) {
        for (std::size_t i = std::size_t(y) * width; i < std::size_t(y + 1) * width; ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const float value = image.floats()[i * stored + std::min(c, stored - 1)];
                const bool decode = role == LayerRole::display && std::isfinite(value);
                rgb.floats()[i * 3 + c] = decode ? decoded(value) : value;
            }
    });
    return rgb;
}

void measure_perceptually(const LayerImages& images, const CompareRules& rules, LayerComparison& comparison) {
    const int channels = images.reference.channels();
    const bool picture = channels == 1 || channels == 3;
    if (!is_perceptual(comparison.role) || !picture || images.reference.type() != ComponentType::float32)
        return;
    std::optional<LayerImages> converted = in_rec709(images, comparison.role);
    const bool is_hdr = converted && (images.reference_display.is_hdr() || images.test_display.is_hdr());
    if (is_hdr) decode(*converted);
    const LayerRole role = is_hdr ? LayerRole::color : comparison.role;
    const LayerImages& seen = converted ? *converted : images;
    const Image& reference = seen.reference;
    const bool equal = comparison.differences.bits_equal &&
                       (!converted || (images.reference_primaries == images.test_primaries &&
                                       images.reference_display == images.test_display));
    const bool leaves_out = comparison.differences.left_out > 0;
    const Image substituted = leaves_out ? with_reference_values(seen) : Image();
    const Image& test = leaves_out ? substituted : seen.test;
    measure_flip(reference, test, role, equal, rules, comparison);
    if (leaves_out)
        for (std::optional<FlipResult>* flip : {&comparison.ldr_flip, &comparison.hdr_flip})
            if (*flip) leave_out(images.areas, **flip);
    if (!rules.ssim) return;
    const bool scales = std::min(reference.width(), reference.height()) >= kMsSsimMinSide_px && !leaves_out;
    if (equal) {
        comparison.ssim = 1;
        if (rules.ssim_map) {
            comparison.ssim_map = Image(reference.width(), reference.height(), 1);
            std::ranges::fill(comparison.ssim_map.floats(), 1.0f);
        }
        if (scales) comparison.ms_ssim = 1;
        return;
    }
    const auto [r, t] = encoded_pair(reference, test, role, rules.threads);
    const SsimFigures figures = ssim_figures(r, t, rules.threads, leaves_out ? images.areas : PixelAreas{},
                                             rules.ssim_map ? &comparison.ssim_map : nullptr);
    if (figures.measured) comparison.ssim = figures.ssim;
    comparison.ms_ssim = figures.ms_ssim;
}

}  // namespace aftershade
