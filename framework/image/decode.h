// From a producer's channels to the canonical image of a role.
#pragma once

#include <string>

#include "framework/image/exr_file.h"
#include "framework/image/profile.h"
#include "framework/image/role.h"

namespace aftershade {

/// Reads the stored channels of `role` and brings them into the role's contract: layers added up, depth in metres with
/// +inf for nothing hit, velocity as current minus previous (velocity_next: next minus current) with +y down, ids as
/// integers. A colour without alpha gets alpha 1. Velocity that is NaN or infinite becomes 0.
/// Throws Error(ExitCode::capture), also for ids that are not whole numbers.
Image decode_role(const ExrFile& file, int part, const ChannelRole& role, const RoleDecoding& decoding,
                  const FoundChannels& channels);

/// The arithmetic alone, on stored values in the role's channel order.
void decode_depth(Image& depth, const RoleDecoding& decoding);
void decode_velocity(Image& velocity, const RoleDecoding& decoding);
/// `context` begins the message of the error.
Image decode_ids(const Image& stored, const std::string& context);

}  // namespace aftershade
