// Runs a test on each software backend, or skips it with the reason why the backend is not usable.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/gpu/commands.h"
#include "framework/gpu/context.h"
#include "tests/backends.h"

namespace aftershade::gpu {

inline const char* const kFullScreen = R"(#version 450 core
out gl_PerVertex { vec4 gl_Position; };
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
)";

class SoftwareTest : public OnEachBackend {
protected:
    void SetUp() override {
        OnEachBackend::SetUp();
        if (!IsSkipped()) context_ = std::make_unique<Context>(GetParam());
    }

    Context& context() { return *context_; }

    Program fragment(const std::string& body, const std::string& label = "test") {
        return Program::draw(context(), kFullScreen, "#version 450 core\n" + body, label);
    }

    Texture texture(int width, int height, TextureFormat format = TextureFormat::rgba32f) {
        return Texture(context(), {.width = width, .height = height, .format = format}, "test");
    }

    /// Draws `program` into a new float texture and reads it back.
    std::vector<float> drawn(const Program& program, int width, int height, const Bindings& bindings = {}) {
        const Texture target = texture(width, height);
        const Target targets[] = {{.texture = &target}};
        draw(context(), program, targets, bindings);
        return target.read_floats();
    }

private:
    std::unique_ptr<Context> context_;
};

/// The message of the Error that `action` throws; empty where it throws none.
template <typename Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace aftershade::gpu
