// Which GL backends this machine has, for tests that name one.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/gpu/context.h"

namespace aftershade::gpu {

/// Empty where `backend` is usable; probed once for the whole run.
inline std::string why_not(Backend backend) {
    static const std::vector<BackendReport> reports = probe_backends();
    for (const BackendReport& report : reports)
        if (report.backend == backend) return report.reason;
    return "unknown backend";
}

/// Names the backend in a test's name.
inline std::string parameter_name(const testing::TestParamInfo<Backend>& info) {
    return info.param == Backend::osmesa ? "osmesa" : "egl_software";
}

/// Ends the test with the reason where `backend` is not usable. Mesa has no OSMesa from 25.1 on.
#define SKIP_WITHOUT(backend) \
    if (const std::string reason = aftershade::gpu::why_not(backend); !reason.empty()) GTEST_SKIP() << reason

/// A test on both software backends, each of which draws the same bits.
class OnSoftware : public testing::TestWithParam<Backend> {
protected:
    void SetUp() override { SKIP_WITHOUT(GetParam()); }
};

}  // namespace aftershade::gpu

#define ON_SOFTWARE_BACKENDS(suite)                                                                \
    INSTANTIATE_TEST_SUITE_P(                                                                      \
        Software, suite,                                                                           \
        testing::Values(aftershade::gpu::Backend::egl_software, aftershade::gpu::Backend::osmesa), \
        aftershade::gpu::parameter_name)
