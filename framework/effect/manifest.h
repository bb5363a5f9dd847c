// The declaration of an effect: effects/<id>/effect.json.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/document.h"
#include "framework/core/param.h"
#include "framework/gpu/commands.h"
#include "framework/gpu/texture.h"

namespace aftershade {

/// An image that the effect takes. A shader reads it under its name; an optional one defines HAS_<NAME> when
/// present.
struct InputSpec {
    std::string name;
    std::string role;
    bool optional = false;
    std::string doc;
    Place place;
};

/// An image that the effect makes. A pass writes it under its name; its texture has the role's channels as
/// floats.
struct OutputSpec {
    std::string name;
    std::string role;
    std::string doc;
    Place place;
};

/// A transient texture between passes; every one can be tapped.
struct TextureSpec {
    std::string name;
    gpu::TextureFormat format = gpu::TextureFormat::rgba32f;
    double scale = 1;  ///< of the working grid's sides, rounded up
    int tile = 0;      ///< one texel per tile of this many px a side, rounded up; 0: `scale` holds
    std::string doc;   ///< one sentence with the unit
    Place place;
};

struct ReadSpec {
    std::string name;  ///< of an input or a texture
    gpu::Filter filter = gpu::Filter::nearest;
    gpu::Wrap wrap = gpu::Wrap::clamp;
    Place place;
};

/// A condition on one parameter ("shape") or on an optional input ("has.velocity"): any of these values.
struct WhenSpec {
    std::string subject;
    std::vector<ParamValue> values;
    Place place;
};

struct PassSpec {
    std::string name;
    std::string shader;  ///< file in the effect's folder
    std::vector<ReadSpec> reads;
    std::vector<std::string> writes;  ///< textures and outputs, in the order of the attachments
    std::map<std::string, std::string> defines;
    std::vector<WhenSpec> when;  ///< all must hold
    Place place;
};

struct PresetSpec {
    std::string name;
    std::map<std::string, ParamValue> values;
};

struct EffectManifest {
    std::string id;
    std::string version;
    std::string summary;
    std::vector<std::string> sources;
    std::vector<InputSpec> inputs;
    std::vector<OutputSpec> outputs;
    std::vector<ParamSpec> params;
    std::vector<TextureSpec> textures;
    std::vector<PassSpec> passes;
    std::vector<PresetSpec> presets;
    std::filesystem::path folder;

    const InputSpec* find_input(const std::string& name) const;
    const OutputSpec* find_output(const std::string& name) const;
    const ParamSpec* find_param(const std::string& name) const;
    const TextureSpec* find_texture(const std::string& name) const;
    const PresetSpec* find_preset(const std::string& name) const;
    std::vector<std::string> param_names() const;
};

/// Parses and checks everything that can be known without GL: names, roles, ranges, that each pass reads only
/// what an earlier one may have written, that every output and texture is written, that shader files exist.
/// Every fault is reported; nullopt if there was one.
std::optional<EffectManifest> parse_manifest(const Node& node, const std::filesystem::path& folder,
                                             Diagnostics& diagnostics);

}  // namespace aftershade
