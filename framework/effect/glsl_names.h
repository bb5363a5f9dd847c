// How names of a manifest are spelled in GLSL. Internal to framework/effect.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace aftershade {

/// "mode" -> "MODE": a define.
inline std::string upper_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::toupper(c)); });
    return text;
}

/// "tile_list" -> "TileListBuffer": the storage block of a buffer.
inline std::string storage_block_name(const std::string& name) {
    std::string block;
    bool starts_word = true;
    for (const char c : name) {
        if (c == '_') {
            starts_word = true;
            continue;
        }
        block += starts_word ? char(std::toupper(static_cast<unsigned char>(c))) : c;
        starts_word = false;
    }
    return block + "Buffer";
}

}  // namespace aftershade
