// An effect whose numbers come from one of the libraries of tests/plugins.
#pragma once

#include <filesystem>
#include <string>

#include "tests/temporary_folder.h"

namespace aftershade::test {

/// The folder of those libraries.
inline const std::string kCases = AFTERSHADE_CASES;

/// effects/<id> below `folder`: multiplies by the uniform `gain` of the library with that id, which is 0.5
/// times the frame's number where nothing goes wrong.
inline void write_native_effect(const std::filesystem::path& folder, const std::string& id) {
    std::filesystem::create_directories(folder / "effects" / id);
    write_text(folder / "effects" / id / "effect.json",
               R"({ "aftershade": 1, "version": "1.0.0", "summary": "A test.", "id": ")" + id + R"(",
            "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
            "params": { "gain": { "type": "float", "default": 0.5, "doc": "." } },
            "native": { "uniforms": { "gain": { "type": "float", "doc": "Gain times the frame's number." } } },
            "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ] })");
    write_text(folder / "effects" / id / "main.frag",
               "#version 450 core\n#include <pass>\nvoid main() { out_color = texelFetch(color, "
               "ivec2(gl_FragCoord.xy), 0) * native.gain; }\n");
}

}  // namespace aftershade::test
