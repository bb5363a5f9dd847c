// What survives into the next frame.
#include "tests/graph/executor_test.h"

namespace aftershade::graph {
namespace {

class HistoryOn : public GraphOn {
protected:
    /// accum = 0.75 * accum.prev + 0.25 * input, and out = accum.prev.
    struct Accumulation {
        TextureHandle input, accum, out;
        std::unique_ptr<Executor> executor;

        Floats run(const Floats& values) {
            executor->texture(input)->upload(values);
            executor->run(false);
            return executor->texture(accum)->read_floats();
        }
    };

    Accumulation accumulation(const gpu::TextureDesc& desc = kSmall, const std::string& name = "accum") {
        if (!mix_)
            mix_.emplace(
                draws("result = 0.75 * texelFetch(other, p, 0).r + 0.25 * texelFetch(source, p, 0).r;"));
        if (!copy_) copy_.emplace(draws("result = texelFetch(source, p, 0).r;"));
        Graph graph;
        Accumulation made;
        made.input = graph.import_texture("input", desc);
        const TextureHistory history = graph.create_history(name, desc);
        made.accum = graph.add_pass(draw_of("accum", *mix_, {made.input, history.previous}, history.current))
                         .targets[0];
        made.out =
            graph.add_pass(draw_of("out", *copy_, {history.previous}, graph.fresh("out", desc))).targets[0];
        graph.keep(made.accum);
        graph.keep(made.out);
        made.executor = std::make_unique<Executor>(context(), std::move(graph));
        return made;
    }

    static Floats mixed(const Floats& previous, const Floats& input) {
        Floats result(previous.size());
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = 0.75f * previous[i] + 0.25f * input[i];
        return result;
    }

    const Floats zero_ = Floats(kWidth * kHeight);

private:
    std::optional<gpu::Program> mix_, copy_;

    void TearDown() override {
        mix_.reset();  // before the context
        copy_.reset();
    }
};
ON_EACH_BACKEND(HistoryOn);

TEST_P(HistoryOn, FollowsARecurrenceOverFiveFrames) {
    Accumulation taa = accumulation();
    Floats expected = zero_;
    for (int frame = 1; frame <= 5; ++frame) {
        const Floats before = expected;
        expected = mixed(expected, ramp(float(frame * 8)));
        // What is kept is this frame's, though the next frame reads it as the one before.
        EXPECT_EQ(taa.run(ramp(float(frame * 8))), expected) << frame;
        EXPECT_EQ(taa.executor->texture(taa.out)->read_floats(), before) << frame;
        EXPECT_EQ(taa.executor->history().textures.at("accum")->read_floats(), expected) << frame;
    }
}

TEST_P(HistoryOn, BeginsAgainFromZeroWhereItIsCleared) {
    Accumulation taa = accumulation();
    EXPECT_EQ(taa.executor->history().textures.at("accum")->read_floats(), zero_);
    for (int i = 0; i < 3; ++i) taa.run(ramp(16));
    taa.executor->clear_history();
    EXPECT_EQ(taa.executor->history().textures.at("accum")->read_floats(), zero_);
    EXPECT_EQ(taa.run(ramp(4)), mixed(zero_, ramp(4)));
    EXPECT_EQ(taa.run(ramp(4)), mixed(mixed(zero_, ramp(4)), ramp(4)));
}

TEST_P(HistoryOn, GoesOverToAGraphThatWasBuiltAnew) {
    Accumulation before = accumulation();
    Accumulation after = accumulation();
    const Floats first = before.run(ramp(4)), second = before.run(ramp(12));
    EXPECT_EQ(after.executor->take_history_from(*before.executor), Names{});
    EXPECT_EQ(after.executor->history().textures.at("accum")->read_floats(), second);
    EXPECT_EQ(after.run(ramp(20)), mixed(second, ramp(20)));
    EXPECT_EQ(after.run(ramp(20)), mixed(mixed(second, ramp(20)), ramp(20)));
    // Back into one that has run itself: its own past is given away.
    EXPECT_EQ(before.executor->take_history_from(*after.executor), Names{});
    EXPECT_EQ(before.executor->history().textures.at("accum")->read_floats(),
              mixed(mixed(second, ramp(20)), ramp(20)));
}

TEST_P(HistoryOn, NamesWhatFoundNoHistoryOfItsNameAndDescription) {
    Accumulation before = accumulation();
    before.run(ramp(4));
    gpu::TextureDesc wider = kSmall;
    ++wider.width;
    Accumulation other_size = accumulation(wider), other_name = accumulation(kSmall, "moments");
    EXPECT_EQ(other_size.executor->take_history_from(*before.executor), Names{"accum"});
    EXPECT_EQ(other_name.executor->take_history_from(*before.executor), Names{"moments"});
    EXPECT_EQ(other_name.executor->history().textures.at("moments")->read_floats(), zero_);
    EXPECT_EQ(before.executor->history().textures.at("accum")->read_floats(), ramp(1));
}

TEST_P(HistoryOn, StaysWhereNoPassWritesIt) {
    const gpu::Program copy = draws("result = texelFetch(source, p, 0).r + 1.0;");
    Graph graph;
    const TextureHistory history = graph.create_history("accum", kSmall);
    const TextureHandle out =
        graph.add_pass(draw_of("out", copy, {history.previous}, graph.fresh("out", kSmall))).targets[0];
    graph.keep(out);
    Executor reading(context(), std::move(graph));
    Accumulation writing = accumulation();
    const Floats left = writing.run(ramp(8));
    EXPECT_EQ(reading.take_history_from(*writing.executor), Names{});
    for (int frame = 0; frame < 3; ++frame) {
        reading.run(false);
        Floats expected = left;
        for (float& value : expected) value += 1;
        EXPECT_EQ(reading.texture(out)->read_floats(), expected) << frame;
    }
    EXPECT_EQ(reading.history().textures.at("accum")->read_floats(), left);
}

TEST_P(HistoryOn, CountsFramesInABuffer) {
    const gpu::Program count = computes(R"(layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Current { uint current[3]; };
layout(std430, binding = 1) readonly buffer Previous { uint previous[3]; };)",
                                        R"(    current[0] += previous[0] + 1u;
    current[1] += 10u;
    current[2] += previous[1];)");
    Graph graph;
    const BufferHistory history =
        graph.create_history_buffer("frames", {12}, std::vector<std::uint32_t>{100, 5});
    Pass pass = with(pass_named("count", PassKind::compute), count);
    pass.buffers = {{history.current, 0, gpu::Access::read_write}, {history.previous, 1, gpu::Access::read}};
    const BufferHandle current = graph.add_pass(pass).buffers[0];
    graph.keep(current);
    Executor executor(context(), std::move(graph));
    std::uint32_t first = 0, second = 0;
    for (int frame = 0; frame < 5; ++frame) {
        if (frame == 3) {
            executor.clear_history();
            first = second = 0;
        }
        executor.run(false);
        const std::vector<std::uint32_t> expected = {100 + first + 1, 15, second};
        EXPECT_EQ(words_of(*executor.buffer(current)), expected) << frame;
        EXPECT_EQ(words_of(*executor.history().buffers.at("frames")), expected) << frame;
        first = expected[0];
        second = expected[1];
    }
}

/// Four frames of a graph with history, shared memory, blending and levels; the bits of all it keeps.
Floats picture(gpu::Backend backend) {
    gpu::Context context(backend);
    const gpu::Program mix = gpu::Program::draw(context, gpu::kFullScreen, R"(#version 450 core
layout(binding = 0) uniform sampler2D previous;
layout(binding = 1) uniform sampler2D source;
layout(location = 0) out vec4 c;
void main() {
    vec2 p = gl_FragCoord.xy / 48.0;
    c = 0.9 * textureLod(previous, p * 0.97 + 0.01, 0.0) + 0.1 * textureLod(source, p, 1.5) + exp(-p.x) * 0.01;
})",
                                                "mix");
    const gpu::Program draw = gpu::Program::draw(context, gpu::kFullScreen, R"(#version 450 core
layout(location = 0) out vec4 c;
void main() { c = vec4(sin(gl_FragCoord.x), cos(gl_FragCoord.y), pow(gl_FragCoord.x, 0.3), 1.0) / 3.0; })",
                                                 "draw");
    Graph graph;
    const gpu::TextureDesc desc{.width = 48, .height = 48, .format = gpu::TextureFormat::rgba16f};
    gpu::TextureDesc pyramid = desc;
    pyramid.mips = 4;
    TextureOptions options;
    options.auto_mips = true;
    options.clear = {0.5, 0.25, 0, 1};
    Pass drawing = pass_named("draw", PassKind::draw);
    drawing.program = kept_by_caller(draw);
    drawing.blend = gpu::Blend::add;
    drawing.targets = {{graph.create_texture("pyramid", pyramid, options)}};
    const TextureHandle source = graph.add_pass(drawing).targets[0];
    const TextureHistory history = graph.create_history("accum", desc);
    Pass mixing = pass_named("mix", PassKind::draw);
    mixing.program = kept_by_caller(mix);
    mixing.reads = {{history.previous, 0, gpu::Filter::linear}, {source, 1, gpu::Filter::linear}};
    mixing.targets = {{history.current}};
    const TextureHandle out = graph.add_pass(mixing).targets[0];
    graph.keep(out);
    Executor executor(context, std::move(graph));
    for (int frame = 0; frame < 4; ++frame) executor.run(false);
    return executor.texture(out)->read_floats();
}

TEST(Executor, GivesTheSameBitsOnOsmesaAndOnEachBackendEgl) {
    for (const gpu::Backend backend : {gpu::Backend::egl_software, gpu::Backend::osmesa})
        if (const std::string reason = gpu::why_not(backend); !reason.empty()) GTEST_SKIP() << reason;
    const Floats egl = picture(gpu::Backend::egl_software), osmesa = picture(gpu::Backend::osmesa);
    ASSERT_EQ(egl.size(), 48u * 48 * 4);
    EXPECT_EQ(std::memcmp(egl.data(), osmesa.data(), egl.size() * sizeof(float)), 0);
    EXPECT_NE(egl.front(), egl.back());
}

}  // namespace
}  // namespace aftershade::graph
