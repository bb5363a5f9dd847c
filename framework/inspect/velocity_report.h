// The words of a velocity check: which settings differ, what to change.
#pragma once

#include <string>
#include <vector>

#include "framework/inspect/velocity_result.h"

namespace aftershade {

const char* velocity_verdict_name(VelocityVerdict verdict) noexcept;

/// The settings under which the decoded vectors come out as `hypothesis` makes them.
VelocitySettings correct_settings(const VelocitySettings& settings, const VelocityHypothesis& hypothesis);

/// Plain text of several lines: the sentence, the claim beside its rivals, the free scale.
std::string format_velocity_check(const VelocityCheck& check);

/// Whether the scales of the fit are, within its own accuracy, those of the listed hypothesis; where nothing
/// shows a scale, it is. False for other signs, order or time.
bool scale_is_listed(const VelocityFit& fit, const VelocityHypothesis& hypothesis);

/// With scale 1 for an axis that nothing shows.
VelocityHypothesis hypothesis_of(const VelocityFit& fit);

/// Adds the settings in which two hypotheses differ to `names`, each once.
void add_difference(const VelocitySettings& settings, const VelocityHypothesis& one,
                    const VelocityHypothesis& other, std::vector<std::string>& names);

/// VelocityCheck::sentence, from everything else in it.
std::string describe_verdict(const VelocityCheck& check);

}  // namespace aftershade
