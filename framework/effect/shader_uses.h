// What a shader uses of what a manifest declares, by its words. Internal to framework/effect.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "framework/effect/glsl_tokens.h"

namespace aftershade {

/// What a target's name in GLSL begins with.
inline constexpr std::string_view kOut = "out_";

struct ShaderUses {
    using Uses = std::map<std::string, Place>;  ///< by name, with its first place

    std::set<std::string> words;
    std::set<std::string> own;  ///< words after a type, or after #define: names of the shader's own
    Uses params;                ///< x of param.x
    Uses natives;               ///< x of native.x
    Uses outputs;               ///< x of out_x, but for names that the shader declares itself
    /// x of texelFetch(x, ...), texture(x, ...), textureLod(x, ...), ..., but for parameters of functions.
    Uses samplers;
    Uses plain_samplers;          ///< those outside of every #if: what stands within may be left out
    Uses sizes;                   ///< x of x_size, but for names of the shader's own
    std::optional<Place> lights;  ///< first place of lights.count or lights.light

    ShaderUses() = default;
    explicit ShaderUses(const std::vector<Token>& tokens);
};

}  // namespace aftershade
