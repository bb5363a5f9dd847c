// Small effects written into a folder, and looks over them run in this process.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "framework/effect/registry.h"
#include "framework/gpu/context.h"
#include "framework/look/look.h"
#include "framework/render/renderer.h"
#include "tests/backends.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {

inline const char* const kShaderHead = "#version 450 core\n#include <pass>\n";

/// A folder of effects for --effect-path.
class EffectFolder {
public:
    /// `manifest` is what follows the head; "main.frag" is the shader after its two first lines.
    void add(const std::string& id, const std::string& manifest, const std::string& shader) {
        std::filesystem::create_directories(folder_ / id);
        write_text(folder_ / id / "effect.json",
                   R"({ "aftershade": 1, "version": "1.0.0", "summary": "A test.", "id": ")" + id + "\",\n" +
                       manifest + "}");
        write_text(folder_ / id / "main.frag", kShaderHead + shader);
    }

    /// One pass from color to color: `expression` of `source`, the texel, and of `param`.
    void add_color(const std::string& id, const std::string& expression, const std::string& params = "") {
        add(id,
            R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
               "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"],
                              "writes": ["color"] } ])" +
                (params.empty() ? "" : ",\n\"params\": {" + params + "}"),
            "void main() {\n    vec4 source = texelFetch(color, ivec2(gl_FragCoord.xy), 0);\n    out_color "
            "= " +
                expression + ";\n}\n");
    }

    const std::filesystem::path& path() const { return folder_.path(); }

private:
    TemporaryFolder folder_;
};

/// Steps of a look as text: {"effect": "a"}, {"effect": "b"}.
inline std::string look_of(const std::string& steps) {
    return R"({ "aftershade": 1, "steps": [ )" + steps + " ] }";
}

/// A look bound to effects, with what was said of it.
class Bound {
public:
    Bound(const EffectFolder& effects, const std::string& look, const PipelineOptions& options = {})
        : registry_({effects.path(), std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "effects"}) {
        Diagnostics diagnostics;
        if (const auto node = parse_document(look, "look", diagnostics))
            if (const auto parsed = parse_look(*node, diagnostics))
                pipeline_ = bind_pipeline(*parsed, registry_, options, diagnostics);
        std::ostringstream text;
        diagnostics.print(text);
        faults_ = text.str();
    }
    const std::string& faults() const { return faults_; }  ///< as printed, warnings too
    const Pipeline& pipeline() const { return pipeline_; }

private:
    EffectRegistry registry_;
    Pipeline pipeline_;
    std::string faults_;
};

/// A bound look on a context of its own.
class Bench {
public:
    Bench(const EffectFolder& effects, const std::string& look, const PipelineOptions& options = {},
          gpu::Backend backend = gpu::test_backend(), const RendererOptions& drawing = {})
        : bound_(effects, look, options),
          context_(backend),
          renderer_(context_, bound_.pipeline(), std::filesystem::path(AFTERSHADE_SOURCE_DIR), {}, drawing) {
        EXPECT_EQ(bound_.faults().find("error"), std::string::npos) << bound_.faults();
    }
    FrameResult run(const Capture& capture, const std::vector<std::string>& roles = {"color", "display"}) {
        FrameInputs frame;
        frame.capture = &capture;
        return run(frame, roles);
    }
    FrameResult run(const FrameInputs& frame, const std::vector<std::string>& roles = {"color", "display"}) {
        return renderer_.render(frame, roles, false);
    }
    PipelineRenderer& renderer() { return renderer_; }
    Image color(const Capture& capture) { return run(capture).images.at("color"); }

private:
    Bound bound_;
    gpu::Context context_;
    PipelineRenderer renderer_;
};

}  // namespace aftershade::test
