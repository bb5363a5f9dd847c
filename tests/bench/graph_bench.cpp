// What the executor costs beside the draws themselves: sixteen copies of a picture through a frame graph, and
// the same sixteen draws by GL alone. scripts/bench graph compares them.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <string>

#include "framework/graph/executor.h"

#include <glad/gl.h>

namespace aftershade {
namespace {

constexpr int kPasses = 16;
constexpr const char* kVertex = R"(#version 450 core
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
)";
constexpr const char* kCopy = R"(#version 450 core
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 c;
void main() { c = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }
)";

gpu::Context& context() {
    static gpu::Context only(gpu::Backend::egl_software);
    return only;
}

gpu::TextureDesc picture(const benchmark::State& state) {
    return {.width = int(state.range(0)), .height = int(state.range(1))};
}

void through_the_executor(benchmark::State& state) {
    const gpu::Program copy = gpu::Program::draw(context(), kVertex, kCopy, "copy");
    graph::FrameGraph graph;
    const graph::TextureHandle input = graph.import_texture("input", picture(state));
    graph::TextureHandle last = input;
    for (int i = 0; i < kPasses; ++i) {
        graph::Pass pass{.name = "copy" + std::to_string(i),
                         .program = {std::shared_ptr<void>(), &copy},
                         .reads = {{last}}};
        pass.targets = {{graph.create_texture("t" + std::to_string(i), picture(state))}};
        last = graph.add_pass(std::move(pass)).targets[0];
    }
    graph.keep(last);
    graph::Executor executor(context(), std::move(graph));
    executor.texture(input)->clear(0.5F);
    for (auto _ : state) {
        executor.run(false);
        context().finish();
    }
    if (executor.texture(last)->read_floats().back() != 0.5F) state.SkipWithError("the copy is wrong");
}

/// The same draws between as many textures: an input, and two to go back and forth between.
void in_a_bare_loop(benchmark::State& state) {
    const gpu::Program copy = gpu::Program::draw(context(), kVertex, kCopy, "copy");
    gpu::Texture input(context(), picture(state), "input");
    const gpu::Texture a(context(), picture(state), "a"), b(context(), picture(state), "b");
    input.clear(0.5F);
    const GladGLContext& gl = context().gl();
    const std::array<const gpu::Texture*, 2> targets = {&a, &b};
    std::array<GLuint, 2> framebuffers{};
    GLuint sampler = 0, vertices = 0;
    gl.CreateFramebuffers(2, framebuffers.data());
    for (std::size_t i = 0; i < 2; ++i)
        gl.NamedFramebufferTexture(framebuffers[i], GL_COLOR_ATTACHMENT0, targets[i]->handle(), 0);
    gl.CreateSamplers(1, &sampler);
    gl.SamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.SamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.CreateVertexArrays(1, &vertices);
    gl.BindVertexArray(vertices);
    gl.BindSampler(0, sampler);
    gl.UseProgram(copy.handle());
    gl.Viewport(0, 0, int(state.range(0)), int(state.range(1)));
    for (auto _ : state) {
        for (std::size_t i = 0; i < kPasses; ++i) {
            gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers[i % 2]);
            gl.BindTextureUnit(0, i == 0 ? input.handle() : targets[(i + 1) % 2]->handle());
            gl.DrawArrays(GL_TRIANGLES, 0, 3);
        }
        gl.Finish();
    }
    gl.BindTextureUnit(0, 0);
    gl.BindSampler(0, 0);
    gl.UseProgram(0);
    gl.BindVertexArray(0);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gl.DeleteFramebuffers(2, framebuffers.data());
    gl.DeleteSamplers(1, &sampler);
    gl.DeleteVertexArrays(1, &vertices);
    if (b.read_floats().back() != 0.5F) state.SkipWithError("the copy is wrong");
}

// Wall time, since llvmpipe draws on threads of its own. At 16 x 16 what is left is the host's own work.
BENCHMARK(through_the_executor)
    ->Args({1920, 1080})
    ->Args({16, 16})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(in_a_bare_loop)->Args({1920, 1080})->Args({16, 16})->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aftershade

BENCHMARK_MAIN();
