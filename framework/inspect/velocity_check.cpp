#include "framework/inspect/velocity_check.h"

#include "framework/base/error.h"
#include "framework/inspect/velocity_bias.h"
#include "framework/inspect/velocity_report.h"
#include "framework/inspect/velocity_warp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace aftershade {

namespace {

constexpr double kClearScore = 0.05;    // two hypotheses further apart are told from each other ...
constexpr double kClearDispute = 0.15;  // ... or those whose errors differ so, where they disagree
constexpr double kExplains = 0.25;      // below, a score may be chance
constexpr double kExplainsWell = 0.5;   // a rival in time that does, where the claim does not explain
constexpr double kRest = 0.1;           // ... or that leaves no more of what the claim leaves
constexpr double kStillError = 1e-4;    // below, the two pictures are one
constexpr double kFitSlack = 0.03;      // fits closer than this are one
constexpr double kMostScale = 8;        // the fit begins with scales up to 4; far beyond, it is guesswork
constexpr double kHopeless = 0.3;       // worse starts of the fit are left out
constexpr double kWorst = -std::numeric_limits<double>::infinity();

/// Both directions in time. Stays where it is: a WarpTest keeps references to the frames.
class Tests {
public:
    explicit Tests(const VelocityCheckInput& input)
        : pivot_(median_luminance(*input.color_a, *input.color_b, input.primaries)),
          a_(make_compared(*input.color_a, pivot_)),
          b_(make_compared(*input.color_b, pivot_)) {
        const bool next = input.settings.is_next();
        if (input.vectors_a) (next ? claimed_ : other_).emplace(a_, b_, *input.vectors_a, 1);
        if (input.vectors_b) (next ? other_ : claimed_).emplace(b_, a_, *input.vectors_b, -1);
    }
    Tests(const Tests&) = delete;
    Tests& operator=(const Tests&) = delete;

    /// nullptr where that frame has no vectors or too few that move.
    const WarpTest* at(bool other_time) const {
        const auto& test = other_time ? other_ : claimed_;
        return test && !test->empty() ? &*test : nullptr;
    }
    const std::optional<WarpTest>& claimed() const { return claimed_; }
    const std::optional<WarpTest>& other() const { return other_; }

private:
    double pivot_;
    ComparedFrame a_, b_;
    std::optional<WarpTest> claimed_, other_;
};

void require_image(const Image* image, const Image& reference, int channels, const char* what) {
    if (!image) return;
    if (image->width() != reference.width() || image->height() != reference.height())
        throw Error(
            ErrorKind::capture,
            fmt::format("{} is {}x{}, but the colour of frame A is {}x{}: both frames of a velocity "
                        "check must have one size",
                        what, image->width(), image->height(), reference.width(), reference.height()));
    if (image->type() != ComponentType::float32 || image->channels() < channels)
        throw Error(ErrorKind::capture,
                    fmt::format("{} has {} channels, but a velocity check needs {} of floats", what,
                                image->channels(), channels));
}

VectorMap map_of(const VelocityHypothesis& hypothesis) {
    return {hypothesis.swapped, hypothesis.scale_x, hypothesis.scale_y};
}

std::vector<VelocityHypothesis> list_hypotheses() {
    std::vector<VelocityHypothesis> list;
    for (const bool other_time : {false, true})
        for (const bool swapped : {false, true})
            for (const double scale : {1.0, 0.5, 2.0})
                for (const double sign_x : {1.0, -1.0})
                    for (const double sign_y : {1.0, -1.0})
                        list.push_back({other_time, swapped, sign_x * scale, sign_y * scale});
    return list;
}

/// Best first; the claim is listed first, so that it wins a tie.
std::vector<VelocityScore> score_all(const Tests& tests) {
    std::vector<VelocityScore> scores;
    for (const VelocityHypothesis& hypothesis : list_hypotheses()) {
        const WarpTest* test = tests.at(hypothesis.other_time);
        scores.push_back({hypothesis, test ? test->score(map_of(hypothesis)) : 0, test != nullptr});
    }
    std::stable_sort(scores.begin(), scores.end(), [](const VelocityScore& one, const VelocityScore& other) {
        if (one.tested != other.tested) return one.tested;
        return one.score > other.score;
    });
    return scores;
}

/// Whether the frames tell that `better` is better.
bool is_clearly_better(const Tests& tests, const VelocityScore& better, const VelocityScore& worse) {
    if (better.score - worse.score >= kClearScore) return true;
    if (better.hypothesis.other_time != worse.hypothesis.other_time) return false;
    const WarpTest* test = tests.at(better.hypothesis.other_time);
    return test && test->dispute(map_of(better.hypothesis), map_of(worse.hypothesis)) >= kClearDispute;
}

/// Whether the frames tell that a reading in the other direction in time is better: it must win in both
/// directions, where both frames see the surface. Under uniform motion both readings say the same, and
/// uncovered background and the picture's borders make the difference of their scores.
bool wins_in_time(const Tests& tests, const VelocityScore& rival, const VelocityScore& claim) {
    if (!tests.claimed() || !tests.other()) return false;
    const VectorMap of_rival = map_of(rival.hypothesis), of_claim = map_of(claim.hypothesis);
    const TimeDispute there = tests.other()->dispute_in_time(of_rival, *tests.claimed(), of_claim);
    const TimeDispute here = tests.claimed()->dispute_in_time(of_claim, *tests.other(), of_rival);
    const double limit = 1 - kClearDispute;
    const bool wins_there = there.told && there.own < limit * there.other;
    // A claim under which nothing moves has no samples.
    const bool wins_here = tests.claimed()->empty() || (here.told && here.other < limit * here.own);
    if (wins_there && wins_here) return true;
    // Flat surfaces show their motion by their outlines alone, which those pixels leave out.
    const bool claim_wins =
        (there.told && there.other < limit * there.own) || (here.told && here.own < limit * here.other);
    const bool explains_all = 1 - rival.score < kRest * (1 - claim.score) && claim.score < kExplainsWell;
    const bool explains_alone = claim.score < kExplains && rival.score >= kExplainsWell;
    return !claim_wins && (explains_all || explains_alone);
}

/// The best hypothesis that refutes the claim; nullptr where none does.
const VelocityScore* find_refutation(const Tests& tests, const VelocityCheck& check) {
    for (const VelocityScore& score : check.hypotheses) {
        if (!score.tested || score.score < kExplains || score.hypothesis == VelocityHypothesis{}) break;
        if (!is_clearly_better(tests, score, check.identity)) continue;
        if (score.hypothesis.other_time ? wins_in_time(tests, score, check.identity)
                                        : score.score >= check.best.score - kClearScore)
            return &score;
    }
    return nullptr;
}

struct ScoredMap {
    VectorMap map;
    double score = kWorst;
};

bool is_better(const ScoredMap& one, const ScoredMap& other) {
    return one.score > other.score;
}

/// Climbs from `start` with shrinking steps, relative to the scale.
ScoredMap refine(const WarpTest& test, ScoredMap start, double step, double last_step, bool rough) {
    start.score = test.score(start.map, rough);
    while (step >= last_step) {
        ScoredMap best = start;
        for (const int i : {-1, 0, 1})
            for (const int j : {-1, 0, 1}) {
                if (i == 0 && j == 0) continue;
                const VectorMap map{start.map.swapped, start.map.x * (1 + i * step),
                                    start.map.y * (1 + j * step)};
                const double score = test.score(map, rough);
                if (score > best.score) best = {map, score};
            }
        if (best.score > start.score) start = best;
        else step /= 2;
    }
    return start;
}

/// One direction in time, order of axes and pair of signs.
struct FitClass {
    bool other_time = false;
    std::vector<ScoredMap> starts;  ///< the two best of a grid of scales, as the error has many valleys
    ScoredMap fit;
};

FitClass make_class(const WarpTest& test, bool other_time, bool swapped, int sign_x, int sign_y) {
    constexpr std::array<double, 9> kGrid = {0.25, 0.35, 0.5, 0.71, 1, 1.41, 2, 2.83, 4};
    FitClass made{other_time, {}, {}};
    for (const double x : kGrid)
        for (const double y : kGrid) {
            const VectorMap map{swapped, sign_x * x, sign_y * y};
            made.starts.push_back({map, test.score(map, true)});
        }
    std::stable_sort(made.starts.begin(), made.starts.end(), is_better);
    made.starts.resize(2);
    return made;
}

/// The best scales of each class that may win; those with the fewest changes first.
std::vector<FitClass> fit_classes(const Tests& tests) {
    std::vector<FitClass> classes;
    double best_start = kWorst;
    for (const bool other_time : {false, true})
        for (const bool swapped : {false, true})
            for (const auto& [sign_x, sign_y] : {std::pair{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
                const WarpTest* test = tests.at(other_time);
                if (!test) continue;
                classes.push_back(make_class(*test, other_time, swapped, sign_x, sign_y));
                best_start = std::max(best_start, classes.back().starts[0].score);
            }
    std::erase_if(classes, [&](const FitClass& one) { return one.starts[0].score < best_start - kHopeless; });
    for (FitClass& one : classes)
        for (const ScoredMap& start : one.starts) {
            const ScoredMap fit = refine(*tests.at(one.other_time), start, 0.15, 0.01, true);
            if (is_better(fit, one.fit)) one.fit = fit;
        }
    return classes;
}

/// nullopt where a scale of nothing and the opposite sign explain the frames as well.
std::optional<double> told_scale(const WarpTest& test, const ScoredMap& fit, double VectorMap::*axis) {
    for (const double factor : {0.0, -1.0}) {
        VectorMap other = fit.map;
        other.*axis *= factor;
        const bool clear =
            fit.score - test.score(other) >= kClearScore || test.dispute(fit.map, other) >= kClearDispute;
        if (!clear) return std::nullopt;
    }
    return fit.map.*axis;
}

/// One motion of the whole picture can be had with any signs and order. So within the slack of the best fit
/// this takes the one that agrees with the best listed hypothesis, else the one that changes the least.
std::optional<VelocityFit> fit_scales(const Tests& tests, const VelocityHypothesis& best) {
    const std::vector<FitClass> classes = fit_classes(tests);
    if (classes.empty()) return std::nullopt;
    double best_score = kWorst;
    for (const FitClass& one : classes) best_score = std::max(best_score, one.fit.score);
    const FitClass* chosen = nullptr;
    for (const FitClass& one : classes) {
        if (one.fit.score < best_score - kFitSlack) continue;
        const bool agrees =
            scale_is_listed({one.other_time, one.fit.map.swapped, one.fit.map.x, one.fit.map.y}, best);
        if (!chosen || agrees) chosen = &one;
    }
    const WarpTest& test = *tests.at(chosen->other_time);
    const ScoredMap fit = refine(test, chosen->fit, 0.02, 0.002, false);
    return VelocityFit{chosen->other_time, fit.map.swapped, told_scale(test, fit, &VectorMap::x),
                       told_scale(test, fit, &VectorMap::y), fit.score};
}

/// What the frames leave open if `leader` is taken for the truth. A reading in the other direction in time is
/// no rival where a better one in that direction refutes it.
std::vector<std::string> list_untold(const Tests& tests, const VelocityCheck& check,
                                     const VelocityScore& leader) {
    std::vector<std::string> names;
    const auto add = [&](const VelocityHypothesis& rival) {
        add_difference(check.settings, leader.hypothesis, rival, names);
    };
    const VelocityScore* best_there = nullptr;
    for (const VelocityScore& score : check.hypotheses) {
        if (!score.tested || score.hypothesis == leader.hypothesis) continue;
        const bool there = score.hypothesis.other_time != leader.hypothesis.other_time;
        if (there && !best_there) best_there = &score;
        const bool refuted = is_clearly_better(tests, leader, score) ||
                             (there && is_clearly_better(tests, *best_there, score));
        if (!refuted) add(score.hypothesis);
    }
    VelocityHypothesis opposite = leader.hypothesis;
    opposite.other_time = !opposite.other_time;
    if (!(opposite.other_time ? tests.other() : tests.claimed())) add(opposite);
    VelocityHypothesis mirrored = leader.hypothesis;
    if (!check.fit->scale_x) mirrored.scale_x *= -1;
    if (!check.fit->scale_y) mirrored.scale_y *= -1;
    add(mirrored);
    if (!scale_is_listed(*check.fit, leader.hypothesis) &&
        std::find(names.begin(), names.end(), "scale") == names.end())
        names.push_back("scale");
    return names;
}

/// Whether it is evidence enough to recommend its scales.
bool is_sound(const VelocityFit& fit) {
    const auto is_told = [](const std::optional<double>& scale) {
        return scale && std::abs(*scale) <= kMostScale && std::abs(*scale) >= 1 / kMostScale;
    };
    return is_told(fit.scale_x) && is_told(fit.scale_y);
}

/// Decides on `check.verdict`, `untold` and `suggested` from the figures.
void judge(const Tests& tests, VelocityCheck& check) {
    const WarpTest* test = tests.at(check.best.hypothesis.other_time);
    if (!tests.claimed() || !test || test->still_error() < kStillError) return;
    if (check.fit->score >= kExplains && check.fit->score - check.best.score >= kClearScore &&
        !scale_is_listed(*check.fit, check.best.hypothesis)) {
        check.verdict = VelocityVerdict::no_fit;
        if (is_sound(*check.fit))
            check.suggested = correct_settings(check.settings, hypothesis_of(*check.fit));
        return;
    }
    if (check.best.score < kExplains) {
        check.verdict = VelocityVerdict::no_fit;
        return;
    }
    const VelocityScore* refutation = find_refutation(tests, check);
    if (refutation) check.best = *refutation;
    const VelocityScore& leader = refutation ? check.best : check.identity;
    check.suggested = correct_settings(check.settings, leader.hypothesis);
    check.untold = list_untold(tests, check, leader);
    if (refutation) check.verdict = VelocityVerdict::wrong;
    else check.verdict = check.untold.empty() ? VelocityVerdict::confirmed : VelocityVerdict::undecided;
}

/// Under one bias and unit.
VelocityCheck check_reading(const VelocityCheckInput& input) {
    const Tests tests(input);
    VelocityCheck check;
    check.settings = check.suggested = input.settings;
    check.hypotheses = score_all(tests);
    check.best = check.hypotheses.front();
    for (const VelocityScore& score : check.hypotheses)
        if (score.hypothesis == VelocityHypothesis{}) check.identity = score;
    check.rival = check.hypotheses[check.best.hypothesis == VelocityHypothesis{} ? 1 : 0];
    check.fit = fit_scales(tests, check.best.hypothesis);
    const bool next = input.settings.is_next();
    for (const auto* test : {&tests.claimed(), &tests.other()})
        if (*test) {
            (next == (test == &tests.claimed()) ? check.moving_px_a : check.moving_px_b) =
                (*test)->moving_px();
            check.longest_px = std::max(check.longest_px, (*test)->longest_px());
        }
    judge(tests, check);
    return check;
}

/// How well the reading that a check decided on explains the frames.
double leading_score(const VelocityCheck& check) {
    switch (check.verdict) {
        case VelocityVerdict::confirmed:
        case VelocityVerdict::undecided: return check.identity.score;
        case VelocityVerdict::wrong: return check.best.score;
        case VelocityVerdict::no_fit:
            return is_sound(*check.fit) ? std::max(check.best.score, check.fit->score) : check.best.score;
        case VelocityVerdict::untestable: break;
    }
    return 0;
}

/// Holds the claim to another bias or unit.
void try_reading(const VelocityCheckInput& input, const std::vector<Image>& stored,
                 const OtherReading& reading, VelocityCheck& check) {
    VelocityCheckInput other = input;
    other.settings = reading.settings;
    std::vector<Image> vectors;
    for (const Image& image : stored) vectors.push_back(read_vectors(image, reading.settings));
    if (input.vectors_a) other.vectors_a = &vectors.front();
    if (input.vectors_b) other.vectors_b = &vectors.back();
    const VelocityCheck rival = check_reading(other);
    if (rival.verdict == VelocityVerdict::no_fit || rival.verdict == VelocityVerdict::untestable) return;
    const double score = leading_score(rival);
    const double own = check.reading ? check.reading->score : leading_score(check);
    if (score < kExplains) return;
    if (score >= own + kClearScore) {
        check.verdict = VelocityVerdict::wrong;
        check.suggested = rival.suggested;
        check.untold = rival.untold;
        check.reading = VelocityReading{rival.suggested, score};
    } else if (reading.is_common_value && check.verdict == VelocityVerdict::confirmed &&
               score >= own - kClearScore) {
        check.verdict = VelocityVerdict::undecided;
        check.untold = {"bias"};
        check.reading = VelocityReading{rival.suggested, score};
    }
}

}  // namespace

VelocityCheck check_velocity(const VelocityCheckInput& input) {
    require_image(input.color_a, *input.color_a, 3, "the colour of frame A");
    require_image(input.color_b, *input.color_a, 3, "the colour of frame B");
    require_image(input.vectors_a, *input.color_a, 2, "the motion of frame A");
    require_image(input.vectors_b, *input.color_a, 2, "the motion of frame B");
    VelocityCheck check = check_reading(input);
    std::vector<Image> stored;
    for (const Image* vectors : {input.vectors_a, input.vectors_b})
        if (vectors) stored.push_back(stored_vectors(*vectors, input.settings));
    for (const OtherReading& reading : other_readings(stored, input.settings))
        try_reading(input, stored, reading, check);
    check.at_limit = describe_limit(stored, check.reading ? check.reading->settings : input.settings);
    check.sentence = describe_verdict(check);
    return check;
}

}  // namespace aftershade
