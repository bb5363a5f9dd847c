// The grammar of a scene document, declared once (framework/document/grammar.h), and its values as the
// renderer has them.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/document/grammar.h"
#include "framework/document/grammar_reader.h"
#include "framework/scene/animated.h"

namespace aftershade::scene {

/// Limits that keep a mistyped scene from taking the machine's memory.
inline constexpr std::size_t kMaxObjects = 8192;
inline constexpr std::size_t kMaxLights = 64;
inline constexpr int kMaxAmbientRays = 1024;

/// The document.
const grammar::Block& scene_block();

// Values of a block's literals.
glm::dvec2 vec2(const grammar::Reader& reader, std::string_view key);
glm::dvec3 vec3(const grammar::Reader& reader, std::string_view key);
double number(const grammar::Reader& reader, std::string_view key);
int integer(const grammar::Reader& reader, std::string_view key);
bool flag(const grammar::Reader& reader, std::string_view key);
Animated<double> animated_number(const grammar::Reader& reader, std::string_view key);
Animated<glm::dvec3> animated_vec3(const grammar::Reader& reader, std::string_view key);

}  // namespace aftershade::scene
