// The declared names that a shader uses, by its words. Internal to framework/effect.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "framework/effect/glsl_tokens.h"

namespace aftershade {

/// The prefix of a target's name in GLSL.
inline constexpr std::string_view kOut = "out_";

struct ShaderUses {
    using Uses = std::map<std::string, Place, std::less<>>;  ///< by name, with its first place
    using Words = std::unordered_set<std::string_view>;      ///< views of the source

    Words words;
    Words own;      ///< words after a type, or after #define: names of the shader's own
    Uses params;    ///< x of param.x
    Uses natives;   ///< x of native.x
    Uses outputs;   ///< x of out_x, but for names that the shader declares itself
    Words written;  ///< out_x that a statement assigns to, or that a call or a macro may
    Uses unset;     ///< variables of functions that are read, but to which nothing is assigned
    /// x of texelFetch(x, ...), texture(x, ...), textureLod(x, ...), ..., except parameters of functions.
    Uses samplers;
    Uses plain_samplers;          ///< those outside of every #if: what stands within may be left out
    Uses sizes;                   ///< x of x_size, but for names of the shader's own
    std::optional<Place> lights;  ///< first place of lights.count or lights.light

    explicit ShaderUses(ShaderSource source);

private:
    std::unique_ptr<const ShaderSource> source_;
};

}  // namespace aftershade
