// The look of a golden case with its effects, as a worker binds it, and a hash of what the look is made of.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/effect/registry.h"
#include "framework/golden/golden_case.h"
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
