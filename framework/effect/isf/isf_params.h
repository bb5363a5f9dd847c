// Inputs of an ISF file as parameters. Internal to framework/effect/isf.
#pragma once

#include <optional>
#include <string>

#include "framework/effect/isf/isf_names.h"

namespace aftershade {

/// The parameter's declaration.
Node param_of_input(const IsfFile& file, const IsfInput& input);
Node param_of_import(const IsfImport& import);

/// The global variable that the shader reads it by; "" for what is an image.
std::string global_of_input(const IsfFile& file, const IsfInput& input, const std::string& param,
                            const std::string& glsl_name);

}  // namespace aftershade
