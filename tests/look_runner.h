// Runs a look, given as text, over captures in memory.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aftershade/host.h"
#include "framework/gpu/context.h"
#include "framework/host/rendering.h"
#include "tests/backends.h"

namespace aftershade::test {

/// A session of the public API, but with captures and results of the modules below: tests look at more of
/// them than the API gives. A fault in the look ends the test by an exception that lists all faults.
class LookRunner {
public:
    LookRunner(const std::string& look, gpu::Backend backend, std::vector<std::string> taps = {})
        : host_({.data = AFTERSHADE_SOURCE_DIR, .backend = host::Backend(int(backend))}),
          look_(host_.parse_look(look, {.taps = std::move(taps), .name = "test look"})),
          session_(look_.session()) {}

    FrameResult run(const Capture& capture) {
        FrameInputs frame;
        frame.capture = &capture;
        return run(frame);
    }
    FrameResult run(const FrameInputs& frame) {
        const auto public_capture = [&](const Capture* capture) -> std::optional<host::Capture> {
            if (!capture) return std::nullopt;
            return host::Access::capture({*capture, {}, frame.scale});
        };
        const auto previous = public_capture(frame.at(-1)), next = public_capture(frame.at(1));
        const host::Result result =
            session_.render_subframe(*public_capture(frame.capture), frame.subframe, frame.subframe_count,
                                     {.non_finite = host::NonFinite::ignore,
                                      .previous = previous ? &*previous : nullptr,
                                      .next = next ? &*next : nullptr,
                                      .begins_shot = frame.begins_shot,
                                      .fps = frame.fps});
        return host::Access::frame(result);
    }
    Image color(const Capture& capture) { return run(capture).images.at("color"); }

private:
    host::Host host_;
    host::Look look_;
    host::Session session_;
};

/// A look of one step; `params`: the members of its "params".
inline std::string look_of_step(const std::string& effect, const std::string& params) {
    return R"({"aftershade": 1, "steps": [{"effect": ")" + effect + R"(", "params": {)" + params + "}}]}";
}

/// The images that this one step makes of a capture.
inline FrameResult run_step(const std::string& effect, const Capture& capture, const std::string& params) {
    return LookRunner(look_of_step(effect, params), gpu::test_backend()).run(capture);
}

}  // namespace aftershade::test
