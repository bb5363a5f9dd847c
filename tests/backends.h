// Which GL backends tests draw on, and which of them this machine has.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "framework/base/text.h"
#include "framework/gpu/context.h"

namespace aftershade::gpu {

/// Empty where `backend` is usable; probed once for the whole run.
inline std::string why_not(Backend backend) {
    static const std::vector<BackendReport> reports = probe_backends();
    for (const BackendReport& report : reports)
        if (report.backend == backend) return report.reason;
    return "unknown backend";
}

/// What tests draw on: $AFTERSHADE_TEST_BACKENDS, such as "egl" on a GPU, or both kinds of software.
inline const std::vector<Backend>& test_backends() {
    static const std::vector<Backend> named = [] {
        const char* variable = std::getenv("AFTERSHADE_TEST_BACKENDS");
        std::vector<Backend> backends;
        for (const std::string_view name : split(variable ? variable : "egl-software,osmesa", ',')) {
            const auto backend = parse_backend(name);
            if (!backend)
                throw std::runtime_error("AFTERSHADE_TEST_BACKENDS: no backend " + std::string(name));
            backends.push_back(*backend);
        }
        return backends;
    }();
    return named;
}

/// The first of them that works, for what is the same on all.
inline Backend test_backend() {
    static const auto found =
        std::ranges::find_if(test_backends(), [](Backend backend) { return why_not(backend).empty(); });
    return found == test_backends().end() ? test_backends().front() : *found;
}

/// Names the backend in a test's name.
inline std::string parameter_name(const testing::TestParamInfo<Backend>& info) {
    std::string name(backend_name(info.param));
    std::ranges::replace(name, '-', '_');
    return name;
}

/// Ends the test with the reason where `backend` is not usable. Mesa has no OSMesa from 25.1 on.
#define SKIP_WITHOUT(backend) \
    if (const std::string reason = aftershade::gpu::why_not(backend); !reason.empty()) GTEST_SKIP() << reason

/// A test on each of test_backends(). The two kinds of software draw the same bits.
class OnEachBackend : public testing::TestWithParam<Backend> {
protected:
    void SetUp() override { SKIP_WITHOUT(GetParam()); }
};

}  // namespace aftershade::gpu

#define ON_EACH_BACKEND(suite)                                                                     \
    INSTANTIATE_TEST_SUITE_P(Backends, suite, testing::ValuesIn(aftershade::gpu::test_backends()), \
                             aftershade::gpu::parameter_name)
