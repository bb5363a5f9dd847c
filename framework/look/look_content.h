// The content of a look's effects and values, as text to be hashed, and its requests to OpenColorIO.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/effect/color_param.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// Every file that the pipeline's effects and values name: manifests, modules, shaders with what they
/// include, native sources, pictures, tables and masks.
std::vector<std::filesystem::path> files_of_pipeline(const Pipeline& pipeline,
                                                     const std::filesystem::path& glsl_folder);
/// The same of one step.
std::set<std::filesystem::path> files_of_step(const PipelineStep& step,
                                              const std::filesystem::path& glsl_folder);

/// The content of the files that the step's parameters and its mask name, and of scattering profiles.
/// Throws Error(ErrorKind::usage) for a file that cannot be read.
std::string content_of_values(const PipelineStep& step);

/// The manifest, its modules' manifests, native sources, and every shader with what it includes: each file's
/// name and bytes, in any folder. Throws Error(ErrorKind::usage) for a file that cannot be read.
std::string content_of_effect(const EffectManifest& manifest, const std::filesystem::path& glsl_folder);

struct StepColorRequest {
    const ParamSpec* file = nullptr;  ///< the parameter that it is for; of the step's manifest
    ColorRequest request;
};
/// With every value that the step's parameters may have in any frame.
std::vector<StepColorRequest> color_requests(const PipelineStep& step);

/// Reports those that OpenColorIO cannot meet, each at the value that is at fault, else at `place`.
void check_color_requests(const PipelineStep& step, const Place& place, Diagnostics& diagnostics);

}  // namespace aftershade
