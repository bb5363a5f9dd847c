#include "framework/graph/executor.h"

#include <cstring>
#include <utility>

#include "tests/gpu/gpu_test.h"

namespace aftershade::graph {
namespace {

using gpu::TextureFormat;
using Floats = std::vector<float>;

constexpr int kWidth = 5, kHeight = 3;
const gpu::TextureDesc kDesc{.width = kWidth, .height = kHeight, .format = TextureFormat::r32f};

std::vector<std::byte> block_of(float value) {
    std::vector<std::byte> bytes(16);  // std140 rounds a block up to 16 bytes
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

class ExecutorOn : public gpu::SoftwareTest {
protected:
    /// out = source * 2 + add, texel by texel.
    gpu::Program twice_plus() {
        return fragment(R"(
layout(binding = 0) uniform sampler2D source;
layout(std140, binding = 1) uniform Block { float add; };
layout(location = 0) out float result;
void main() { result = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r * 2.0 + add; })");
    }

    static Pass pass(const std::string& name, const gpu::Program& program, TextureHandle source, float add) {
        return {name, &program, {{source, 0}}, {{1, block_of(add)}}};
    }

    static Floats ramp(float step) {
        Floats values(kWidth * kHeight);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = step * float(i);
        return values;
    }
};
ON_SOFTWARE_BACKENDS(ExecutorOn);

TEST_P(ExecutorOn, RunsAChainInSharedMemory) {
    const gpu::Program program = twice_plus();
    FrameGraph graph;
    const TextureHandle input = graph.import_texture("input", kDesc);
    TextureHandle last = input;
    constexpr int kPasses = 6;
    for (int i = 0; i < kPasses; ++i) {
        const TextureHandle target = graph.create_texture("t" + std::to_string(i), kDesc);
        last = graph.add_pass(pass("p" + std::to_string(i), program, last, 1), std::span(&target, 1)).front();
    }
    graph.keep(last);
    Executor executor(context(), std::move(graph));
    EXPECT_EQ(executor.compiled().slots.size(), 3u);
    for (const float step : {1.0f, -3.0f}) {  // the second frame runs in the memory of the first
        executor.texture(input)->upload(ramp(step));
        executor.run(false);
        Floats expected = ramp(step);
        for (float& value : expected)
            for (int i = 0; i < kPasses; ++i) value = value * 2 + 1;
        EXPECT_EQ(executor.texture(last)->read_floats(), expected);
    }
}

TEST_P(ExecutorOn, KeepsATapWholeWhileLaterPassesRun) {
    const gpu::Program program = twice_plus();
    FrameGraph graph;
    const TextureHandle input = graph.import_texture("input", kDesc);
    std::vector<TextureHandle> made{input};
    for (int i = 0; i < 5; ++i) {
        const TextureHandle target = graph.create_texture("t" + std::to_string(i), kDesc);
        made.push_back(graph.add_pass(pass("p", program, made.back(), 0), std::span(&target, 1)).front());
    }
    graph.keep(made[1]);
    graph.keep(made[5]);
    Executor executor(context(), std::move(graph));
    executor.texture(input)->upload(ramp(1));
    executor.run(false);
    EXPECT_EQ(executor.texture(made[1])->read_floats(), ramp(2));
    EXPECT_EQ(executor.texture(made[5])->read_floats(), ramp(32));
}

TEST_P(ExecutorOn, ReplacesAUniformBlockBetweenFrames) {
    const gpu::Program program = twice_plus();
    FrameGraph graph;
    const TextureHandle input = graph.import_texture("input", kDesc);
    const TextureHandle target = graph.create_texture("out", kDesc);
    const TextureHandle out = graph.add_pass(pass("out", program, input, 0), std::span(&target, 1)).front();
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    executor.texture(input)->upload(Floats(kWidth * kHeight, 1));
    for (const float add : {0.25f, 100.0f}) {
        executor.set_uniforms(0, 1, block_of(add));
        executor.run(false);
        EXPECT_EQ(executor.texture(out)->read_floats(), Floats(kWidth * kHeight, 2 + add));
    }
}

TEST_P(ExecutorOn, LeavesCulledPassesOutAndTakesTheirUniformsAllTheSame) {
    const gpu::Program program = twice_plus();
    FrameGraph graph;
    const TextureHandle input = graph.import_texture("input", kDesc);
    const TextureHandle unused = graph.create_texture("unused", kDesc),
                        target = graph.create_texture("out", kDesc);
    const TextureHandle culled =
        graph.add_pass(pass("culled", program, input, 0), std::span(&unused, 1)).front();
    const TextureHandle out = graph.add_pass(pass("out", program, input, 0), std::span(&target, 1)).front();
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    executor.set_uniforms(0, 1, block_of(5));
    EXPECT_EQ(executor.texture(culled), nullptr);
    const std::vector<PassTime> times = executor.run(true);
    ASSERT_EQ(times.size(), 1u);
    EXPECT_EQ(times[0].pass, "out");
    EXPECT_GE(times[0].milliseconds, 0);
}

TEST_P(ExecutorOn, TimesPassesOnlyWhenAsked) {
    const gpu::Program program = twice_plus();
    FrameGraph graph;
    const TextureHandle input = graph.import_texture("input", kDesc),
                        target = graph.create_texture("out", kDesc);
    graph.keep(graph.add_pass(pass("out", program, input, 0), std::span(&target, 1)).front());
    Executor executor(context(), std::move(graph));
    EXPECT_TRUE(executor.run(false).empty());
    EXPECT_EQ(executor.run(true).size(), 1u);
}

TEST_P(ExecutorOn, WritesTwoTargetsInOnePass) {
    const gpu::Program program = fragment(R"(
layout(location = 0) out float left;
layout(location = 1) out vec4 right;
void main() { left = gl_FragCoord.x; right = vec4(gl_FragCoord.y); })");
    FrameGraph graph;
    const gpu::TextureDesc rgba{.width = kWidth, .height = kHeight, .format = TextureFormat::rgba32f};
    const TextureHandle targets[] = {graph.create_texture("left", kDesc),
                                     graph.create_texture("right", rgba)};
    const auto written = graph.add_pass({"both", &program, {}, {}}, targets);
    graph.keep(written[1]);
    Executor executor(context(), std::move(graph));
    executor.run(false);
    const Floats right = executor.texture(written[1])->read_floats();
    EXPECT_EQ(right.front(), 0.5f);
    EXPECT_EQ(right.back(), float(kHeight) - 0.5f);
    EXPECT_EQ(executor.texture(written[0])->read_floats().back(), float(kWidth) - 0.5f);
}

}  // namespace
}  // namespace aftershade::graph
