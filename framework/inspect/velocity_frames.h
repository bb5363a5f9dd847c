// The velocity check of whole frames: each role of motion that they have, as its profile decoded it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/capture/profile.h"
#include "framework/inspect/velocity_result.h"

namespace aftershade {

struct RoleVelocityCheck {
    std::string role;  ///< velocity or velocity_next
    VelocityCheck check;
};

/// Color and the roles of motion: what the check reads of a frame.
std::vector<std::string> velocity_check_roles();

/// Frame `a` comes just before `b`. The claim of a role without a decoding is what docs/conventions.md says
/// of it. Frames of a moving camera may have data windows of their own; both are brought onto the display
/// window. Empty where neither frame has motion. Throws Error(ErrorKind::capture) where one has no color, or
/// where the sizes differ. [thread-safe]
std::vector<RoleVelocityCheck> check_velocity_of_frames(Capture a, Capture b,
                                                        const std::map<std::string, RoleDecoding>& decodings);

}  // namespace aftershade
