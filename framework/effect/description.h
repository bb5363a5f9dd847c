// An effect's declaration, said for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// "float, m", "int", "enum: square, hexagon", "table by object".
std::string type_text(const ParamSpec& spec);
/// The default with its unit, and where it comes from before that: "3 m, else camera.focus_distance".
std::string default_text(const ParamSpec& spec);

/// The text of `describe`: parameters, presets, inputs, outputs; `verbose`: sources, textures, telemetry,
/// passes too.
std::string describe_text(const EffectManifest& manifest, bool verbose);
/// The same as one JSON object; its keys are the manifest's, with every default filled in.
std::string describe_json(const EffectManifest& manifest);
/// The page of the documentation: docs/effects/<id>.md.
std::string describe_markdown(const EffectManifest& manifest);
/// By their groups, in each the recommended ones first; else as they were.
std::vector<const EffectManifest*> in_groups(std::vector<const EffectManifest*> manifests);
/// docs/effects/README.md: one line for each effect, in groups.
std::string index_markdown(const std::vector<const EffectManifest*>& manifests);

}  // namespace aftershade
