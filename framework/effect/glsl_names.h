// How names of a manifest are spelled in GLSL. Internal to framework/effect.
#pragma once

#include <string>

#include "framework/document/glsl_text.h"

namespace aftershade {

/// "tile_list" -> "TileListBuffer": the storage block of a buffer.
inline std::string storage_block_name(const std::string& name) {
    return camel_case(name) + "Buffer";
}

}  // namespace aftershade
