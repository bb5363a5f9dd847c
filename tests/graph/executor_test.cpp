// Frames of draws: memory, uniforms, timing, observers.
#include "framework/graph/executor.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "framework/graph/rehearsal.h"
#include "tests/graph/executor_test.h"

namespace aftershade::graph {
namespace {

class ExecutorOn : public GraphOn {};
ON_EACH_BACKEND(ExecutorOn);

TEST_P(ExecutorOn, RunsAChainInSharedMemory) {
    const gpu::Program program = twice_plus();
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kSmall);
    TextureHandle last = input;
    constexpr int kPasses = 6;
    for (int i = 0; i < kPasses; ++i)
        last = graph.add_pass(adding("p", program, last, graph.fresh("t" + std::to_string(i), kSmall), 1))
                   .targets[0];
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

TEST_P(ExecutorOn, PrimesItsProgramsAndChangesNothing) {
    const gpu::Program program = draws("result = texelFetch(source, p, 0).r + 1.0;");
    const gpu::Program counts = computes(R"(layout(local_size_x = 2) in;
layout(std430, binding = 0) buffer Counter { uint total; };)",
                                         "    atomicAdd(total, 1u);");
    Graph graph;
    Pass counting = with(pass_named("counts", PassKind::compute), counts);
    counting.buffers = {{graph.create_buffer("total", {16}, {{5, 0, 0, 0}}), 0, gpu::Access::read_write}};
    counting.groups.count = {3, 1, 1};
    const BufferHandle total = graph.add_pass(counting).buffers[0];
    graph.keep(total);
    const TextureHistory sum = graph.create_history("sum", kSmall);
    graph.keep(graph.add_pass(draw_of("add", program, {sum.previous}, sum.current)).targets[0]);
    Executor executor(context(), std::move(graph));
    for (int frame = 1; frame <= 2; ++frame) {
        prime(context(), executor.graph(), executor.compiled());
        executor.run(false);
        EXPECT_EQ(executor.history().textures.at("sum")->read_floats(),
                  Floats(kWidth * kHeight, float(frame)));
        EXPECT_EQ(words_of(*executor.buffer(total))[0], 5u + 6u);
    }
}

TEST_P(ExecutorOn, RunsAChainOfFloatsAndIntegersInSharedMemory) {
    const gpu::Program halves = draws("result = texelFetch(source, p, 0).r * 0.5;"), more = fragment(R"(
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out uint result;
void main() { result = uint(texelFetch(source, ivec2(gl_FragCoord.xy), 0).r) + 3u; })"),
                       to_float = fragment(R"(
layout(binding = 0) uniform usampler2D source;
layout(location = 0) out float result;
void main() { result = float(texelFetch(source, ivec2(gl_FragCoord.xy), 0).r); })");
    const gpu::TextureDesc ids{.width = kWidth, .height = kHeight, .format = gpu::TextureFormat::r32ui};
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kSmall);
    TextureHandle last = input;
    for (int i = 0; i < 3; ++i) {
        last = graph.add_pass(draw_of("halves", halves, {last}, graph.fresh("half", kSmall))).targets[0];
        last = graph.add_pass(draw_of("more", more, {last}, graph.fresh("more", ids))).targets[0];
        last = graph.add_pass(draw_of("float", to_float, {last}, graph.fresh("float", kSmall))).targets[0];
    }
    graph.keep(last);
    Executor executor(context(), std::move(graph));
    EXPECT_EQ(executor.compiled().slots.size(), 3u);
    executor.texture(input)->upload(ramp(64));
    executor.run(false);
    Floats expected = ramp(64);
    for (float& value : expected)
        for (int i = 0; i < 3; ++i) value = std::floor(value / 2) + 3;
    EXPECT_EQ(executor.texture(last)->read_floats(), expected);
}

TEST_P(ExecutorOn, KeepsATapWholeWhileLaterPassesRun) {
    const gpu::Program program = twice_plus();
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kSmall);
    std::vector<TextureHandle> made{input};
    for (int i = 0; i < 5; ++i)
        made.push_back(
            graph.add_pass(adding("p", program, made.back(), graph.fresh("t", kSmall), 0)).targets[0]);
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
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kSmall);
    const TextureHandle out =
        graph.add_pass(adding("out", program, input, graph.fresh("out", kSmall), 0)).targets[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    executor.texture(input)->upload(Floats(kWidth * kHeight, 1));
    for (const float add : {0.25f, 100.0f, 100.0f, 0.25f}) {
        executor.set_uniforms(0, 1, block_of(add));
        executor.run(false);
        EXPECT_EQ(executor.texture(out)->read_floats(), Floats(kWidth * kHeight, 2 + add));
    }
}

TEST_P(ExecutorOn, LeavesCulledPassesOutAndTakesTheirUniformsAllTheSame) {
    const gpu::Program program = twice_plus();
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kSmall);
    const TextureHandle culled =
        graph.add_pass(adding("culled", program, input, graph.fresh("culled", kSmall), 0)).targets[0];
    const TextureHandle out =
        graph.add_pass(adding("out", program, input, graph.fresh("out", kSmall), 0)).targets[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    executor.set_uniforms(0, 1, block_of(5));
    EXPECT_EQ(executor.texture(culled), nullptr);
    const std::vector<PassTime> times = executor.run(true);
    ASSERT_EQ(times.size(), 1u);
    EXPECT_EQ(times[0].pass, "out");
    EXPECT_GE(times[0].milliseconds, 0);
    EXPECT_TRUE(executor.run(false).empty());
}

TEST_P(ExecutorOn, RefusesAPassWithoutAProgramUnlessItIsCulled) {
    Graph graph;
    (void)graph.draw("culled", {}, graph.fresh("culled", kSmall));
    EXPECT_EQ(fault_of([&] { Executor(context(), graph); }), "");
    graph.keep(graph.draw("bare", {}, graph.fresh("out", kSmall)));
    EXPECT_EQ(fault_of([&] { Executor(context(), graph); }), "pass 'bare' has no program");
}

TEST_P(ExecutorOn, RefusesAProgramOfTheOtherKind) {
    const gpu::Program compute = computes("layout(local_size_x = 1) in;", "");
    Graph graph;
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(draw_of("odd", compute, {}, graph.fresh("a", kSmall))); }),
              "pass 'odd' draws, but its program 'compute' does the other");
}

TEST_P(ExecutorOn, WritesTwoTargetsInOnePassAndShowsThemToTheObserver) {
    const gpu::Program program = fragment(R"(
layout(location = 0) out float left;
layout(location = 1) out vec4 right;
void main() { left = gl_FragCoord.x; right = vec4(gl_FragCoord.y); })");
    Graph graph;
    const gpu::TextureDesc rgba{.width = kWidth, .height = kHeight};
    Pass both = draw_of("both", program, {}, graph.fresh("left", kSmall));
    both.targets.push_back({graph.fresh("right", rgba)});
    const auto written = graph.add_pass(both).targets;
    graph.keep(written[1]);
    Executor executor(context(), std::move(graph));
    Names seen;
    executor.run(false, [&](const std::string& pass, const std::string& name, const gpu::Texture& texture) {
        seen.push_back(pass + "/" + name + "=" + std::to_string(texture.read_floats().back()));
    });
    EXPECT_EQ(seen, (Names{"both/left=4.500000", "both/right=2.500000"}));
    const Floats right = executor.texture(written[1])->read_floats();
    EXPECT_EQ(right.front(), 0.5f);
    EXPECT_EQ(right.back(), float(kHeight) - 0.5f);
    EXPECT_EQ(executor.texture(written[0])->read_floats().back(), float(kWidth) - 0.5f);
}

/// New memory that holds zeros spares a first clear to zero, but not where another texture was in it before.
TEST_P(ExecutorOn, ClearsSharedMemoryBeforeEachUseInEachFrame) {
    const gpu::Program one = draws("result = 1.0;");
    const gpu::Program copy = draws("result = texelFetch(source, p, 0).r;");
    for (const auto& [first, second] : {std::pair(10.0f, 100.0f), std::pair(0.0f, 0.0f)}) {
        Graph graph;
        TextureOptions to_first, to_second;
        to_first.clear = {first, 0, 0, 0};
        to_second.clear = {second, 0, 0, 0};
        const auto add_one = [&](const std::string& name, TextureHandle target) {
            Pass pass = draw_of(name, one, {}, target);
            pass.blend = gpu::Blend::add;
            return graph.add_pass(pass).targets[0];
        };
        const TextureHandle a = add_one("a", graph.create_texture("a", kSmall, to_first));
        const TextureHandle b = graph.add_pass(draw_of("b", copy, {a}, graph.fresh("b", kSmall))).targets[0];
        const TextureHandle c = add_one("c", add_one("c", graph.create_texture("c", kSmall, to_second)));
        graph.keep(b);
        graph.keep(c);
        Executor executor(context(), std::move(graph));
        EXPECT_EQ(executor.texture(a), executor.texture(c));
        for (int frame = 0; frame < 3; ++frame) {
            executor.run(false);
            EXPECT_EQ(executor.texture(b)->read_floats(), Floats(kWidth * kHeight, first + 1)) << frame;
            EXPECT_EQ(executor.texture(c)->read_floats(), Floats(kWidth * kHeight, second + 2)) << frame;
        }
    }
}

}  // namespace
}  // namespace aftershade::graph
