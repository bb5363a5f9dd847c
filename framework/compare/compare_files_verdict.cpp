#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/compare/compare_files.h"
#include "framework/compare/perceptual.h"
#include "framework/core/parallel.h"

namespace aftershade {

namespace {

struct Level {
    const char* word;  ///< as the flags are called
    Verdict verdict;
    Tolerance tolerance;
    const FailingPixels& above;
    const FailingPixels& hard;
    std::optional<double> flip, ssim;
};

std::string not_comparable(const PixelDifferences& differences) {
    if (differences.incomparable == 0) return "";
    return fmt::format(" ({} values cannot be compared: NaN{}, or another infinity)",
                       differences.incomparable,
                       differences.reference_counts.nan > 0 && differences.test_counts.nan > 0
                           ? ", which equals NaN only with nan-equal"
                           : "");
}

void judge(const Level& level, LayerComparison& comparison) {
    const auto say = [&](std::string reason) {
        comparison.verdict = std::max(comparison.verdict, level.verdict);
        comparison.reasons.push_back(std::move(reason));
    };
    const double pixels = double(comparison.differences.pixels);
    const Tolerance& tolerance = level.tolerance;
    const double let_pass = std::max(double(tolerance.allowed), tolerance.percent / 100 * pixels);
    if (double(level.above.count) > let_pass)
        say(fmt::format("{} pixels ({:.6g} %) differ by more than {} {:.6g}{}", level.above.count,
                        100 * double(level.above.count) / pixels, level.word, tolerance.limit,
                        let_pass > 0 ? fmt::format(", {:.6g} may", std::floor(let_pass)) : "") +
            not_comparable(comparison.differences));
    if (level.hard.count > tolerance.allowed)
        say(fmt::format("{} pixels differ by more than hard{} {:.6g}{}", level.hard.count, level.word,
                        tolerance.hard,
                        tolerance.allowed > 0 ? fmt::format(", {} may", tolerance.allowed) : ""));
    for (const auto& [name, flip] :
         {std::pair{"LDR-FLIP", &comparison.ldr_flip}, std::pair{"HDR-FLIP", &comparison.hdr_flip}})
        if (level.flip && *flip && !((*flip)->mean <= *level.flip))
            say(fmt::format("{} {:.6g} is above {}-flip {:.6g}", name, (*flip)->mean, level.word,
                            *level.flip));
    if (level.ssim && comparison.ssim && !(*comparison.ssim >= *level.ssim))
        say(fmt::format("SSIM {:.6g} is below {}-ssim {:.6g}", *comparison.ssim, level.word, *level.ssim));
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
    static constexpr std::array<std::string_view, 5> names = {"same", "warning", "failure",
                                                              "different size or channels", "file error"};
    return names[std::size_t(verdict)];
}

Tolerance CompareRules::warn_tolerance() const {
    if (warn) return *warn;
    Tolerance same_limit;
    same_limit.limit = fail.limit;
    same_limit.allowed = fail.allowed;
    return same_limit;
}

DifferenceRules CompareRules::difference_rules() const {
    const Tolerance warning = warn_tolerance();
    return {fail.limit, fail.hard, warning.limit, warning.hard, nan_equal};
}

double LayerComparison::failing_percent() const {
    return differences.pixels == 0 ? 0 : 100 * double(differences.failing.count) / double(differences.pixels);
}

void compare_layer(const Image& reference, const Image& test, const CompareRules& rules,
                   LayerComparison& comparison) {
    comparison.differences = pixel_differences(reference, test, comparison.role, rules.difference_rules(),
                                               thread_count(rules.threads));
    measure_perceptually(reference, test, rules, comparison);
    const PixelDifferences& d = comparison.differences;
    judge({"fail", Verdict::failure, rules.fail, d.failing, d.hard_failing, rules.fail_flip, rules.fail_ssim},
          comparison);
    // A failure tells what a warning would.
    if (comparison.verdict < Verdict::failure)
        judge({"warn", Verdict::warning, rules.warn_tolerance(), d.warning, d.hard_warning, rules.warn_flip,
               rules.warn_ssim},
              comparison);
}

}  // namespace aftershade
