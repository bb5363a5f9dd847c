// NaN and infinite pixels, as results report them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "aftershade/look.h"
#include "framework/host/image_data.h"
#include "framework/run/nan_policy.h"

namespace aftershade::host {

/// Throws Error(capture).
[[noreturn]] void refuse_non_finite(const NonFiniteInfo& found);

/// The capture that effects see: repaired where the policy says so. Adds what was found. Throws
/// Error(capture) where the policy is `fail`.
std::shared_ptr<const Capture::Data> meet_non_finite(std::shared_ptr<const Capture::Data> capture,
                                                     NonFinite policy, std::vector<NonFiniteInfo>& found);

/// NaN and infinite pixels that reading noted in a capture.
std::vector<NonFiniteInfo> non_finite_of(const aftershade::Capture& capture);
std::vector<NonFiniteInfo> non_finite_of(const std::vector<NonFiniteOutput>& outputs);

}  // namespace aftershade::host
