// Text of shaders that is made of names and numbers. No GL: whoever compiles it is above core.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace aftershade {

/// "mode" -> "MODE": a define.
std::string upper_case(std::string text);
/// "object_scales" -> "ObjectScales": a type.
std::string camel_case(const std::string& name);
/// `text` with each "$name" replaced by what `values` must have for it.
std::string filled(std::string_view text, const std::map<std::string, std::string>& values);
/// The float that the shader computes with, in brackets for its sign.
std::string glsl_float(double value);

}  // namespace aftershade
