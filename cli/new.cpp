#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/verbs.h"
#include "framework/core/atomic_file.h"
#include "framework/core/text.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

struct NewOptions {
    std::string id;
    std::string folder = ".";
};

// The parameter's `identity` and the shader's form are what the checks of every effect ask for: at strength 0
// the image is the input, bit for bit.
constexpr const char* kManifest = R"({{
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

constexpr const char* kShader = R"(#version 450 core
#include <pass>

void main() {
    // From the middle of the display window to its corners: 0 to 1. Overscan lies beyond.
    vec2 position = (gl_FragCoord.xy + vec2(frame.origin)) / vec2(frame.display_size) * 2.0 - 1.0;
    float darkness = param.strength * clamp(dot(position, position) / 2.0, 0.0, 1.0);
    vec4 light = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    out_color = vec4(light.rgb * (1.0 - darkness), light.a);
}
)";

constexpr const char* kLook = R"({{
  "aftershade": 1,
  "steps": [ {{ "effect": "{0}", "params": {{ "strength": 0.8 }} }} ]
}}
)";

int write(const fs::path& file, const std::string& text) {
    write_text_file(file, text);
    return int(std::count(text.begin(), text.end(), '\n'));
}

ExitCode make(const NewOptions& options) {
    Diagnostics diagnostics;
    const EffectRegistry shipped = find_effects({}, diagnostics);
    const fs::path folder = fs::path(options.folder) / options.id;
    std::error_code failure;
    if (!is_snake_case(options.id)) diagnostics.error({"ID"}, "'" + options.id + "' " + kMustBeSnakeCase);
    else if (shipped.contains(options.id))
        diagnostics.error({"ID"}, "an effect that comes with Aftershade is called '" + options.id + "'");
    else if (fs::exists(folder, failure)) diagnostics.error({"ID"}, folder.string() + " is there already");
    stop_at_errors(diagnostics);
    AtomicFolder made(folder);
    const int manifest = write(made.temporary_path() / "effect.json", fmt::format(kManifest, options.id));
    const int shader = write(made.temporary_path() / (options.id + ".frag"), kShader);
    const int look = write(made.temporary_path() / "look.json", fmt::format(kLook, options.id));
    made.commit();
    fmt::print("{}: {} lines\n{}: {} lines\n{}: {} lines\n", (folder / "effect.json").string(), manifest,
               (folder / (options.id + ".frag")).string(), shader, (folder / "look.json").string(), look);
    fmt::print("Run it:   aftershade run {} CAPTURE --effect-path {} -o out.png\n",
               shell_line({(folder / "look.json").string()}), shell_line({options.folder}));
    fmt::print("Check it: aftershade check {}\n", shell_line({folder.string()}));
    return ExitCode::done;
}

}  // namespace

Verb add_new(CLI::App& app) {
    auto options = std::make_shared<NewOptions>();
    app.add_option("id", options->id, "The effect's id and the name of its folder, in snake_case")
        ->required();
    app.add_option("--path", options->folder, "Create the folder here")->capture_default_str();
    return [options] { return make(*options); };
}

}  // namespace aftershade::cli
