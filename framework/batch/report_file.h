// report.json of a golden suite, as other programs hand it back.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>

namespace aftershade {

/// Reads `folder`/report.json and calls `use` with it. Throws Error(ErrorKind::capture) where it cannot be
/// read, or `use` misses a key or finds another type.
void with_report(const std::filesystem::path& folder,
                 const std::function<void(nlohmann::ordered_json&)>& use);

}  // namespace aftershade
