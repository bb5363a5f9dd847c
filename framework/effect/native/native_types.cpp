// Names and sizes of what native code may fill.
#include <algorithm>
#include <array>

#include "framework/effect/native/native_types.h"
#include "framework/plugin/aftershade_plugin.h"

namespace aftershade {

namespace {

struct UniformName {
    const char* name;
    NativeUniformType type;
};

constexpr std::array<UniformName, 12> kUniforms = {{
    {"float", {NativeScalar::float_, 1}},
    {"vec2", {NativeScalar::float_, 2}},
    {"vec3", {NativeScalar::float_, 3}},
    {"vec4", {NativeScalar::float_, 4}},
    {"int", {NativeScalar::int_, 1}},
    {"ivec2", {NativeScalar::int_, 2}},
    {"ivec3", {NativeScalar::int_, 3}},
    {"ivec4", {NativeScalar::int_, 4}},
    {"uint", {NativeScalar::uint_, 1}},
    {"uvec2", {NativeScalar::uint_, 2}},
    {"uvec3", {NativeScalar::uint_, 3}},
    {"uvec4", {NativeScalar::uint_, 4}},
}};

struct ElementName {
    const char* name;
    int components;
};

/// In the order of NativeElement.
constexpr std::array<ElementName, 6> kElements = {
    {{"float", 1}, {"vec2", 2}, {"vec4", 4}, {"uint", 1}, {"uvec2", 2}, {"uvec4", 4}}};

static_assert(int(NativeElement::float_) == AFTERSHADE_FLOAT && int(NativeElement::vec2) == AFTERSHADE_VEC2);
static_assert(int(NativeElement::vec4) == AFTERSHADE_VEC4 && int(NativeElement::uint_) == AFTERSHADE_UINT);
static_assert(int(NativeElement::uvec2) == AFTERSHADE_UVEC2 && int(NativeElement::uvec4) == AFTERSHADE_UVEC4);
static_assert(int(NativeLogLevel::debug) == AFTERSHADE_LOG_DEBUG);
static_assert(int(NativeLogLevel::error) == AFTERSHADE_LOG_ERROR);
static_assert(kMaxNativeTableSide == AFTERSHADE_MAX_TABLE_SIDE);

}  // namespace

std::optional<NativeUniformType> parse_native_uniform_type(std::string_view name) {
    const auto found =
        std::find_if(kUniforms.begin(), kUniforms.end(), [&](const auto& u) { return u.name == name; });
    return found == kUniforms.end() ? std::nullopt : std::optional(found->type);
}

std::string native_uniform_type_name(NativeUniformType type) {
    const auto found =
        std::find_if(kUniforms.begin(), kUniforms.end(), [&](const auto& u) { return u.type == type; });
    return found == kUniforms.end() ? "?" : found->name;
}

std::optional<NativeElement> parse_native_element(std::string_view name) {
    const auto found =
        std::find_if(kElements.begin(), kElements.end(), [&](const auto& e) { return e.name == name; });
    return found == kElements.end() ? std::nullopt : std::optional(NativeElement(found - kElements.begin()));
}

std::string_view native_element_name(NativeElement element) {
    return kElements.at(std::size_t(element)).name;
}

std::size_t native_element_bytes(NativeElement element) {
    return std::size_t(kElements.at(std::size_t(element)).components) * 4;
}

}  // namespace aftershade
