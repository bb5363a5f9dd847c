// Code that the checks of a manifest's passes share. Internal to framework/effect.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// The pass that is checked, and what the passes before it have left.
struct PassState {
    const EffectManifest& manifest;
    Diagnostics& diagnostics;
    const PassSpec* pass = nullptr;
    std::vector<std::string> writable{};  ///< outputs and textures
    std::set<std::string> used{};
    std::set<std::string> filled{};  ///< written or cleared

    void fault(const Place& place, const std::string& text);
    /// A file of the pass's folder.
    bool is_there(const std::string& file) const;
};

/// That a level or layer, in every turn of a repeated pass, is one that the texture has. `key` is "level" or
/// "layer".
void check_place(PassState& state, const std::string& name, const std::string& key, TurnIndex value,
                 const TextureSpec* texture, bool reads, const Place& place);

/// That what the pass writes is declared, and fits the pass, its other targets and what they hold already.
void check_writes(PassState& state);

}  // namespace aftershade
