// The look of a golden case with its effects, as a worker binds it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/batch/golden_case.h"
#include "framework/effect/registry.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"

namespace aftershade {

struct BoundCase {
    Look look;
    Pipeline pipeline;
};

/// Where a case's effects are looked for, in order: those folders, then the shipped effects.
std::vector<std::filesystem::path> effect_folders(const std::vector<std::string>& effect_paths);

/// Throws Error(ErrorKind::usage) where the look has faults; the worker that draws the case names them.
BoundCase bind_case(const GoldenCase& test, EffectRegistry& effects);

}  // namespace aftershade
