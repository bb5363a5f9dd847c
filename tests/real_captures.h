// Where the renderers' captures lie that are too large for the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace aftershade::test {

/// $AFTERSHADE_CAPTURES, else ../shared/captures beside the repository.
inline std::filesystem::path captures_folder() {
    const char* set = std::getenv("AFTERSHADE_CAPTURES");
    return set ? set : AFTERSHADE_SOURCE_DIR "/../shared/captures";
}

/// Absent ones skip a test, but fail it on CI.
inline std::optional<std::filesystem::path> find_captures(const std::string& inside) {
    const std::filesystem::path root = captures_folder();
    if (std::filesystem::exists(root / inside)) return root / inside;
    const char* ci = std::getenv("CI");
    if (ci && std::string(ci) == "true")
        ADD_FAILURE() << (root / inside) << " is absent; set AFTERSHADE_CAPTURES";
    return std::nullopt;
}

/// Skips the calling test loudly where the capture is absent.
#define AFTERSHADE_REQUIRE_CAPTURE(variable, inside)                 \
    const auto variable = ::aftershade::test::find_captures(inside); \
    if (!variable) GTEST_SKIP() << "SKIPPED: no " << (inside) << "; set AFTERSHADE_CAPTURES"

}  // namespace aftershade::test
