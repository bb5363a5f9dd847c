// The pixels of objects, as an area of a comparison.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/compare/compare_area.h"
#include "framework/document/object_keys.h"
#include "framework/file/exr_file.h"

namespace aftershade {

/// Where the objects cover any of a pixel, however little, in a frame of a capture (what `run` takes), by its
/// Cryptomatte or its role object_id. nullopt for the frame: the capture's only one. Throws
/// Error(ErrorKind::capture) where the capture cannot be read or has neither, for a name that it lacks, and
/// without a frame where it has several.
AreaShape object_area(const std::string& capture, std::optional<int> frame,
                      const std::vector<TableKey>& objects, const ReadLimits& limits = {});

/// "objects 3-7, 'Wheel'": CompareArea::name.
std::string object_area_name(const std::vector<TableKey>& objects);

}  // namespace aftershade
