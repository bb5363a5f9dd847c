#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/base/parallel.h"
#include "framework/compare/compare_files.h"
#include "framework/compare/perceptual.h"

namespace aftershade {

namespace {

struct Level {
    const char* word;  ///< as the flags are called
    Verdict verdict;
    Tolerance tolerance;
    std::uint64_t pixels;
    const FailingPixels& above;
    const FailingPixels& hard;
    std::string where;  ///< ": " after an area's name; "" of the layer
};

std::string not_comparable(const PixelDifferences& differences) {
    if (differences.incomparable == 0) return "";
    return fmt::format(" ({} values cannot be compared: NaN{}, or another infinity)",
                       differences.incomparable,
                       differences.reference_counts.nan > 0 && differences.test_counts.nan > 0
                           ? ", which equals NaN only with nan-equal"
                           : "");
}

void say(LayerComparison& comparison, Verdict verdict, std::string reason) {
    comparison.verdict = std::max(comparison.verdict, verdict);
    comparison.reasons.push_back(std::move(reason));
}

void judge(const Level& level, LayerComparison& comparison) {
    const double pixels = double(level.pixels);
    const Tolerance& tolerance = level.tolerance;
    const double let_pass = std::max(double(tolerance.allowed), tolerance.percent / 100 * pixels);
    if (double(level.above.count) > let_pass)
        say(comparison, level.verdict,
            fmt::format(
                "{}{} pixels ({:.6g} %) differ by more than {} {:.6g}{}{}", level.where, level.above.count,
                100 * double(level.above.count) / pixels, level.word, tolerance.limit,
                (tolerance.relative > 0 ? fmt::format(" and {:.6g} of their value", tolerance.relative)
                                        : "") +
                    (tolerance.ulp > 0 ? fmt::format(" and {:.6g} units in the last place", tolerance.ulp)
                                       : ""),
                let_pass > 0 ? fmt::format(", {:.6g} allowed", std::floor(let_pass)) : "") +
                not_comparable(comparison.differences));
    if (level.hard.count > tolerance.allowed)
        say(comparison, level.verdict,
            fmt::format("{}{} pixels differ by more than hard{} {:.6g}{}", level.where, level.hard.count,
                        level.word, tolerance.hard,
                        tolerance.allowed > 0 ? fmt::format(", {} allowed", tolerance.allowed) : ""));
}

void judge_look(const char* word, Verdict verdict, const std::optional<double>& flip_limit,
                const std::optional<double>& ssim_limit, LayerComparison& comparison) {
    for (const auto& [name, flip] :
         {std::pair{"LDR-FLIP", &comparison.ldr_flip}, std::pair{"HDR-FLIP", &comparison.hdr_flip}})
        if (flip_limit && *flip && !((*flip)->mean <= *flip_limit))
            say(comparison, verdict,
                fmt::format("{} {:.6g} is above {}-flip {:.6g}", name, (*flip)->mean, word, *flip_limit));
    if (ssim_limit && comparison.ssim && !(*comparison.ssim >= *ssim_limit))
        say(comparison, verdict,
            fmt::format("SSIM {:.6g} is below {}-ssim {:.6g}", *comparison.ssim, word, *ssim_limit));
    if (ssim_limit && is_perceptual(comparison.role) && !comparison.ssim &&
        comparison.differences.left_out > 0)
        say(comparison, verdict,
            fmt::format("SSIM cannot be held to {}-ssim {:.6g}: every pixel with a whole window is left out",
                        word, *ssim_limit));
}

bool can_exceed(const Tolerance& tolerance, LayerRole role, std::uint64_t pixels) {
    // Encoded colours and coverage are from 0 to 1. Nothing else is held to a million: such a limit stands
    // for none in documents, where infinity cannot be written.
    const bool is_unit = role == LayerRole::display || role == LayerRole::alpha;
    const double no_limit = is_unit ? 1 : 1e6;
    const bool differs = role == LayerRole::id;  // ids that differ fail above any limit
    const auto limits = [&](double limit) { return differs || limit < no_limit; };
    const double let_pass = std::max(double(tolerance.allowed), tolerance.percent / 100 * double(pixels));
    // Two numbers differ by at most twice the mean of their magnitudes.
    const bool all_relative = tolerance.relative >= 2 && role != LayerRole::depth && !differs;
    return (limits(tolerance.limit) && let_pass < double(pixels) && !all_relative) ||
           (limits(tolerance.hard) && tolerance.allowed < pixels);
}

/// The layer first, then each area with limits of its own.
std::vector<const Levels*> levels_by_area(const CompareRules& rules, const std::string& label) {
    std::vector<const Levels*> levels{&rules.levels_of(label)};
    for (const CompareArea& area : rules.areas)
        if (area.levels) levels.push_back(&*area.levels);
    return levels;
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
    static constexpr std::array<std::string_view, 5> names = {"same", "warning", "failure",
                                                              "different size or channels", "file error"};
    return names[std::size_t(verdict)];
}

Tolerance Levels::warn_tolerance() const {
    if (warn) return *warn;
    Tolerance same_limit;
    same_limit.limit = fail.limit;
    same_limit.allowed = fail.allowed;
    same_limit.relative = fail.relative;
    same_limit.ulp = fail.ulp;
    return same_limit;
}

bool Levels::judge(LayerRole role, std::uint64_t pixels, bool has_flip, bool has_ssim) const {
    const auto by_flip = [&](const std::optional<double>& limit) { return has_flip && limit && *limit < 1; };
    const auto by_ssim = [&](const std::optional<double>& limit) { return has_ssim && limit && *limit > 0; };
    return can_exceed(fail, role, pixels) || can_exceed(warn_tolerance(), role, pixels) ||
           by_flip(fail_flip) || by_flip(warn_flip) || by_ssim(fail_ssim) || by_ssim(warn_ssim);
}

DifferenceRules Levels::difference_limits() const {
    const Tolerance warning = warn_tolerance();
    DifferenceRules limits;
    limits.fail = fail.limit, limits.warn = warning.limit;
    limits.hard_fail = fail.hard, limits.hard_warn = warning.hard;
    limits.fail_relative = fail.relative, limits.warn_relative = warning.relative;
    limits.fail_ulp = fail.ulp, limits.warn_ulp = warning.ulp;
    return limits;
}

const Levels& CompareRules::levels_of(const std::string& label) const {
    const auto own = layers.find(label);
    return own == layers.end() ? *this : own->second;
}

DifferenceRules CompareRules::difference_rules(const std::string& label) const {
    DifferenceRules result = levels_of(label).difference_limits();
    result.nan_equal = nan_equal;
    result.forgive = forgive;
    return result;
}

double LayerComparison::failing_percent() const {
    return differences.pixels == 0 ? 0 : 100 * double(differences.failing.count) / double(differences.pixels);
}

double LayerComparison::left_out_percent() const {
    const double all = double(differences.pixels + differences.left_out);
    return all == 0 ? 0 : 100 * double(differences.left_out) / all;
}

std::vector<std::string> Comparison::not_judged() const {
    std::vector<std::string> names;
    for (const LayerComparison& layer : layers)
        names.insert(names.end(), layer.not_judged.begin(), layer.not_judged.end());
    names.insert(names.end(), ignored.begin(), ignored.end());
    return names;
}

namespace {

/// FLIP and SSIM are of the whole layer.
void find_not_judged(const std::vector<const Levels*>& levels, LayerComparison& comparison) {
    const std::vector<LimitCounts>& areas = comparison.differences.by_area;
    const bool has_flip = comparison.ldr_flip || comparison.hdr_flip;
    std::vector<std::string> names;
    std::size_t with_pixels = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        if (areas[i].pixels == 0) continue;
        ++with_pixels;
        const bool is_layer = i == 0;
        if (levels[i]->judge(comparison.role, areas[i].pixels, is_layer && has_flip,
                             is_layer && comparison.ssim.has_value()))
            continue;
        names.push_back(comparison.label +
                        (is_layer ? " outside of the areas" : " in the area " + comparison.areas[i - 1]));
    }
    if (names.size() == with_pixels) names = {comparison.label};
    comparison.not_judged = std::move(names);
}

}  // namespace

void compare_layer(const LayerImages& images, const CompareRules& rules, LayerComparison& comparison) {
    DifferenceRules limits = rules.difference_rules(comparison.label);
    limits.stored = comparison.stored;
    comparison.differences = pixel_differences(images.reference, images.test, comparison.role, limits,
                                               images.areas, thread_count(rules.threads));
    for (const CompareArea& area : rules.areas)
        if (area.levels) comparison.areas.push_back(area.name);
    const PixelDifferences& d = comparison.differences;
    if (d.pixels == 0) return;
    measure_perceptually(images, rules, comparison);
    const std::vector<const Levels*> levels = levels_by_area(rules, comparison.label);
    find_not_judged(levels, comparison);
    const auto where = [&](std::size_t area) {
        return area == 0 ? "" : "in the area " + comparison.areas[area - 1] + ": ";
    };
    for (std::size_t i = 0; i < d.by_area.size(); ++i)
        judge({"fail", Verdict::failure, levels[i]->fail, d.by_area[i].pixels, d.by_area[i].failing,
               d.by_area[i].hard_failing, where(i)},
              comparison);
    judge_look("fail", Verdict::failure, levels[0]->fail_flip, levels[0]->fail_ssim, comparison);
    // A failure tells what a warning would.
    if (comparison.verdict >= Verdict::failure) return;
    for (std::size_t i = 0; i < d.by_area.size(); ++i)
        judge({"warn", Verdict::warning, levels[i]->warn_tolerance(), d.by_area[i].pixels,
               d.by_area[i].warning, d.by_area[i].hard_warning, where(i)},
              comparison);
    judge_look("warn", Verdict::warning, levels[0]->warn_flip, levels[0]->warn_ssim, comparison);
}

}  // namespace aftershade
