#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/text.h"
#include "framework/compare/comparison_report.h"
#include "framework/document/units.h"

namespace aftershade {

namespace {

/// A field of RFC 4180. A name that a spreadsheet would take for a formula gets an apostrophe before it, as
/// OWASP's "CSV Injection" says; numbers are ours.
std::string quoted(std::string field) {
    const bool is_number = parse_number(field).has_value() || field == "-inf";
    if (!field.empty() && !is_number && std::string_view("=+-@\t\r").find(field[0]) != std::string_view::npos)
        field.insert(0, "'");
    if (field.find_first_of(",\"\n\r") == std::string::npos) return field;
    std::string text = "\"";
    for (const char c : field) text += c == '"' ? std::string("\"\"") : std::string(1, c);
    return text + "\"";
}

std::string optional_number(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "";
}

std::optional<double> mean_of(const std::optional<FlipResult>& flip) {
    if (!flip) return std::nullopt;
    return flip->mean;
}

std::string csv_row(const Comparison& comparison, const LayerComparison& layer) {
    const PixelDifferences& d = layer.differences;
    const LargestDifference& most = d.largest;
    const bool measured = d.pixels > 0;
    const std::vector<std::string> fields = {comparison.reference.string(),
                                             comparison.test.string(),
                                             layer.label,
                                             std::string(layer_role_name(layer.role)),
                                             std::string(verdict_name(layer.verdict)),
                                             fmt::format("{}", d.pixels),
                                             fmt::format("{}", d.failing.count),
                                             fmt::format("{}", layer.failing_percent()),
                                             measured ? fmt::format("{}", most.value) : "",
                                             measured ? fmt::format("{}", most.x + layer.window.min_x) : "",
                                             measured ? fmt::format("{}", most.y + layer.window.min_y) : "",
                                             measured ? layer.channels.at(std::size_t(most.channel)) : "",
                                             fmt::format("{}", d.mean_absolute),
                                             fmt::format("{}", d.rmse),
                                             fmt::format("{}", d.psnr_db),
                                             fmt::format("{}", d.relative_mse),
                                             fmt::format("{}", d.largest_pixel),
                                             optional_number(mean_of(layer.ldr_flip)),
                                             optional_number(mean_of(layer.hdr_flip)),
                                             optional_number(layer.ssim),
                                             optional_number(layer.ms_ssim),
                                             fmt::format("{}", d.left_out),
                                             fmt::format("{}", d.forgiven)};
    std::string row;
    for (const std::string& field : fields) row += (row.empty() ? "" : ",") + quoted(field);
    return row + "\r\n";
}

const char* unit_of(LayerRole role) {
    if (role == LayerRole::velocity) return " px";
    return "";
}

std::string measure_lines(const LayerComparison& layer) {
    const PixelDifferences& d = layer.differences;
    const LargestDifference& most = d.largest;
    std::string text =
        fmt::format("  max error {:.6g} at ({}, {}) {}: {:.9g} in the reference, {:.9g} in the test image\n",
                    most.value, most.x + layer.window.min_x, most.y + layer.window.min_y,
                    layer.channels.at(std::size_t(most.channel)), most.reference, most.test);
    if (layer.role == LayerRole::id) return text;
    text += fmt::format("  MAE {:.6g}  RMSE {:.6g}  PSNR {:.4f} dB (peak {:.6g})  relMSE {:.6g} (eps {:g})\n",
                        d.mean_absolute, d.rmse, d.psnr_db, d.psnr_peak, d.relative_mse, kRelativeMseEpsilon);
    if (layer.role == LayerRole::depth)
        text += fmt::format("  relative error: max {:.6g}, mean {:.6g}\n", d.largest_pixel, d.mean_pixel);
    if (layer.role == LayerRole::velocity)
        text +=
            fmt::format("  end-point error: max {:.6g} px, mean {:.6g} px\n", d.largest_pixel, d.mean_pixel);
    return text;
}

std::string perceptual_lines(const LayerComparison& layer, const CompareRules& rules) {
    std::string text;
    if (layer.ldr_flip)
        text +=
            fmt::format("  LDR-FLIP {:.6f}, max {:.6f} at ({}, {}), {:.6g} px per degree\n",
                        layer.ldr_flip->mean, layer.ldr_flip->max, layer.ldr_flip->max_x + layer.window.min_x,
                        layer.ldr_flip->max_y + layer.window.min_y, rules.flip.pixels_per_degree);
    if (layer.hdr_flip)
        text += fmt::format(
            "  HDR-FLIP {:.6f}, max {:.6f} at ({}, {}), {:.6g} px per degree, {}, {} exposures {:.4f} to "
            "{:.4f}\n",
            layer.hdr_flip->mean, layer.hdr_flip->max, layer.hdr_flip->max_x + layer.window.min_x,
            layer.hdr_flip->max_y + layer.window.min_y, rules.flip.pixels_per_degree,
            tone_mapper_name(rules.flip.tone_mapper), layer.hdr_flip->exposures,
            layer.hdr_flip->start_exposure, layer.hdr_flip->stop_exposure);
    if (layer.ssim) text += fmt::format("  SSIM {:.6f}", *layer.ssim);
    if (layer.ms_ssim) text += fmt::format("  MS-SSIM {:.6f}", *layer.ms_ssim);
    return text + (layer.ssim ? " (sRGB-encoded, window 11 px, sigma 1.5)\n" : "");
}

std::string failing_line(const LayerComparison& layer, const CompareRules& rules) {
    const FailingPixels& failing = layer.differences.failing;
    std::string text =
        fmt::format("  {} of {} pixels ({:.4g} %) over {:g}{}", failing.count, layer.differences.pixels,
                    layer.failing_percent(), rules.levels_of(layer.label).fail.limit, unit_of(layer.role));
    if (failing.count > 0)
        text += fmt::format(", in {} x {} px from ({}, {})", failing.box.width(), failing.box.height(),
                            failing.box.min_x + layer.window.min_x, failing.box.min_y + layer.window.min_y);
    return text + "\n";
}

std::string forgiven_text(const Forgive& forgive) {
    if (forgive.shift_px > 0) return fmt::format("a shift of up to {} px", forgive.shift_px);
    return fmt::format("a blur of sigma {:g} px", forgive.blur_px);
}

/// What the figures above do not count.
std::string allowance_lines(const LayerComparison& layer, const CompareRules& rules) {
    const PixelDifferences& d = layer.differences;
    std::string text, names;
    for (const CompareArea& area : rules.areas)
        if (!area.levels) names += (names.empty() ? "" : "; ") + area.name;
    if (!names.empty())
        text += fmt::format("  left out: {} of {} pixels ({:.4g} %): {}\n", d.left_out, d.pixels + d.left_out,
                            layer.left_out_percent(), names);
    if (rules.forgive.any())
        text += fmt::format("  forgiven: {} pixels, by {}\n", d.forgiven, forgiven_text(rules.forgive));
    std::size_t i = 0;
    for (const CompareArea& area : rules.areas) {
        if (!area.levels || ++i >= d.by_area.size()) continue;
        text += fmt::format("  area {}: {} of {} pixels over {:g}\n", area.name, d.by_area[i].failing.count,
                            d.by_area[i].pixels, area.levels->fail.limit);
    }
    return text;
}

std::string non_finite_line(const PixelDifferences& d) {
    const NonFiniteCounts& r = d.reference_counts;
    const NonFiniteCounts& t = d.test_counts;
    if (r == NonFiniteCounts{} && t == NonFiniteCounts{}) return "";
    return fmt::format("  NaN {} and {}, infinite {} and {} (reference, test image); {} cannot be compared\n",
                       r.nan, t.nan, r.infinite, t.infinite, d.incomparable);
}

std::string layer_text(const LayerComparison& layer, const CompareRules& rules) {
    const bool unlimited = layer.verdict == Verdict::same &&
                           std::ranges::find(layer.not_judged, layer.label) != layer.not_judged.end();
    std::string text = fmt::format("{} ({}): {}\n", layer.label, layer_role_name(layer.role),
                                   unlimited ? "not judged, no limit" : verdict_name(layer.verdict));
    for (const std::string& reason : layer.reasons) text += "  ! " + reason + "\n";
    for (const std::string& name : layer.not_judged)
        if (name != layer.label) text += "  not judged: " + name + "\n";
    if (layer.absent_in_reference + layer.absent_in_test > 0)
        text += fmt::format("  {} pixels are absent in the reference, {} in the test image\n",
                            layer.absent_in_reference, layer.absent_in_test);
    if (layer.differences.pixels + layer.differences.left_out == 0) return text;
    text += allowance_lines(layer, rules);
    if (layer.differences.pixels == 0) return text;
    if (layer.differences.bits_equal) return text + "  equal bits\n" + non_finite_line(layer.differences);
    return text + measure_lines(layer) + failing_line(layer, rules) + non_finite_line(layer.differences) +
           perceptual_lines(layer, rules);
}

}  // namespace

std::string csv_header() {
    return "reference,test,layer,role,verdict,pixels,failing_pixels,failing_percent,max_error,max_x,max_y,"
           "max_channel,mean_absolute,rmse,psnr_db,relative_mse,max_pixel_difference,ldr_flip,hdr_flip,ssim,"
           "ms_ssim,left_out_pixels,forgiven_pixels\r\n";
}

std::string csv_rows(const Comparison& comparison) {
    std::string rows;
    for (const LayerComparison& layer : comparison.layers) rows += csv_row(comparison, layer);
    return rows;
}

std::string allowances_of(const Comparison& comparison, const CompareRules& rules) {
    std::string text;
    if (rules.forgive.any()) text = "forgives " + forgiven_text(rules.forgive);
    double all = 0, left_out = 0;
    for (const LayerComparison& layer : comparison.layers) {
        left_out += double(layer.differences.left_out);
        all += double(layer.differences.left_out + layer.differences.pixels);
    }
    if (std::ranges::any_of(rules.areas, [](const CompareArea& area) { return !area.levels; }))
        text += fmt::format("{}{:.4g} % of the pixels left out", text.empty() ? "" : "; ",
                            all > 0 ? 100 * left_out / all : 0);
    if (const std::vector<std::string> names = comparison.not_judged(); !names.empty())
        text += (text.empty() ? "" : "; ") + ("not judged: " + joined(names, ", ", ", "));
    return text;
}

std::string text_of(const Comparison& comparison, const CompareRules& rules) {
    std::string text = fmt::format("reference: {}\ntest:      {}\n", comparison.reference.string(),
                                   comparison.test.string());
    for (const LayerComparison& layer : comparison.layers) text += layer_text(layer, rules);
    for (const std::string& fault : comparison.faults) text += "! " + fault + "\n";
    for (const std::string& warning : comparison.warnings) text += "! " + warning + "\n";
    for (const std::string& note : comparison.notes) text += "note: " + note + "\n";
    const std::string allowances = allowances_of(comparison, rules);
    return printable_lines(text + std::string(verdict_name(comparison.verdict)) +
                           (allowances.empty() ? "" : " (" + allowances + ")") + "\n");
}

}  // namespace aftershade
