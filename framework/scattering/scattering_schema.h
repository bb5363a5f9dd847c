// JSON Schemas of scattering profiles: what scattering_profile_parse.cpp takes.
#pragma once

#include "framework/core/schema_pieces.h"

namespace aftershade::schema {

/// A scattering profile as an object, within another document.
json scattering_profile(Variables variables = Variables::no);
/// Of a scattering profile's own file, with its head.
json scattering_profile_file();

}  // namespace aftershade::schema
