#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/compare/comparison_report.h"
#include "framework/compare/ssim.h"

namespace aftershade {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    return value;
}

Json number(const std::optional<double>& value) {
    return value ? number(*value) : Json(nullptr);
}

Json window_json(const Window& window) {
    return {{"min", {window.min_x, window.min_y}}, {"max", {window.max_x, window.max_y}}};
}

Json pixels_json(const FailingPixels& pixels, const LayerComparison& layer, std::uint64_t of_pixels) {
    const double all = double(std::max<std::uint64_t>(of_pixels, 1));
    Json json{{"pixels", pixels.count}, {"percent", 100 * double(pixels.count) / all}, {"box", nullptr}};
    if (pixels.count == 0) return json;
    const Window& box = pixels.box;
    json["box"] = window_json({box.min_x + layer.window.min_x, box.min_y + layer.window.min_y,
                               box.max_x + layer.window.min_x, box.max_y + layer.window.min_y});
    return json;
}

Json pixels_json(const FailingPixels& pixels, const LayerComparison& layer) {
    return pixels_json(pixels, layer, layer.differences.pixels);
}

/// Those with limits of their own.
Json areas_json(const LayerComparison& layer) {
    Json areas = Json::array();
    for (std::size_t i = 0; i < layer.areas.size(); ++i) {
        const LimitCounts& counts = layer.differences.by_area[i + 1];
        areas.push_back({{"area", layer.areas[i]},
                         {"pixels", counts.pixels},
                         {"failing", pixels_json(counts.failing, layer, counts.pixels)},
                         {"hard_failing", pixels_json(counts.hard_failing, layer, counts.pixels)},
                         {"warning", pixels_json(counts.warning, layer, counts.pixels)},
                         {"hard_warning", pixels_json(counts.hard_warning, layer, counts.pixels)}});
    }
    return areas;
}

Json counts_json(const NonFiniteCounts& counts) {
    return {{"nan", counts.nan}, {"inf", counts.infinite}};
}

Json largest_json(const LayerComparison& layer) {
    const LargestDifference& largest = layer.differences.largest;
    return {{"value", number(largest.value)},
            {"x", largest.x + layer.window.min_x},
            {"y", largest.y + layer.window.min_y},
            {"channel", layer.channels.at(std::size_t(largest.channel))},
            {"reference", number(largest.reference)},
            {"test", number(largest.test)}};
}

Json flip_json(const std::optional<FlipResult>& flip, const LayerComparison& layer, const CompareRules& rules,
               bool hdr) {
    if (!flip) return nullptr;
    Json json{{"mean", flip->mean},
              {"max", flip->max},
              {"x", flip->max_x + layer.window.min_x},
              {"y", flip->max_y + layer.window.min_y},
              {"pixels_per_degree", rules.flip.pixels_per_degree}};
    if (!hdr) return json;
    json["tone_mapper"] = tone_mapper_name(rules.flip.tone_mapper);
    json["start_exposure"] = flip->start_exposure;
    json["stop_exposure"] = flip->stop_exposure;
    json["exposures"] = flip->exposures;
    return json;
}

void add_measures(Json& json, const LayerComparison& layer, const CompareRules& rules) {
    const PixelDifferences& d = layer.differences;
    json["max_error"] = largest_json(layer);
    // Distances between ids mean nothing.
    const bool measured = layer.role != LayerRole::id;
    json["mean_absolute"] = measured ? number(d.mean_absolute) : nullptr;
    json["rmse"] = measured ? number(d.rmse) : nullptr;
    json["psnr_db"] = measured ? number(d.psnr_db) : nullptr;
    json["psnr_peak"] = measured ? number(d.psnr_peak) : nullptr;
    json["relative_mse"] = measured ? number(d.relative_mse) : nullptr;
    json["relative_mse_epsilon"] = kRelativeMseEpsilon;
    json["max_pixel_difference"] = number(d.largest_pixel);
    json["mean_pixel_difference"] = measured ? number(d.mean_pixel) : nullptr;
    json["forgiven_pixels"] = d.forgiven;
    json["areas"] = areas_json(layer);
    json["failing"] = pixels_json(d.failing, layer);
    json["hard_failing"] = pixels_json(d.hard_failing, layer);
    json["warning"] = pixels_json(d.warning, layer);
    json["hard_warning"] = pixels_json(d.hard_warning, layer);
    json["incomparable_values"] = d.incomparable;
    json["reference_non_finite"] = counts_json(d.reference_counts);
    json["test_non_finite"] = counts_json(d.test_counts);
    json["ldr_flip"] = flip_json(layer.ldr_flip, layer, rules, false);
    json["hdr_flip"] = flip_json(layer.hdr_flip, layer, rules, true);
    json["ssim"] = number(layer.ssim);
    json["ms_ssim"] = number(layer.ms_ssim);
}

Json layer_json(const LayerComparison& layer, const CompareRules& rules) {
    Json json{{"layer", layer.label},
              {"role", layer_role_name(layer.role)},
              {"channels", layer.channels},
              {"verdict", verdict_name(layer.verdict)},
              {"reasons", layer.reasons},
              {"not_judged", layer.not_judged},
              {"window", window_json(layer.window)},
              {"pixels", layer.differences.pixels},
              {"left_out_pixels", layer.differences.left_out},
              {"left_out_percent", layer.left_out_percent()},
              {"absent_in_reference", layer.absent_in_reference},
              {"absent_in_test", layer.absent_in_test}};
    if (layer.differences.pixels > 0) add_measures(json, layer, rules);
    return json;
}

Json tolerance_json(const Tolerance& tolerance, const std::optional<double>& flip,
                    const std::optional<double>& ssim) {
    return {{"limit", number(tolerance.limit)},
            {"relative", number(tolerance.relative)},
            {"ulp", number(tolerance.ulp)},
            {"percent", tolerance.percent},
            {"hard", number(tolerance.hard)},
            {"allowed", tolerance.allowed},
            {"flip", number(flip)},
            {"ssim", number(ssim)}};
}

void add_levels(Json& json, const Levels& levels) {
    json["fail"] = tolerance_json(levels.fail, levels.fail_flip, levels.fail_ssim);
    json["warn"] = tolerance_json(levels.warn_tolerance(), levels.warn_flip, levels.warn_ssim);
}

Json rules_json(const CompareRules& rules) {
    Json json;
    add_levels(json, rules);
    json["nan_equal"] = rules.nan_equal;
    json["forgive_shift_px"] = rules.forgive.shift_px;
    json["forgive_blur_px"] = rules.forgive.blur_px;
    json["layers"] = Json::object();
    for (const auto& [label, levels] : rules.layers) add_levels(json["layers"][label], levels);
    json["ignore"] = Json::array();
    json["areas"] = Json::array();
    for (const CompareArea& area : rules.areas) {
        if (!area.levels) {
            json["ignore"].push_back(area.name);
            continue;
        }
        Json one{{"area", area.name}};
        add_levels(one, *area.levels);
        json["areas"].push_back(std::move(one));
    }
    return json;
}

}  // namespace

nlohmann::ordered_json json_of(const Comparison& comparison, const CompareRules& rules) {
    Json json{{"aftershade", 1},
              {"reference", comparison.reference.string()},
              {"test", comparison.test.string()},
              {"verdict", verdict_name(comparison.verdict)},
              {"exit_code", int(comparison.verdict)},
              {"faults", comparison.faults},
              {"warnings", comparison.warnings},
              {"notes", comparison.notes},
              {"not_judged", comparison.not_judged()},
              {"rules", rules_json(rules)},
              {"layers", Json::array()}};
    for (const LayerComparison& layer : comparison.layers) json["layers"].push_back(layer_json(layer, rules));
    return json;
}

std::string json_text(const Comparison& comparison, const CompareRules& rules) {
    // Names in files need not be UTF-8.
    return json_of(comparison, rules).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace aftershade
