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
/// The prefix of a condition on a parameter whose values other than its identity make the same passes:
/// "changes.gamma".
inline constexpr std::string_view kChanges = "changes.";

/// "gain" of "gain", "nonzero.gain" and "changes.gain", "depth" of "has.depth".
std::string name_in_condition(const std::string& subject);

/// Gives the manifest's conditions the identities of their parameters.
void note_identities(EffectManifest& manifest);

/// Why a condition cannot be tested, or never holds: what it names and the values that it compares with.
std::vector<std::string> faults_of_condition(const EffectManifest& manifest, const WhenSpec& condition);

/// Whether all of them hold with these values and these inputs.
bool conditions_hold(const std::vector<WhenSpec>& conditions, const ParamReader& params,
                     const std::vector<std::string>& present_inputs);

}  // namespace aftershade
