// A shader's function, evaluated on the GPU for 0, 1, 2, ...
#pragma once

#include <string>

#include "framework/image/image.h"
#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {

/// Row 0 of the result holds, for each i below `count` (at most 16384), what `expression` of `int i` is: a
/// vec4 for a format of floats (rgba32f), a uvec4 for rgba32ui. `head` is text before it: includes,
/// functions.
inline Image shader_table(const std::string& head, const std::string& expression, int count,
                          const std::string& format = "rgba32f", gpu::Backend backend = gpu::test_backend()) {
    EffectFolder effects;
    effects.add("table",
                R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "textures": { "values": { "format": ")" +
                    format + R"(", "size": [)" + std::to_string(count) + R"(, 1], "doc": "The table." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] },
                    { "name": "fill", "shader": "fill.frag", "writes": ["values"] } ])",
                "void main() { out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0); }\n");
    write_text(effects.path() / "table/fill.frag",
               kShaderHead + head + "\nvoid main() {\n    int i = int(gl_FragCoord.x);\n    out_values = " +
                   expression + ";\n}\n");
    Bench bench(effects, look_of(R"({ "effect": "table" })"), {{}, {"table.values"}}, backend);
    return bench.run(make_capture({.width = 4, .height = 4})).taps.at("table.values");
}

}  // namespace aftershade::test
