// Every kind of pass, run by an executor, against the same computed here.
#include <algorithm>

#include "tests/graph/executor_test.h"

namespace aftershade::graph {
namespace {

class PassKindsOn : public GraphOn {
protected:
    static constexpr int kSide = 16;
    static constexpr gpu::TextureDesc kTexels{
        .width = kSide, .height = kSide, .format = gpu::TextureFormat::r32f};
    static Floats scrambled() {
        Floats values(kSide * kSide);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = float((i * 37) % 251) - 100;
        return values;
    }
};
ON_EACH_BACKEND(PassKindsOn);

TEST_P(PassKindsOn, BlendsByAddMinAndMax) {
    const gpu::Program ramp_up = draws("result = float(p.x) - 1.5;");
    const gpu::Program ramp_down = draws("result = 2.0 - 2.0 * float(p.x + p.y);");
    Graph graph;
    std::vector<TextureHandle> results;
    for (const gpu::Blend blend : {gpu::Blend::add, gpu::Blend::min, gpu::Blend::max}) {
        TextureHandle target = graph.cleared("target", kSmall);
        for (const gpu::Program* program : {&ramp_up, &ramp_down}) {
            Pass pass = draw_of("blend", *program, {}, target);
            pass.blend = blend;
            target = graph.add_pass(pass).targets[0];
        }
        graph.keep(target);
        results.push_back(target);
    }
    Executor executor(context(), std::move(graph));
    for (int frame = 0; frame < 2; ++frame) executor.run(false);  // each frame begins at zero
    Floats sum, least, most;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const float up = float(x) - 1.5f, down = 2.0f - 2.0f * float(x + y);
            sum.push_back(up + down);
            least.push_back(std::min({0.0f, up, down}));
            most.push_back(std::max({0.0f, up, down}));
        }
    }
    EXPECT_EQ(executor.texture(results[0])->read_floats(), sum);
    EXPECT_EQ(executor.texture(results[1])->read_floats(), least);
    EXPECT_EQ(executor.texture(results[2])->read_floats(), most);
}

TEST_P(PassKindsOn, TakesTheLeastOfEachTileByImageAtomics) {
    const gpu::Program tiles = computes(R"(layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D source;
layout(r32i, binding = 0) uniform iimage2D tiles;)",
                                        R"(    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    imageAtomicMin(tiles, p / 4, int(texelFetch(source, p, 0).r));)");
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kTexels);
    TextureOptions high;
    high.clear = {1e9, 0, 0, 0};
    Pass pass = with(pass_named("tiles", PassKind::compute, {input}), tiles);
    pass.images = {
        {graph.create_texture("tiles", {.width = 4, .height = 4, .format = gpu::TextureFormat::r32i}, high),
         0, gpu::Access::read_write, 0}};
    pass.groups.count = {2, 2, 1};
    const TextureHandle out = graph.add_pass(pass).images[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    Floats values = scrambled();
    for (int frame = 0; frame < 2; ++frame) {
        executor.texture(input)->upload(values);
        executor.run(false);
        Floats expected(16, 1e9f);
        for (std::size_t i = 0; i < values.size(); ++i) {
            float& tile = expected[i / kSide / 4 * 4 + i % kSide / 4];
            tile = std::min(tile, values[i]);
        }
        EXPECT_EQ(executor.texture(out)->read_floats(), expected) << frame;
        for (float& value : values)
            value += 50;  // the second frame's least is larger: the first must be gone
    }
}

TEST_P(PassKindsOn, DrawsAsManyQuadsAsAComputePassCounted) {
    // Lists the texels above a threshold, then draws each as a quad of 2 x 1 texels that adds its value.
    const gpu::Program list = computes(R"(layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = 0) uniform sampler2D source;
layout(std430, binding = 0) buffer Command { uint vertices; uint instances; uint first; uint base; };
layout(std430, binding = 1) writeonly buffer List { vec4 entries[]; };)",
                                       R"(    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    float value = texelFetch(source, p, 0).r;
    if (value > 100.0) entries[atomicAdd(instances, 1u)] = vec4(p, value, 0.0);)");
    const gpu::Program splat = gpu::Program::draw(context(), R"(#version 450 core
layout(std430, binding = 0) readonly buffer List { vec4 entries[]; };
flat out float value;
void main() {
    vec4 entry = entries[gl_InstanceID];
    vec2 texel = entry.xy + vec2(gl_VertexID & 1, gl_VertexID >> 1) * vec2(2.0, 1.0);
    gl_Position = vec4(texel / 16.0 * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
    value = entry.z;
})",
                                                  R"(#version 450 core
flat in float value;
layout(location = 0) out float result;
void main() { result = value; })",
                                                  "splat");
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kTexels);
    Pass counting = with(pass_named("list", PassKind::compute, {input}), list);
    counting.buffers = {
        {graph.create_buffer("command", {16}, std::vector<std::uint32_t>{4}), 0, gpu::Access::read_write},
        {graph.create_buffer("list", {std::size_t{16} * kSide * kSide}), 1, gpu::Access::write}};
    const auto buffers = graph.add_pass(counting).buffers;
    Pass splats = with(pass_named("splat", PassKind::instances), splat);
    splats.targets = {{graph.cleared("sum", kTexels)}};
    splats.buffers = {{buffers[1], 0, gpu::Access::read}};
    splats.blend = gpu::Blend::add;
    splats.instances.indirect = buffers[0];
    const TextureHandle sum = graph.add_pass(splats).targets[0];
    graph.keep(sum);
    graph.keep(buffers[0]);
    Executor executor(context(), std::move(graph));
    Floats values = scrambled();
    for (int frame = 0; frame < 2; ++frame) {
        executor.texture(input)->upload(values);
        executor.run(false);
        Floats expected(values.size());
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] <= 100) continue;
            ++count;
            expected[i] += values[i];
            if (i % kSide + 1 < kSide) expected[i + 1] += values[i];
        }
        ASSERT_GT(count, 3u);
        EXPECT_EQ(words_of(*executor.buffer(buffers[0])), (std::vector<std::uint32_t>{4, count, 0, 0}));
        EXPECT_EQ(executor.texture(sum)->read_floats(), expected) << frame;
        std::reverse(values.begin(), values.end());
        values[0] = 200;
    }
}

TEST_P(PassKindsOn, DispatchesAsManyGroupsAsAComputePassWrote) {
    const gpu::Program decide = computes(R"(layout(local_size_x = 1) in;
layout(std430, binding = 0) writeonly buffer Groups { uint x; uint y; uint z; };)",
                                         "    x = 3u; y = 2u; z = 1u;");
    const gpu::Program mark = computes(R"(layout(local_size_x = 1) in;
layout(r32ui, binding = 0) uniform writeonly uimage2D marks;)",
                                       "    imageStore(marks, ivec2(gl_WorkGroupID.xy), uvec4(7u));");
    Graph graph;
    Pass deciding = with(pass_named("decide", PassKind::compute), decide);
    deciding.buffers = {{graph.create_buffer("groups", {12}), 0, gpu::Access::write}};
    const BufferHandle groups = graph.add_pass(deciding).buffers[0];
    Pass marking = with(pass_named("mark", PassKind::compute), mark);
    marking.images = {
        {graph.cleared("marks", {.width = kWidth, .height = kHeight, .format = gpu::TextureFormat::r32ui}), 0,
         gpu::Access::write, 0}};
    marking.groups.indirect = groups;
    const TextureHandle marks = graph.add_pass(marking).images[0];
    graph.keep(marks);
    Executor executor(context(), std::move(graph));
    executor.run(false);
    const std::vector<std::uint32_t> expected = {7, 7, 7, 0, 0, 7, 7, 7, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(executor.texture(marks)->read_uints(), expected);
}

TEST_P(PassKindsOn, BuildsAPyramidByPassesThatReadOneLevelAndDrawTheNext) {
    const gpu::Program base = draws("result = texelFetch(source, p, 0).r;");
    const gpu::Program largest = draws(R"(    p *= 2;
    result = max(max(texelFetch(source, p, 0).r, texelFetch(source, p + ivec2(1, 0), 0).r),
                 max(texelFetch(source, p + ivec2(0, 1), 0).r, texelFetch(source, p + ivec2(1, 1), 0).r));)");
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kTexels);
    gpu::TextureDesc desc = kTexels;
    desc.mips = 5;
    TextureHandle pyramid =
        graph.add_pass(draw_of("base", base, {input}, graph.fresh("pyramid", desc))).targets[0];
    for (int level = 1; level < desc.mips; ++level) {
        Pass pass = with(pass_named("down", PassKind::draw), largest);
        pass.reads = {{.texture = pyramid, .level = level - 1}};
        pass.targets = {{pyramid, level, 0}};
        pyramid = graph.add_pass(pass).targets[0];
    }
    graph.keep(pyramid);
    Executor executor(context(), std::move(graph));
    Floats values = scrambled();
    executor.texture(input)->upload(values);
    executor.run(false);
    EXPECT_EQ(executor.texture(pyramid)->read_floats(0), values);
    for (int level = 1; level < desc.mips; ++level) {
        const std::size_t side = std::size_t{kSide} >> level;
        Floats expected(side * side, -1e9f);
        for (std::size_t i = 0; i < values.size(); ++i) {
            float& texel = expected[(i / kSide >> level) * side + (i % kSide >> level)];
            texel = std::max(texel, values[i]);
        }
        EXPECT_EQ(executor.texture(pyramid)->read_floats(level), expected) << level;
    }
}

TEST_P(PassKindsOn, FillsTheLevelsOfATextureThatAsksForItAfterEachWrite) {
    const gpu::Program copy = draws("result = texelFetch(source, p, 0).r;");
    const gpu::Program mean = draws("result = texelFetch(source, ivec2(0), 4).r;");
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kTexels);
    gpu::TextureDesc desc = kTexels;
    desc.mips = 5;
    TextureOptions options;
    options.auto_mips = true;
    TextureHandle pyramid =
        graph.add_pass(draw_of("copy", copy, {input}, graph.create_texture("pyramid", desc, options)))
            .targets[0];
    const TextureHandle first =
        graph.add_pass(draw_of("mean", mean, {pyramid}, graph.fresh("mean", kSmall))).targets[0];
    Pass twice = draw_of("twice", copy, {input}, pyramid);
    twice.blend = gpu::Blend::add;
    pyramid = graph.add_pass(twice).targets[0];
    const TextureHandle second =
        graph.add_pass(draw_of("mean", mean, {pyramid}, graph.fresh("mean", kSmall))).targets[0];
    graph.keep(first);
    graph.keep(second);
    Executor executor(context(), std::move(graph));
    const Floats values = scrambled();
    executor.texture(input)->upload(values);
    executor.run(false);
    double sum = 0;
    for (const float value : values) sum += value;
    const float expected = float(sum / double(values.size()));
    EXPECT_NEAR(executor.texture(first)->read_floats()[0], expected, 1e-4f);
    EXPECT_NEAR(executor.texture(second)->read_floats()[0], 2 * expected, 2e-4f);
}

TEST_P(PassKindsOn, DrawsToTheLayersOfAnArrayAndReadsThemBack) {
    const gpu::Program layers = fragment(R"(
layout(location = 0) out float even;
layout(location = 1) out float odd;
void main() { even = 2.0 * gl_FragCoord.x; odd = even + 1.0; })");
    const gpu::Program last = fragment("layout(location = 0) out float c; void main() { c = 1000.0; }");
    const gpu::Program sum = fragment(R"(
layout(binding = 0) uniform sampler2DArray source;
layout(location = 0) out float result;
void main() {
    result = 0.0;
    for (int i = 0; i < 3; ++i) result += texelFetch(source, ivec3(gl_FragCoord.xy, i), 0).r;
})");
    Graph graph;
    gpu::TextureDesc desc = kSmall;
    desc.layers = 3;
    const TextureHandle array = graph.fresh("array", desc);
    Pass two = with(pass_named("two", PassKind::draw), layers);
    two.targets = {{array, 0, 2}, {array, 0, 0}};
    Pass one = with(pass_named("one", PassKind::draw), last);
    one.targets = {{graph.add_pass(two).targets[0], 0, 1}};
    const TextureHandle written = graph.add_pass(one).targets[0];
    const TextureHandle out =
        graph.add_pass(draw_of("sum", sum, {written}, graph.fresh("out", kSmall))).targets[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    executor.run(false);
    Floats expected;
    for (int i = 0; i < kWidth * kHeight; ++i) expected.push_back(4 * (float(i % kWidth) + 0.5f) + 1001);
    EXPECT_EQ(executor.texture(out)->read_floats(), expected);
}

TEST_P(PassKindsOn, CopiesEveryBit) {
    Graph graph;
    const gpu::TextureDesc desc{.width = kWidth, .height = kHeight, .format = gpu::TextureFormat::rgba32ui};
    const TextureHandle source = graph.import_texture("source", desc);
    Pass copy = pass_named("copy", PassKind::copy, {source});
    copy.targets = {{graph.fresh("copied", desc)}};
    const TextureHandle out = graph.add_pass(copy).targets[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    std::vector<std::uint32_t> bits;
    for (int i = 0; i < 4 * kWidth * kHeight; ++i) bits.push_back(0x7f800000U + 977U * std::uint32_t(i));
    executor.texture(source)->upload(bits);
    executor.run(false);
    EXPECT_EQ(executor.texture(out)->read_uints(), bits);
}

TEST_P(PassKindsOn, CopiesEveryLevel) {
    const gpu::TextureDesc desc{.width = 6, .height = 5, .format = gpu::TextureFormat::r32f, .mips = 3};
    Graph graph;
    const TextureHandle source = graph.import_texture("source", desc);
    Pass copy = pass_named("copy", PassKind::copy, {source});
    copy.targets = {{graph.fresh("copied", desc)}};
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(copy); }),
              "pass 'copy' copies 'source' to level 0 of 'copied' alone; copies take every level");
    copy.targets.front().level = std::nullopt;
    const TextureHandle out = graph.add_pass(copy).targets[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    for (int level = 0; level < 3; ++level)
        executor.texture(source)->upload(
            Floats(std::size_t(std::max(6 >> level, 1) * std::max(5 >> level, 1)), float(level) + 0.5f), 0,
            level);
    executor.run(false);
    EXPECT_EQ(executor.texture(out)->read_floats(0), Floats(30, 0.5f));
    EXPECT_EQ(executor.texture(out)->read_floats(1), Floats(6, 1.5f));
    EXPECT_EQ(executor.texture(out)->read_floats(2), Floats(1, 2.5f));
}

TEST_P(PassKindsOn, CopiesInPlaceWhatIsGivenForEachFrame) {
    Graph graph;
    const gpu::Program one = fragment(R"(
layout(location = 0) out float result;
void main() { result = 1.0; })");
    const TextureHandle source = graph.import_texture("source", kSmall, true);
    Pass copy = pass_named("copy", PassKind::copy, {source});
    copy.targets = {{graph.fresh("copied", kSmall)}};
    Pass add = draw_of("add", one, {}, graph.add_pass(copy).targets[0]);
    add.blend = gpu::Blend::add;
    const TextureHandle out = graph.add_pass(add).targets[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    ASSERT_EQ(executor.texture(out), executor.texture(source));
    for (const float step : {0.5f, 7.5f}) {
        executor.texture(source)->upload(ramp(step));
        executor.run(false);
        Floats expected = ramp(step);
        for (float& value : expected) value += 1;
        EXPECT_EQ(executor.texture(out)->read_floats(), expected);
    }
}

// A copy between two formats is a draw on software GL.
TEST_P(PassKindsOn, CopiesIntoMemoryOfOneFormatWhateverLayThereBefore) {
    Graph graph;
    gpu::TextureDesc integers = kSmall;
    integers.format = gpu::TextureFormat::r32ui;
    const gpu::Program count = fragment(R"(
layout(location = 0) out uint result;
void main() { result = uint(gl_FragCoord.x) + 10u * uint(gl_FragCoord.y); })");
    const gpu::Program convert = fragment(R"(
layout(binding = 0) uniform usampler2D source;
layout(location = 0) out float result;
void main() { result = float(texelFetch(source, ivec2(gl_FragCoord.xy), 0).r); })");
    const TextureHandle source = graph.import_texture("source", kSmall);
    const TextureHandle counted =
        graph.add_pass(draw_of("count", count, {}, graph.fresh("counted", integers))).targets[0];
    const TextureHandle converted =
        graph.add_pass(draw_of("convert", convert, {counted}, graph.fresh("converted", kSmall))).targets[0];
    Pass copy = pass_named("copy", PassKind::copy, {source});
    copy.targets = {{graph.fresh("copied", kSmall)}};
    const TextureHandle copied = graph.add_pass(copy).targets[0];
    graph.keep(converted);
    graph.keep(copied);
    Executor executor(context(), std::move(graph));
    const CompiledGraph& compiled = executor.compiled();
    ASSERT_EQ(slot(compiled, copied), slot(compiled, counted));
    EXPECT_EQ(compiled.slots[std::size_t(slot(compiled, copied))].format, gpu::TextureFormat::r32f);
    executor.texture(source)->upload(ramp(0.5f));
    for (int frame = 0; frame < 2; ++frame) {
        executor.run(false);
        EXPECT_EQ(executor.texture(copied)->read_floats(), ramp(0.5f));
        for (int i = 0; i < kWidth * kHeight; ++i)
            EXPECT_EQ(executor.texture(converted)->read_floats()[std::size_t(i)],
                      float(i % kWidth + 10 * (i / kWidth)));
    }
}

TEST_P(PassKindsOn, ClearsOneLevelOrEveryOne) {
    Graph graph;
    gpu::TextureDesc desc = kTexels;
    desc.mips = 2;
    desc.layers = 2;
    Pass all = pass_named("all", PassKind::clear);
    all.targets = {{graph.fresh("array", desc), std::nullopt, std::nullopt}};
    all.clear_value = {-3, 0, 0, 0};
    Pass one = pass_named("one", PassKind::clear);
    one.targets = {{graph.add_pass(all).targets[0], 1, 0}};
    one.clear_value = {8, 0, 0, 0};
    const TextureHandle out = graph.add_pass(one).targets[0];
    graph.keep(out);
    Executor executor(context(), std::move(graph));
    executor.run(false);
    for (int level = 0; level < 2; ++level) {
        for (int layer = 0; layer < 2; ++layer) {
            const Floats got = executor.texture(out)->read_floats(level, layer);
            EXPECT_EQ(got, Floats(got.size(), level == 1 && layer == 0 ? 8.0f : -3.0f));
        }
    }
}

}  // namespace
}  // namespace aftershade::graph
