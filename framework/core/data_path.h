// Where the shipped effects, GLSL modules and profiles lie.
#pragma once

#include <filesystem>

namespace aftershade {

/// $AFTERSHADE_DATA, else the source tree when the executable runs from its build tree, else
/// <prefix>/share/aftershade beside the executable's bin folder. Throws Error(ExitCode::usage) naming the
/// places tried when none of them holds `effects`.
std::filesystem::path data_path();

}  // namespace aftershade
