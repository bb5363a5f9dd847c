// The variable that names the config of steps that name none, and who has set it.
#pragma once

#include <cstdlib>
#include <string>

namespace aftershade {

inline constexpr const char* kConfigVariable = "OCIO";
/// Set beside it, also for the processes that this one starts, where the user did not write the variable.
inline constexpr const char* kConfigIsOfOption = "AFTERSHADE_OCIO_IS_OF_OPTION";

/// For this process and those that it starts, as if the variable had named it. [not thread-safe]
inline void choose_config(const std::string& path) {
    setenv(kConfigVariable, path.c_str(), 1);
    setenv(kConfigIsOfOption, "1", 1);
}

}  // namespace aftershade
