// JSON Schemas of scattering profiles: what scattering_profile_parse.cpp takes.
#pragma once

#include <string>

#include "framework/core/schema_pieces.h"

namespace aftershade::schema {

/// A scattering profile as an object, within another document.
json scattering_profile(Variables variables = Variables::no);
/// Of a scattering profile's own file, as text.
std::string scattering_profile_schema();

}  // namespace aftershade::schema
