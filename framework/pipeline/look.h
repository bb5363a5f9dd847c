// The user's JSON: ordered steps, no file paths inside.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/document.h"

namespace aftershade {

/// "in": {"depth": "capture.depth"}: where one input comes from.
struct WiringSpec {
    std::string input;
    std::string source;  ///< "capture", or the name of an earlier step
    std::string output;  ///< a role of the capture, or an output of that step
    Place place;
};

struct LookStep {
    std::string name;  ///< the effect's id unless the look says otherwise
    std::string effect;
    bool enabled = true;
    std::optional<std::string> preset;
    std::vector<Member> params;  ///< values are read against the effect's manifest
    std::vector<WiringSpec> wiring;
    Place place;  ///< of the step
    Place effect_place;
    Place preset_place;
};

struct Look {
    std::string file;
    std::vector<LookStep> steps;
};

/// Reads the form of the document; whether its effects exist and its values fit is compile_pipeline's to say.
std::optional<Look> read_look(const std::filesystem::path& path, Diagnostics& diagnostics);
std::optional<Look> parse_look(const Node& node, Diagnostics& diagnostics);

}  // namespace aftershade
