// The grammar of a producer's profile, declared once (framework/document/grammar.h).
#pragma once

#include <string>

#include "framework/document/grammar.h"

namespace aftershade {

struct CameraField;
/// Whether a header may give this value in widths of the sensor: "times_sensor_width".
bool counts_in_sensor_widths(const CameraField& field);

/// A profile's source of the angle of view, which no camera holds: it gives the lens.
inline constexpr const char* kFieldOfView = "field_of_view";

/// profiles/<id>.json
const grammar::Block& profile_block();

/// JSON Schema of a profile.
std::string profile_schema();

}  // namespace aftershade
