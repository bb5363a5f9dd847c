// What a picture was made of, piece by piece, so that a later difference can be traced to one of them.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace aftershade {

/// What a step gave, for one frame.
struct StepHashes {
    std::string step;
    std::map<std::string, std::string> outputs;  ///< hash of the pixels, by output
    bool operator==(const StepHashes&) const = default;
};

/// As a sidecar keeps it; hashes have 16 hexadecimal digits. Older sidecars have none of it.
struct CaseOrigin {
    std::map<std::string, std::string> files;   ///< hash, by name: "effects/bloom/tent.glsl"
    std::map<std::string, std::string> values;  ///< "bloom.radius": "40", as a document writes it
    std::vector<StepHashes> steps;              ///< in the look's order
    bool operator==(const CaseOrigin&) const = default;
};

/// Adds its keys to a sidecar: files, values, steps.
void add_origin(const CaseOrigin& origin, nlohmann::ordered_json& sidecar);
/// The keys of a sidecar, which may be hostile.
CaseOrigin origin_of(const nlohmann::ordered_json& sidecar);

}  // namespace aftershade
