// A hash of what a look is made of: its documents, its effects' manifests, shaders and modules.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/batch/golden_case.h"
#include "framework/effect/registry.h"

namespace aftershade {

/// Remembers what it read. [one thread at a time]
class LookHasher {
public:
    /// As the registry's: folders of effects in order, and the folder of shared GLSL.
    /// `plugins`: folders whose libraries any of the effects may load.
    LookHasher(const std::vector<std::filesystem::path>& effect_folders, std::filesystem::path glsl_folder,
               const std::vector<std::filesystem::path>& plugins = {});

    /// 16 hexadecimal digits over the look (and looks that it uses), `--set`s, the files that values and
    /// masks name, scattering profiles by what they say, and of each of its effects the manifest, its
    /// modules' manifests, native sources and every shader with what it includes; a change of none of them
    /// cannot change a picture on one machine. "" after faults of the look, or where one of them cannot be
    /// read.
    std::string hash(const GoldenCase& test);

private:
    std::string text_of(const GoldenCase& test);
    const std::string& effect_text(const std::string& id);

    EffectRegistry effects_;
    std::filesystem::path glsl_folder_;
    std::string plugins_;                              // hashes of the libraries
    std::map<std::string, std::string> effect_texts_;  // by id
};

}  // namespace aftershade
