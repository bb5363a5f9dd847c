// Conditions on parameters and optional inputs. Internal to framework/effect.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "framework/document/param.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/effect/param_reader.h"

namespace aftershade {

/// The prefix of a condition on an optional input: "has.velocity".
inline constexpr std::string_view kHasInput = "has.";
/// The prefix of a condition on a number whose values other than 0 make the same passes: "nonzero.gain".
inline constexpr std::string_view kNonzero = "nonzero.";

/// "gain" of "gain" and of "nonzero.gain", "depth" of "has.depth".
std::string name_in_condition(const std::string& subject);

/// Why a condition cannot be tested, or never holds: what it names and the values that it compares with.
std::vector<std::string> faults_of_condition(const EffectManifest& manifest, const WhenSpec& condition);

/// Whether all of them hold with these values and these inputs.
bool conditions_hold(const std::vector<WhenSpec>& conditions, const ParamReader& params,
                     const std::vector<std::string>& present_inputs);

}  // namespace aftershade
