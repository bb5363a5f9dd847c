// Runs of the effect over frames in memory, for its tests.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "framework/capture/capture.h"
#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

class TaaRun {
public:
    explicit TaaRun(const std::string& params = "")
        : runner_(R"({"aftershade": 1, "steps": [{"effect": "taa", "params": {)" + params + "}}]}",
                  gpu::test_backend(), {"taa.motion", "taa.age"}) {}

    /// Of the next frame; `cut`: it begins a shot.
    const FrameResult& next(const Capture& capture, bool cut = false) {
        FrameInputs frame;
        frame.capture = &capture;
        frame.begins_shot = cut;
        last_ = runner_.run(frame);
        return last_;
    }
    const Image& color(const Capture& capture, bool cut = false) {
        return next(capture, cut).images.at("color");
    }
    /// Of the last frame.
    const Image& tap(const std::string& texture) const { return last_.taps.at("taa." + texture); }

private:
    LookRunner runner_;
    FrameResult last_;
};

inline const std::vector<std::string>& rejections() {
    static const std::vector<std::string> names{"none", "clamp", "clip", "variance_clip"};
    return names;
}

inline std::string rejection(const std::string& name) {
    return fmt::format(R"("rejection": "{}")", name);
}

inline bool same_bits(const Image& a, const Image& b) {
    return a.floats().size() == b.floats().size() &&
           std::memcmp(a.floats().data(), b.floats().data(), a.floats().size_bytes()) == 0;
}

inline bool is_finite(const Image& image) {
    for (const float value : image.floats())
        if (!std::isfinite(value)) return false;
    return true;
}

/// Another colour and alpha in every pixel, `brightest` at most, at 5 m and at rest.
inline Capture noise(int width, int height, std::uint32_t seed, float brightest = 1, int frame = 1) {
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = 5}, frame);
    std::uint32_t state = seed * 2654435761u + 1;
    for (float& value : capture.images["color"].floats()) {
        state = state * 1664525u + 1013904223u;
        value = brightest * float(state >> 8) / float(1 << 24);
    }
    return capture;
}

inline void set_jitter(Capture& capture, std::array<double, 2> px) {
    capture.header.camera.jitter_px = px;
}

inline void set_velocity(Capture& capture, float x, float y) {
    Image& velocity = capture.images.at("velocity");
    for (std::size_t i = 0; i < velocity.floats().size(); i += 2) {
        velocity.floats()[i] = x;
        velocity.floats()[i + 1] = y;
    }
}

inline void remove_role(Capture& capture, const std::string& role) {
    capture.images.erase(role);
    std::erase(capture.header.roles, role);
}

}  // namespace aftershade::test
