#include "framework/inspect/velocity_report.h"
#include "framework/image/role.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "framework/base/text.h"

namespace aftershade {

namespace {

/// A shaded ball seems to move 5 % less than it does, as its light stays where it is; listed scales are an
/// octave apart.
constexpr double kFitOctaves = 0.25;
/// Of the difference between the frames: a rival that removes so much more is mentioned.
constexpr double kClearlyMore = 0.05;

bool is_reversed(const VelocitySettings& settings) {
    return settings.delta == "prev-cur" || settings.delta == "cur-next";
}

std::string delta_name(bool next, bool reversed) {
    if (next) return reversed ? "cur-next" : "next-cur";
    return reversed ? "prev-cur" : "cur-prev";
}

std::string role_name(const VelocitySettings& settings) {
    const auto roles = channel_roles();
    return std::ranges::find_if(roles,
                                [&](const ChannelRole& role) {
                                    return role.kind == RoleKind::motion &&
                                           role.to_next == settings.is_next();
                                })
        ->name;
}

std::string percent(double score) {
    return fmt::format("{:.0f} %", 100 * score);
}

std::string scale_text(const std::array<double, 2>& scale) {
    return scale[0] == scale[1] ? fmt::format("{:.3g}", scale[0])
                                : fmt::format("[{:.3g}, {:.3g}]", scale[0], scale[1]);
}

/// "delta from prev-cur to cur-prev and y_axis from up to down".
std::string describe_change(const VelocitySettings& from, const VelocitySettings& to) {
    std::vector<std::string> changes;
    if (from.delta != to.delta) changes.push_back(fmt::format("delta from {} to {}", from.delta, to.delta));
    if (from.y_axis != to.y_axis)
        changes.push_back(fmt::format("y_axis from {} to {}", from.y_axis, to.y_axis));
    if (from.unit != to.unit) changes.push_back(fmt::format("unit from {} to {}", from.unit, to.unit));
    if (from.scale != to.scale)
        changes.push_back(fmt::format("scale from {} to {}", scale_text(from.scale), scale_text(to.scale)));
    if (from.bias != to.bias)
        changes.push_back(fmt::format("bias from {:.4g} to {:.4g}", from.bias, to.bias));
    if (from.exchange_channels != to.exchange_channels) changes.push_back("the order of the two channels");
    std::string text = joined(changes, " and ");
    if (from.is_next() != to.is_next())
        text += fmt::format(" (the channels belong to role {}, not {})", role_name(to), role_name(from));
    return text;
}

std::string describe_settings(const VelocitySettings& settings) {
    std::string text = fmt::format("delta {}, y_axis {}", settings.delta, settings.y_axis);
    if (settings.unit != "px") text += ", unit " + settings.unit;
    if (settings.scale != std::array<double, 2>{1, 1}) text += ", scale " + scale_text(settings.scale);
    if (settings.bias != 0) text += fmt::format(", bias {:.4g}", settings.bias);
    if (settings.exchange_channels) text += ", channels exchanged";
    return text;
}

bool is_close(const std::optional<double>& scale, double listed) {
    return !scale || (*scale * listed > 0 && std::abs(std::log2(*scale / listed)) <= kFitOctaves);
}

std::string describe_untestable(const VelocityCheck& check) {
    const int moving_px = std::max(check.moving_px_a, check.moving_px_b);
    if (moving_px == 0 && check.longest_px > 0)
        return fmt::format(
            "Undecided: no vector is as long as a pixel (the longest is {:.3g} px); use frames in which "
            "something moves, or set the unit if the pictures do move",
            check.longest_px);
    if (moving_px == 0)
        return "Undecided: nothing moves; every vector is 0 or missing; use frames in which "
               "something moves";
    if (!check.identity.tested && check.best.tested)
        return fmt::format("Undecided: {} is read in frame {}, which has none; use frames that have it",
                           role_name(check.settings), check.settings.is_next() ? "A" : "B");
    if (check.best.tested)
        return "Undecided: the two pictures are the same where the vectors move; use two different frames";
    return fmt::format("Undecided: only {} with motion vectors; use frames in which more moves",
                       counted(std::size_t(moving_px), "pixel"));
}

std::string scale_or_unknown(const std::optional<double>& scale) {
    return scale ? fmt::format("{:.3f}", *scale) : "undecided";
}

std::string describe_no_fit(const VelocityCheck& check) {
    const std::string none_fits = fmt::format(
        "The profile is not confirmed: no change of sign, order or factor of 2 fits (the profile's own "
        "reading "
        "removes {} of the difference between the frames, the best listed {})",
        percent(check.identity.score), percent(check.best.score));
    if (check.suggested == check.settings && check.fit->score > check.best.score + kClearlyMore)
        return fmt::format(
            "{}; free scales (x {}, y {}) remove {}, but these frames are too little evidence for a change; "
            "use "
            "frames in which more moves, along both axes",
            none_fits, scale_or_unknown(check.fit->scale_x), scale_or_unknown(check.fit->scale_y),
            percent(check.fit->score));
    if (check.suggested == check.settings)
        return fmt::format(
            "No reading of the vectors explains the pictures: the best removes {} of the difference between "
            "the frames, the profile's own {}; they are not the vectors of these two frames, or noise hides "
            "the motion",
            percent(check.best.score), percent(check.identity.score));
    return fmt::format(
        "{}, but free scales remove {}; change {}, or ask the producer for the unit and the time of the "
        "vectors",
        none_fits, percent(check.fit->score), describe_change(check.settings, check.suggested));
}

std::string row(const VelocityCheck& check, const char* label, const VelocityScore& score) {
    return fmt::format("  {:<12} {:>6}  {}\n", label, score.tested ? percent(score.score) : "-",
                       describe_settings(correct_settings(check.settings, score.hypothesis)));
}

std::string describe_reading(const VelocityCheck& check) {
    if (check.verdict == VelocityVerdict::wrong)
        return fmt::format(
            "The profile is wrong: change {}; that removes {} of the difference between the frames, the "
            "profile's own reading {}{}",
            describe_change(check.settings, check.suggested), percent(check.reading->score),
            percent(check.identity.score),
            check.untold.empty() ? ""
                                 : " (these frames do not decide " + joined(check.untold, " and ") + ")");
    return fmt::format(
        "The profile fits ({}: {} of the difference between the frames removed), but so does bias {:.4g} "
        "({}), the stored value of many pixels; if these do not move, set \"bias\": {:.4g}",
        describe_settings(check.settings), percent(check.identity.score), check.reading->settings.bias,
        percent(check.reading->score), check.reading->settings.bias);
}

std::string describe_without_limit(const VelocityCheck& check) {
    const std::string own = percent(check.identity.score), settings = describe_settings(check.settings);
    const std::string untold = joined(check.untold, " and ");
    if (check.reading) return describe_reading(check);
    switch (check.verdict) {
        case VelocityVerdict::confirmed:
            return fmt::format(
                "The profile is right: with {} the vectors remove {} of the difference between the frames, "
                "the "
                "best other reading {}",
                settings, own, percent(check.rival.score));
        case VelocityVerdict::undecided:
            if (check.best.score >= check.identity.score + kClearlyMore)
                return fmt::format(
                    "Undecided: with {} the vectors remove {} of the difference between the frames, with "
                    "{} "
                    "{}, but uniform motion and uncovered background explain that too; use frames in which "
                    "things turn, bounce or change their speed",
                    settings, own, describe_settings(correct_settings(check.settings, check.best.hypothesis)),
                    percent(check.best.score));
            return fmt::format(
                "The profile fits ({}: {} of the difference between the frames removed), but these frames do "
                "not decide {}; use frames in which things turn, bounce or change their speed",
                settings, own, untold);
        case VelocityVerdict::wrong:
            return fmt::format(
                "The profile is wrong: change {}; that removes {} of the difference between the frames, the "
                "profile's own reading {}{}",
                describe_change(check.settings, check.suggested), percent(check.best.score), own,
                untold.empty() ? "" : " (these frames do not decide " + untold + ")");
        case VelocityVerdict::no_fit: return describe_no_fit(check);
        case VelocityVerdict::untestable: break;
    }
    return describe_untestable(check);
}

}  // namespace

const char* velocity_verdict_name(VelocityVerdict verdict) noexcept {
    switch (verdict) {
        case VelocityVerdict::confirmed: return "confirmed";
        case VelocityVerdict::undecided: return "undecided";
        case VelocityVerdict::wrong: return "wrong";
        case VelocityVerdict::no_fit: return "no_fit";
        case VelocityVerdict::untestable: break;
    }
    return "untestable";
}

bool scale_is_listed(const VelocityFit& fit, const VelocityHypothesis& hypothesis) {
    return fit.other_time == hypothesis.other_time && fit.swapped == hypothesis.swapped &&
           is_close(fit.scale_x, hypothesis.scale_x) && is_close(fit.scale_y, hypothesis.scale_y);
}

VelocityHypothesis hypothesis_of(const VelocityFit& fit) {
    return {fit.other_time, fit.swapped, fit.scale_x.value_or(1), fit.scale_y.value_or(1)};
}

VelocitySettings correct_settings(const VelocitySettings& settings, const VelocityHypothesis& hypothesis) {
    VelocitySettings corrected = settings;
    const bool up = settings.y_axis == "up";
    const bool mirrored = hypothesis.scale_x * hypothesis.scale_y < 0;
    // Where the axes are exchanged, the sign of `up` has been given to what is now x.
    const bool reverse = (hypothesis.scale_x < 0) != (hypothesis.swapped && up);
    corrected.delta =
        delta_name(settings.is_next() != hypothesis.other_time, is_reversed(settings) != reverse);
    corrected.y_axis = up != mirrored ? "up" : "down";
    corrected.exchange_channels = settings.exchange_channels != hypothesis.swapped;
    if (hypothesis.swapped) std::swap(corrected.scale[0], corrected.scale[1]);
    const double x = std::abs(hypothesis.scale_x), y = std::abs(hypothesis.scale_y);
    if (x == 0.5 && y == 0.5 && settings.unit == "uv") {
        corrected.unit = "ndc";
    } else if (x == 2 && y == 2 && settings.unit == "ndc") {
        corrected.unit = "uv";
    } else {
        corrected.scale[0] *= x;
        corrected.scale[1] *= y;
    }
    return corrected;
}

void add_difference(const VelocitySettings& settings, const VelocityHypothesis& one,
                    const VelocityHypothesis& other, std::vector<std::string>& names) {
    const auto add = [&](bool differs, const char* name) {
        if (differs && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    const VelocitySettings first = correct_settings(settings, one),
                           second = correct_settings(settings, other);
    add(is_reversed(first) != is_reversed(second), "delta");
    add(first.is_next() != second.is_next(), "delta (cur-prev or next-cur)");
    add(first.y_axis != second.y_axis, "y_axis");
    add(first.exchange_channels != second.exchange_channels, "order of channels");
    add(first.unit != second.unit || first.scale != second.scale, "scale");
}

std::string describe_verdict(const VelocityCheck& check) {
    const std::string text = describe_without_limit(check);
    return check.at_limit.empty() ? text
                                  : text + "; " + check.at_limit +
                                        ": longer vectors were cut off; have the producer write floats";
}

std::string format_velocity_check(const VelocityCheck& check) {
    std::string text = fmt::format("{}: {}\n", role_name(check.settings), check.sentence);
    if (check.reading)
        text += fmt::format("  {:<12} {:>6}  {}\n", "other bias", percent(check.reading->score),
                            describe_settings(check.reading->settings));
    if (!check.fit) return text;
    text += fmt::format("  moving: {} px in A, {} px in B, at most {:.1f} px a frame\n", check.moving_px_a,
                        check.moving_px_b, check.longest_px);
    text += row(check, "as claimed", check.identity);
    int shown = 0;
    for (const VelocityScore& score : check.hypotheses)
        if (score.hypothesis != VelocityHypothesis{} && score.tested && shown++ < 4)
            text += row(check, "", score);
    VelocityHypothesis read_as;
    read_as.other_time = check.fit->other_time;
    return text + fmt::format("  {:<12} {:>6}  x {}, y {} times the decoded vectors{}, delta {}\n",
                              "free scale", percent(check.fit->score), scale_or_unknown(check.fit->scale_x),
                              scale_or_unknown(check.fit->scale_y),
                              check.fit->swapped ? " with x and y exchanged" : "",
                              correct_settings(check.settings, read_as).delta);
}

}  // namespace aftershade
