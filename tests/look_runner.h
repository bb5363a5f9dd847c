// Runs a look, given as text, over captures in memory.
#pragma once

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "framework/effect/registry.h"
#include "framework/gpu/context.h"
#include "framework/pipeline/look.h"
#include "framework/pipeline/renderer.h"

namespace aftershade::test {

/// A fault in the look ends the test by an exception that lists all faults.
class LookRunner {
public:
    LookRunner(const std::string& look, gpu::Backend backend, std::vector<std::string> taps = {})
        : effects_({data_ / "effects"}) {
        Diagnostics diagnostics;
        const auto node = parse_document(look, "test look", diagnostics);
        if (node)
            if (const auto parsed = parse_look(*node, diagnostics))
                pipeline_ = bind_pipeline(*parsed, effects_, {{}, std::move(taps)}, diagnostics);
        std::ostringstream faults;
        diagnostics.print(faults);
        if (diagnostics.has_errors()) throw std::runtime_error(faults.str());
        context_ = std::make_unique<gpu::Context>(backend);
        renderer_ = std::make_unique<PipelineRenderer>(*context_, pipeline_, data_);
    }

    FrameResult run(const Capture& capture) {
        FrameInputs frame;
        frame.capture = &capture;
        return run(frame);
    }
    FrameResult run(const FrameInputs& frame) {
        return renderer_->render(frame, {"color", "display", "irradiance", "velocity"}, false);
    }
    Image color(const Capture& capture) { return run(capture).images.at("color"); }

private:
    const std::filesystem::path data_ = AFTERSHADE_SOURCE_DIR;
    EffectRegistry effects_;
    Pipeline pipeline_;
    std::unique_ptr<gpu::Context> context_;
    std::unique_ptr<PipelineRenderer> renderer_;
};

/// A look of one step; `params`: the members of its "params".
inline std::string look_of_step(const std::string& effect, const std::string& params) {
    return R"({"aftershade": 1, "steps": [{"effect": ")" + effect + R"(", "params": {)" + params + "}}]}";
}

/// The images that this one step makes of a capture.
inline FrameResult run_step(const std::string& effect, const Capture& capture, const std::string& params) {
    return LookRunner(look_of_step(effect, params), gpu::Backend::osmesa).run(capture);
}

}  // namespace aftershade::test
