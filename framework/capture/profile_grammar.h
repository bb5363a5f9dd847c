// The grammar of a producer's profile, declared once (framework/core/grammar.h).
#pragma once

#include <string>

#include "framework/core/grammar.h"

namespace aftershade {

struct CameraField;
/// Whether a header may give this value in widths of the sensor: "times_sensor_width".
bool counts_in_sensor_widths(const CameraField& field);

/// profiles/<id>.json
const grammar::Block& profile_block();

/// JSON Schema of a profile.
std::string profile_schema();

}  // namespace aftershade
