// llvmpipe's threads, each on a processor core of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace aftershade::gpu {

/// Which of `cores` each of the process's threads of these names is to keep to; no value: leaves it alone.
/// They are llvmpipe's ("llvmpipe-0", "llvmpipe-1" ...) where those of one renderer are as many as the cores,
/// and more than one; else none, since other threads or processes have their share of the cores.
std::vector<std::optional<int>> cores_of_threads(const std::vector<std::string>& names,
                                                 const std::vector<int>& cores);

/// Has llvmpipe's threads keep to the cores that the process may use, by cores_of_threads(). Short passes
/// wake them so often that Linux leaves two of them on one core while another one sleeps. [any thread]
void spread_rasterizer_threads() noexcept;

}  // namespace aftershade::gpu
