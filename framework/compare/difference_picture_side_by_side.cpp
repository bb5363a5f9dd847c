#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "framework/base/text.h"
#include "framework/compare/difference_picture.h"
#include "framework/compare/perceptual.h"
#include "framework/image/false_color.h"

namespace aftershade {

namespace {

constexpr int kMargin_px = 16;
constexpr int kTextScale = 2;
constexpr int kLine_px = kTextLineHeight_px * kTextScale;
constexpr int kMinColumn_px = 320;  // for the captions, where pictures are narrower
constexpr int kMaxEnlargement = 16;

// Blender writes 1e10 m, and others more; no scene is that deep, and its surfaces are to be told apart.
constexpr float kNothingHitFrom = 1e9f;

constexpr DisplayColor kPaper = {0.11f, 0.11f, 0.12f};
constexpr DisplayColor kBright = {1, 1, 1};
constexpr DisplayColor kQuiet = {0.72f, 0.72f, 0.74f};
constexpr DisplayColor kLeftOut = {0.16f, 0.3f, 0.55f};  // no colour of magma

/// Renderers write ids as floats; hashes of names are floats that are no integers.
std::uint32_t id_at(const Image& image, std::size_t index) {
    if (image.type() == ComponentType::uint32) return image.uints()[index];
    const float value = image.floats()[index];
    const bool whole = value >= 0 && value < 4294967040.0f && value == std::floor(value);
    return whole ? std::uint32_t(value) : std::bit_cast<std::uint32_t>(value);
}

/// Both images in one, the test image below, so that one scale of colours is fitted to both. Grey light gets
/// three channels, which FalseColor exposes.
Image stacked(const LayerImages& images, LayerRole role) {
    const Image& r = images.reference;
    if (role == LayerRole::id && r.channels() == 1) {
        Image both(r.width(), 2 * r.height(), 1, ComponentType::uint32);
        const std::size_t pixels = both.uints().size() / 2;
        for (std::size_t i = 0; i < pixels; ++i) {
            both.uints()[i] = id_at(r, i);
            both.uints()[pixels + i] = id_at(images.test, i);
        }
        return both;
    }
    const bool integers = r.type() == ComponentType::uint32;
    const bool widen = role == LayerRole::color && r.channels() < 3;
    Image both(r.width(), 2 * r.height(), widen ? 3 : r.channels());
    for (int y = 0; y < both.height(); ++y)
        for (int x = 0; x < r.width(); ++x)
            for (int c = 0; c < both.channels(); ++c) {
                const Image& source = y < r.height() ? r : images.test;
                const int channel = std::min(c, r.channels() - 1), line = y % r.height();
                const float value =
                    integers ? float(source.uint_at(x, line, channel)) : source.at(x, line, channel);
                const bool nothing_hit = role == LayerRole::depth && value >= kNothingHitFrom;
                both.at(x, y, c) = nothing_hit ? std::numeric_limits<float>::infinity() : value;
            }
    return both;
}

/// A role of that kind: any of them has the kind's colours.
const std::string& role_of_kind(RoleKind kind) {
    const auto roles = channel_roles();
    return std::ranges::find(roles, kind, &ChannelRole::kind)->name;
}

std::string false_color_role(const LayerComparison& layer, const Image& image) {
    const std::string data(kDataRole);
    switch (layer.role) {
        case LayerRole::color: return kColorRole;
        case LayerRole::alpha: return role_of_kind(RoleKind::coverage);
        case LayerRole::depth: return image.channels() == 1 ? role_of_kind(RoleKind::distance) : data;
        case LayerRole::velocity: return image.channels() >= 2 ? role_of_kind(RoleKind::motion) : data;
        default: break;
    }
    const std::string name = lower_case(layer.label);
    for (const ChannelRole& role : channel_roles())
        if ((role.kind == RoleKind::direction || role.kind == RoleKind::place) &&
            image.channels() == role.channels && name.find(role.name) != std::string::npos)
            return role.name;
    return data;
}

using ColorAt = std::function<DisplayColor(int x, int y)>;

/// `color` of an image of that size, reduced or enlarged by a whole factor. Reduced pixels take the mean, or
/// of differences the brightest, so that a single bad pixel is seen.
Image tile(int width, int height, const ColorAt& color, bool brightest) {
    const int reduce = (width + kSideBySideWidth_px - 1) / kSideBySideWidth_px;
    const int enlarge = reduce > 1 ? 1 : std::clamp(kMinColumn_px / width, 1, kMaxEnlargement);
    const int columns = (width + reduce - 1) / reduce, rows = (height + reduce - 1) / reduce;
    Image picture(columns * enlarge, rows * enlarge, 3);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            DisplayColor sum{}, best{};
            int count = 0;
            for (int v = y * reduce; v < std::min((y + 1) * reduce, height); ++v)
                for (int u = x * reduce; u < std::min((x + 1) * reduce, width); ++u, ++count) {
                    const DisplayColor one = color(u, v);
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += one[c];
                    if (one[0] + one[1] + one[2] > best[0] + best[1] + best[2]) best = one;
                }
            for (float& component : sum) component /= float(count);
            fill_rectangle(picture, x * enlarge, y * enlarge, enlarge, enlarge, brightest ? best : sum);
        }
    return picture;
}

DisplayColor verdict_color(Verdict verdict) {
    if (verdict == Verdict::same) return {0.45f, 0.85f, 0.5f};
    return verdict == Verdict::warning ? DisplayColor{1, 0.8f, 0.3f} : DisplayColor{1, 0.45f, 0.4f};
}

std::string measures_of(const LayerComparison& layer) {
    const PixelDifferences& d = layer.differences;
    std::string text =
        fmt::format("{} of {} pixels fail ({:.4g} %)", d.failing.count, d.pixels, layer.failing_percent());
    if (layer.role != LayerRole::id)
        text +=
            fmt::format("   max {:.4g}   RMSE {:.4g}   PSNR {:.2f} dB", d.largest.value, d.rmse, d.psnr_db);
    if (d.left_out > 0) text += fmt::format("   {:.4g} % left out", layer.left_out_percent());
    if (d.forgiven > 0) text += fmt::format("   {} forgiven", d.forgiven);
    if (layer.role == LayerRole::depth) text += fmt::format("   relative {:.4g}", d.largest_pixel);
    if (layer.ldr_flip) text += fmt::format("   LDR-FLIP {:.4f}", layer.ldr_flip->mean);
    if (layer.hdr_flip) text += fmt::format("   HDR-FLIP {:.4f}", layer.hdr_flip->mean);
    if (layer.ssim) text += fmt::format("   SSIM {:.4f}", *layer.ssim);
    return text;
}

/// What is shown brightest: a few pixels that lost their surface must not take the scale from all others.
double bright_difference(const LayerComparison& layer, const LayerImages& images) {
    std::vector<double> differences;
    for (int y = 0; y < images.reference.height(); ++y)
        for (int x = 0; x < images.reference.width(); ++x) {
            if (images.areas.is_left_out(x, y, images.reference.width())) continue;
            const double difference = pixel_difference(images.reference, images.test, x, y, layer.role, true);
            if (difference > 0 && std::isfinite(difference)) differences.push_back(difference);
        }
    if (differences.empty()) return 1;
    const auto most = differences.begin() + std::ptrdiff_t(double(differences.size()) * 0.98);
    std::nth_element(differences.begin(), most, differences.end());
    return *most;
}

void add_difference(const LayerComparison& layer, const LayerImages& images, SideBySideRow& row) {
    const int width = images.reference.width(), height = images.reference.height();
    const auto seen = [&](int x, int y, double value) {
        return images.areas.is_left_out(x, y, width) ? kLeftOut : magma_color(float(value));
    };
    const std::string note = layer.differences.left_out > 0 ? "blue is left out; " : "";
    const std::optional<FlipResult>& flip = layer.hdr_flip ? layer.hdr_flip : layer.ldr_flip;
    if (flip) {
        row.pictures[2] = tile(
            width, height, [&](int x, int y) { return seen(x, y, flip->error.at(x, y, 0)); }, true);
        row.captions[2] = note + (layer.hdr_flip ? "HDR-FLIP, bright is 1" : "LDR-FLIP, bright is 1");
        return;
    }
    const double bright = bright_difference(layer, images);
    row.pictures[2] = tile(
        width, height,
        [&](int x, int y) {
            const double difference = pixel_difference(images.reference, images.test, x, y, layer.role, true);
            return seen(x, y, difference / bright);
        },
        true);
    const char* what = layer.role == LayerRole::depth      ? "relative difference"
                       : layer.role == LayerRole::velocity ? "end-point error in px"
                                                           : "difference";
    row.captions[2] = layer.role == LayerRole::id ? "other ids are bright"
                                                  : fmt::format("{}, bright >= {:.4g}", what, bright);
    row.captions[2].insert(0, note);
}

}  // namespace

SideBySideRow side_by_side_row(const LayerComparison& layer, const LayerImages& images) {
    SideBySideRow row;
    const int width = images.reference.width(), height = images.reference.height();
    const std::optional<LayerImages> converted = in_rec709(images, layer.role);
    const Image both = stacked(converted ? *converted : images, layer.role);
    std::optional<FalseColor> colors;
    ColorAt color;
    if (layer.role == LayerRole::display) {
        color = [&](int x, int y) {
            const auto at = [&](int c) {
                const float value = both.at(x, y, std::min(c, both.channels() - 1));
                return value > 0 ? std::min(value, 1.0f) : 0.0f;
            };
            return DisplayColor{at(0), at(1), at(2)};
        };
    } else {
        colors.emplace(false_color_role(layer, both), both, kRec709);
        color = [&](int x, int y) { return colors->color(x, y); };
    }
    row.pictures[0] = tile(width, height, color, false);
    row.pictures[1] = tile(
        width, height, [&](int x, int y) { return color(x, y + height); }, false);
    row.captions[0] = "reference";
    row.captions[1] = "test";
    add_difference(layer, images, row);
    row.verdict = layer.verdict;
    row.title = {
        fmt::format("{} ({}): {}", layer.label, layer_role_name(layer.role), verdict_name(layer.verdict)),
        measures_of(layer)};
    if (colors) row.title[0] += fmt::format("   (shown: {}, {})", colors->label()[0], colors->label()[1]);
    return row;
}

Image draw_side_by_side(const std::vector<SideBySideRow>& rows, const std::string& title) {
    int column_px = kMinColumn_px, height_px = 2 * kMargin_px + kLine_px;
    for (const SideBySideRow& row : rows) {
        column_px = std::max(column_px, row.pictures[0].width());
        height_px += 3 * kLine_px + row.pictures[0].height() + 2 * kMargin_px;
    }
    Image sheet(3 * column_px + 4 * kMargin_px, height_px, 3);
    fill_rectangle(sheet, 0, 0, sheet.width(), sheet.height(), kPaper);
    const int text_px = sheet.width() - 2 * kMargin_px;
    draw_text(sheet, kMargin_px, kMargin_px, title, kTextScale, text_px, kBright);
    int y = 2 * kMargin_px + kLine_px;
    for (const SideBySideRow& row : rows) {
        draw_text(sheet, kMargin_px, y, row.title[0], kTextScale, text_px, verdict_color(row.verdict));
        draw_text(sheet, kMargin_px, y + kLine_px, row.title[1], kTextScale, text_px, kQuiet);
        for (std::size_t i = 0; i < 3; ++i) {
            const int x = kMargin_px + int(i) * (column_px + kMargin_px);
            draw_text(sheet, x, y + 2 * kLine_px, row.captions[i], kTextScale, column_px, kQuiet);
            const Image& picture = row.pictures[i];
            for (int v = 0; v < picture.height(); ++v)
                for (int u = 0; u < picture.width(); ++u)
                    for (int c = 0; c < 3; ++c)
                        sheet.at(x + u, y + 3 * kLine_px + v, c) = picture.at(u, v, c);
        }
        y += 3 * kLine_px + row.pictures[0].height() + 2 * kMargin_px;
    }
    return sheet;
}

}  // namespace aftershade
