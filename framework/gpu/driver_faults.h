// What keeps EGL from a device: the files by which libglvnd finds drivers, libraries that do not load,
// devices that may not be opened. Internal to framework/gpu.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade::gpu {

/// "; ..." for a message of dlerror: what it means, and what helps. "" where that is not known.
std::string loader_remedy(std::string_view message);

/// Why EGL may list no GPU, a clause for each cause, by the files below `root`. Loads the libraries that
/// vendor files name. Empty where only the GPU is missing. [any thread]
std::vector<std::string> hardware_faults(const std::filesystem::path& root);
/// Likewise of Mesa's software device.
std::vector<std::string> software_faults(const std::filesystem::path& root);

}  // namespace aftershade::gpu
