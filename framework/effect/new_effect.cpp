#include "framework/effect/new_effect.h"

#include <algorithm>

#include <fmt/format.h>

#include "framework/base/atomic_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

// The parameter's `identity` and the shader's form are what the checks of every effect ask for: at strength 0
// the image is the input, bit for bit.
constexpr const char* kNewManifest = R"({{
  "aftershade": 1,
  "id": "{0}",
  "version": "1.0.0",
  "summary": "Darkens the picture towards its corners.",
  "inputs": {{ "color": {{ "role": "color", "doc": "Scene-linear light." }} }},
  "outputs": {{ "color": {{ "role": "color", "doc": "The light that is left." }} }},
  "params": {{
    "strength": {{ "type": "float", "default": 0.6, "min": 0, "max": 1, "ui": [0, 1], "identity": 0,
      "doc": "0 leaves the picture alone; 1 makes the corners black." }}
  }},
  "passes": [ {{ "name": "main", "shader": "{0}.frag", "reads": ["color"], "writes": ["color"] }} ]
}}
)";

constexpr const char* kNewShader = R"(#version 450 core
#include <pass>

void main() {
    // From the middle of the display window to its corners: 0 to 1. Overscan lies beyond.
    vec2 position = (gl_FragCoord.xy + vec2(frame.origin)) / vec2(frame.display_size) * 2.0 - 1.0;
    float darkness = param.strength * clamp(dot(position, position) / 2.0, 0.0, 1.0);
    vec4 light = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    out_color = vec4(light.rgb * (1.0 - darkness), light.a);
}
)";

constexpr const char* kNewLook = R"({{
  "aftershade": 1,
  "steps": [ {{ "effect": "{0}", "params": {{ "strength": 0.8 }} }} ]
}}
)";

}  // namespace

std::vector<std::pair<fs::path, int>> make_effect(const fs::path& folder, const std::string& id) {
    AtomicFolder made(folder / id);
    std::vector<std::pair<fs::path, int>> files;
    const auto write = [&](const std::string& name, const std::string& text) {
        write_text_file(made.temporary_path() / name, text);
        files.emplace_back(folder / id / name, int(std::ranges::count(text, '\n')));
    };
    write("effect.json", fmt::format(kNewManifest, id));
    write(id + ".frag", kNewShader);
    write("look.json", fmt::format(kNewLook, id));
    made.commit();
    return files;
}

}  // namespace aftershade
