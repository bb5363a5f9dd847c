// Draws of quads and points, and commands whose numbers a buffer holds.
#include <array>
#include <span>

#include "framework/base/error.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

using Floats = std::vector<float>;
constexpr int kWidth = 8, kHeight = 4;

class InstancesOn : public SoftwareTest {
protected:
    /// Instance i covers the texels from (i, i % 3), two wide and one high, with i + 1.
    Program quads() {
        return Program::draw(context(), R"(#version 450 core
flat out float value;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 texel = vec2(gl_InstanceID, gl_InstanceID % 3) + corner * vec2(2.0, 1.0);
    gl_Position = vec4(texel / vec2(8.0, 4.0) * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
    value = float(gl_InstanceID + 1);
})",
                             kFragment, "quads");
    }

    /// Instance i covers the one texel ((5 * i) % 8, i % 4) with i + 1.
    Program points() {
        return Program::draw(context(), R"(#version 450 core
flat out float value;
void main() {
    vec2 texel = vec2((5 * gl_InstanceID) % 8, gl_InstanceID % 4) + 0.5;
    gl_Position = vec4(texel / vec2(8.0, 4.0) * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
    value = float(gl_InstanceID + 1);
})",
                             kFragment, "points");
    }

    Floats added(const Program& program, const InstanceRange& range) {
        Texture sum = texture(kWidth, kHeight, TextureFormat::r32f);
        sum.clear(0.0F);
        const Target target = {.texture = &sum};
        draw_instances(context(), program, {&target, 1}, {}, range, Blend::add);
        return sum.read_floats();
    }

    static Floats expected_quads(int count) {
        Floats sum(kWidth * kHeight);
        for (int i = 0; i < count; ++i) {
            for (int x = i; x < std::min(i + 2, kWidth); ++x)
                sum[std::size_t(i % 3 * kWidth + x)] += float(i + 1);
        }
        return sum;
    }
    static Floats expected_points(int count) {
        Floats sum(kWidth * kHeight);
        for (int i = 0; i < count; ++i) sum[std::size_t(i % 4 * kWidth + 5 * i % 8)] += float(i + 1);
        return sum;
    }

    Buffer words(const std::vector<std::uint32_t>& values) {
        Buffer buffer(context(), values.size() * 4, "words");
        buffer.write(std::as_bytes(std::span(values)));
        return buffer;
    }

private:
    static constexpr const char* kFragment = R"(#version 450 core
flat in float value;
layout(location = 0) out float c;
void main() { c = value; })";
};
ON_EACH_BACKEND(InstancesOn);

TEST_P(InstancesOn, DrawsAStripOfFourVerticesForEachQuad) {
    const Program program = quads();
    for (const int count : {0, 1, 7}) {
        EXPECT_EQ(added(program, {.primitive = Primitive::quads, .count = count}), expected_quads(count));
    }
}

TEST_P(InstancesOn, DrawsOneTexelForEachPoint) {
    const Program program = points();
    for (const int count : {1, 13}) {
        EXPECT_EQ(added(program, {.primitive = Primitive::points, .count = count}), expected_points(count));
    }
}

TEST_P(InstancesOn, TakesTheirNumberFromABuffer) {
    const Buffer five_quads = words({4, 5, 0, 0});
    EXPECT_EQ(added(quads(), {.primitive = Primitive::quads, .indirect = &five_quads}), expected_quads(5));
    const Buffer nine_points = words({1, 9, 0, 0});
    EXPECT_EQ(added(points(), {.primitive = Primitive::points, .indirect = &nine_points}),
              expected_points(9));
}

TEST_P(InstancesOn, TakesTheNumberThatAComputePassWroteJustBefore) {
    const Buffer command(context(), 16, "command");
    const Program program = Program::compute(context(), R"(#version 450 core
layout(local_size_x = 6) in;
layout(std430, binding = 0) buffer Command { uint vertices; uint instances; uint first; uint base; };
void main() {
    atomicMax(vertices, 4u);
    atomicAdd(instances, 1u);
}
)",
                                             "count");
    const BufferBinding storage[] = {{&command, 0}};
    dispatch(context(), program, 1, 1, 1, {.storage = storage});
    EXPECT_EQ(added(quads(), {.primitive = Primitive::quads, .indirect = &command}), expected_quads(6));
}

Program counts_in_groups_of_5(Context& context) {
    return Program::compute(context, R"(#version 450 core
layout(local_size_x = 5) in;
layout(std430, binding = 0) buffer Counter { uint total; };
void main() { atomicAdd(total, 1u); }
)",
                            "count");
}

TEST_P(InstancesOn, DispatchesTheGroupsThatABufferSays) {
    const Buffer groups = words({3, 2, 4});
    const Buffer counter(context(), 4, "counter");
    const Program program = counts_in_groups_of_5(context());
    const BufferBinding storage[] = {{&counter, 0}};
    dispatch_indirect(context(), program, groups, {.storage = storage});
    EXPECT_EQ(counter.read(), words({3 * 2 * 4 * 5}).read());
}

TEST_P(InstancesOn, WithNothingToDoNoCommandWritesAnything) {
    const Program strips = quads();
    const Program full = fragment("layout(location = 0) out float c; void main() { c = 9.0; }");
    const Buffer counter = words({7}), three = words({3, 1, 1}), five_quads = words({4, 5, 0, 0});
    const Program counts = counts_in_groups_of_5(context());
    Texture target = texture(kWidth, kHeight, TextureFormat::r32f);
    target.clear(2.0F);
    const Target targets[] = {{.texture = &target}};
    const BufferBinding storage[] = {{&counter, 0}};
    const auto run_all = [&] {
        draw(context(), full, targets, {});
        draw_instances(context(), strips, targets, {}, {.count = 3});
        draw_instances(context(), strips, targets, {}, {.indirect = &five_quads});
        dispatch(context(), counts, 2, 1, 1, {.storage = storage});
        dispatch_indirect(context(), counts, three, {.storage = storage});
    };
    {
        const NothingToDo scope(context());
        run_all();
    }
    EXPECT_EQ(target.read_floats(), Floats(kWidth * kHeight, 2.0F));
    EXPECT_EQ(counter.read(), words({7}).read());
    run_all();
    EXPECT_NE(target.read_floats(), Floats(kWidth * kHeight, 2.0F));
    EXPECT_EQ(counter.read(), words({7 + 5 * 5}).read());
}

TEST_P(InstancesOn, RefusesABufferTooShortForItsCommand) {
    const Buffer words_two = words({1, 1});
    EXPECT_EQ(error_of([&] { added(quads(), {.indirect = &words_two}); }),
              "quads: the buffer that says how many has 8 bytes; the command takes 16");
    const Program program = Program::compute(
        context(), "#version 450 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n", "computes");
    EXPECT_EQ(error_of([&] { dispatch_indirect(context(), program, words_two, {}); }),
              "computes: the buffer that says how many has 8 bytes; the command takes 12");
}

}  // namespace
}  // namespace aftershade::gpu
