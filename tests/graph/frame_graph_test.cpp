// What a graph refuses to take.
#include "framework/graph/frame_graph.h"

#include "tests/graph/graph_test.h"

namespace aftershade::graph {
namespace {

TEST(FrameGraph, RefusesAHandleThatALaterWriteMadeStale) {
    Graph graph;
    const TextureHandle first = graph.draw("first", {}, graph.fresh("a"));
    const TextureHandle second = graph.draw("second", {}, first);
    EXPECT_EQ(second.texture, first.texture);
    EXPECT_EQ(second.version, first.version + 1);
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {first}, graph.fresh("b")); }),
              "pass 'reader' uses version 1 of 'a', which has been written since and is now version 2");
    EXPECT_NE(fault_of([&] { (void)graph.draw("writer", {}, first); }), "");
    EXPECT_NE(fault_of([&] { (void)graph.store("writer", {}, first); }), "");
    EXPECT_NE(fault_of([&] { graph.keep(first); }), "");
    EXPECT_EQ(fault_of([&] { graph.keep(second); }), "");

    const BufferHandle counts = graph.compute("counts", {}, graph.create_buffer("counts", {16}));
    (void)graph.compute("recount", {}, counts);
    EXPECT_EQ(fault_of([&] { (void)graph.compute("use", {counts}, graph.create_buffer("b", {4})); }),
              "pass 'use' uses version 1 of 'counts', which has been written since and is now version 2");
    EXPECT_NE(fault_of([&] { graph.keep(counts); }), "");
}

TEST(FrameGraph, StaysAsItWasWhenItRefusesAPass) {
    Graph graph;
    const TextureHandle a = graph.fresh("a");
    const TextureHandle empty = graph.fresh("empty");
    EXPECT_NE(fault_of([&] { (void)graph.draw("reader", {empty}, a); }), "");
    EXPECT_EQ(graph.pass_count(), 0);
    EXPECT_EQ(fault_of([&] { (void)graph.draw("writer", {}, a); }), "");
}

TEST(FrameGraph, RefusesAReadBeforeAnyWrite) {
    Graph graph;
    const TextureHandle empty = graph.fresh("empty"), out = graph.fresh("out");
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {empty}, out); }),
              "pass 'reader' reads 'empty' before any write");
    EXPECT_EQ(fault_of([&] { (void)graph.store("atomics", {}, empty, gpu::Access::read_write); }),
              "pass 'atomics' reads 'empty' before any write");
    const BufferHandle counts = graph.create_buffer("counts", {4});
    EXPECT_EQ(fault_of([&] { (void)graph.compute("counter", {}, counts, gpu::Access::read_write); }),
              "pass 'counter' reads 'counts' before any write");
    EXPECT_EQ(fault_of([&] { graph.keep(empty); }),
              "keep() of 'empty', of which nothing writes level 0, layer 0");
    EXPECT_EQ(fault_of([&] { graph.keep(counts); }), "keep() of 'counts', which nothing writes");
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {graph.cleared("zero")}, out); }), "");
}

TEST(FrameGraph, RefusesToReadALevelOrALayerThatNothingWrote) {
    Graph graph;
    const TextureHandle base = graph.draw_at("base", {}, {graph.fresh("pyramid", kPyramid), 0, 0});
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {base}, graph.fresh("b")); }),
              "pass 'reader' reads 'pyramid' before any write to its level 1, layer 0");
    Pass fine = pass_named("fine", PassKind::draw);
    fine.reads = {{.texture = base, .level = 0}};
    fine.targets = {{graph.fresh("c")}};
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(fine); }), "");
    const TextureHandle array = graph.draw_at("left", {}, {graph.fresh("array", kArray), 0, 0});
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {array}, graph.fresh("d")); }),
              "pass 'reader' reads 'array' before any write to its level 0, layer 1");
    const TextureHandle both = graph.draw_at("right", {}, {array, 0, 1});
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {both}, graph.fresh("e")); }), "");
}

TEST(FrameGraph, RefusesToBlendOrToDrawInstancesOntoNothing) {
    Graph graph;
    EXPECT_EQ(fault_of([&] { (void)graph.blend("sum", {}, graph.fresh("sum")); }),
              "pass 'sum' blends onto 'sum' before any write");
    Pass splats = pass_named("splats", PassKind::instances);
    splats.targets = {{graph.fresh("splats")}};
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(splats); }),
              "pass 'splats' draws over parts of 'splats' before any write");
    splats.targets = {{graph.create_texture("partial", kFull, {.partial = true})}};
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(splats); }), "");
    EXPECT_EQ(fault_of([&] { (void)graph.blend("sum", {}, graph.cleared("sum")); }), "");
    const TextureHandle zero = graph.clear("zero", {graph.fresh("by_pass")});
    EXPECT_EQ(fault_of([&] { (void)graph.blend("sum", {}, zero); }), "");
    EXPECT_EQ(fault_of([&] { (void)graph.blend("ids", {}, graph.cleared("ids", kIds)); }),
              "pass 'ids' blends onto 'ids', which holds integers");
}

//   +-> a --+
//   +-------+   a pass that samples its own target
TEST(FrameGraph, RefusesFeedback) {
    Graph graph;
    const TextureHandle a = graph.draw("a", {}, graph.fresh("a"));
    EXPECT_EQ(fault_of([&] { (void)graph.draw("loop", {a}, a); }), "pass 'loop' reads and writes 'a'");
    EXPECT_EQ(fault_of([&] { (void)graph.store("loop", {a}, a); }), "pass 'loop' reads and writes 'a'");
    EXPECT_EQ(fault_of([&] {
                  Pass both = pass_named("both", PassKind::compute, {a});
                  both.images = {{a, 0, gpu::Access::read, 0}, {graph.fresh("b"), 1, gpu::Access::write, 0}};
                  (void)graph.add_pass(both);
              }),
              "pass 'both' uses 'a' as an image and through a sampler");
    EXPECT_EQ(fault_of([&] {
                  Pass both = pass_named("both", PassKind::draw);
                  both.targets = {{a}};
                  both.images = {{a, 0, gpu::Access::read, 0}};
                  (void)graph.add_pass(both);
              }),
              "pass 'both' draws to 'a' and uses it as an image");
    EXPECT_EQ(fault_of([&] {
                  Pass both = pass_named("both", PassKind::compute);
                  both.images = {{a, 0, gpu::Access::read, 0}, {a, 1, gpu::Access::write, 0}};
                  (void)graph.add_pass(both);
              }),
              "pass 'both' uses 'a' as two images and writes one of them");
}

TEST(FrameGraph, TakesAReadOfOneLevelBesideAWriteOfAnother) {
    Graph graph;
    TextureHandle pyramid = graph.draw_at("base", {}, {graph.fresh("pyramid", kPyramid), 0, 0});
    for (int level = 1; level < 3; ++level) {
        Pass down = pass_named("down", PassKind::draw);
        down.reads = {{.texture = pyramid, .level = level - 1}};
        down.targets = {{pyramid, level, 0}};
        const TextureHandle before = pyramid;
        ASSERT_EQ(fault_of([&] { pyramid = graph.add_pass(down).targets[0]; }), "");
        EXPECT_EQ(pyramid.version, before.version + 1);
        down.reads[0] = {.texture = pyramid, .level = level};
        down.targets[0].texture = pyramid;
        EXPECT_EQ(fault_of([&] { (void)graph.add_pass(down); }), "pass 'down' reads and writes 'pyramid'");
    }
    Pass stored = pass_named("stored", PassKind::compute);
    stored.images = {{pyramid, 0, gpu::Access::read, 0}, {pyramid, 1, gpu::Access::write, 1}};
    const Written written = graph.add_pass(stored);
    EXPECT_EQ(written.images[0], written.images[1]);
    EXPECT_EQ(fault_of([&] { graph.keep(written.images[0]); }), "");
}

TEST(FrameGraph, GivesOneNewVersionToTwoLayersOfOnePass) {
    Graph graph;
    const TextureHandle array = graph.fresh("array", kArray);
    Pass both = pass_named("both", PassKind::draw);
    both.targets = {{array, 0, 0}, {array, 0, 1}};
    const Written written = graph.add_pass(both);
    EXPECT_EQ(written.targets[0], (TextureHandle{array.texture, 1}));
    EXPECT_EQ(written.targets[1], written.targets[0]);
    EXPECT_EQ(fault_of([&] { graph.keep(written.targets[0]); }), "");
}

TEST(FrameGraph, RefusesTargetsOfTwoSizes) {
    Graph graph;
    const TextureHandle full = graph.fresh("full"), half = graph.fresh("half", kHalf);
    EXPECT_EQ(fault_of([&] {
                  (void)graph.draws("both", {}, {full, half});
              }),
              "pass 'both' writes targets of two sizes: 'full' is 64x36, 'half' is 32x18");
    Pass fits = pass_named("fits", PassKind::draw);
    fits.targets = {{graph.fresh("pyramid", kPyramid), 1, 0}, {half}};
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(fits); }), "");
}

TEST(FrameGraph, TakesTargetsOfTwoFormats) {
    Graph graph;
    EXPECT_EQ(graph.draws("both", {}, {graph.fresh("a"), graph.fresh("b", kOneChannel)}).size(), 2u);
}

TEST(FrameGraph, RefusesAPassThatWritesNothingOrOneTextureTwice) {
    Graph graph;
    EXPECT_EQ(fault_of([&] { (void)graph.draws("idle", {}, {}); }), "pass 'idle' writes nothing");
    const TextureHandle a = graph.fresh("a");
    EXPECT_EQ(fault_of([&] {
                  (void)graph.draws("twice", {}, {a, a});
              }),
              "pass 'twice' has 'a' as a target twice");
}

TEST(FrameGraph, RefusesAPassWhoseKindAndPartsDoNotAgree) {
    Graph graph;
    const TextureHandle a = graph.draw("a", {}, graph.fresh("a"));
    const BufferHandle table = graph.import_buffer("table", {8});
    const auto fault = [&](PassKind kind, auto change) {
        Pass pass = pass_named("odd", kind);
        if (kind == PassKind::compute) {
            pass.images = {{a, 0, gpu::Access::write, 0}};
        } else {
            pass.targets = {{a}};
        }
        change(pass);
        return fault_of([&] { (void)graph.add_pass(pass); });
    };
    EXPECT_EQ(fault(PassKind::compute, [&](Pass& p) { p.targets = {{a}}; }),
              "pass 'odd' computes, but has 1 targets; it can write images and buffers");
    EXPECT_EQ(fault(PassKind::draw,
                    [&](Pass& p) {
                        p.targets.clear();
                        p.images = {{a, 0, gpu::Access::write, 0}};
                    }),
              "pass 'odd' draws, but has no target");
    EXPECT_EQ(fault(PassKind::clear, [&](Pass& p) { p.reads = {{graph.import_texture("b", kFull)}}; }),
              "pass 'odd' clears, but has more than targets; it runs no program and reads nothing");
    EXPECT_EQ(fault(PassKind::copy, [](Pass&) {}),
              "pass 'odd' copies, but has more or less than one read and one target");
    EXPECT_EQ(fault(PassKind::copy, [&](Pass& p) { p.reads = {{graph.import_texture("small", kHalf)}}; }),
              "pass 'odd' copies 'small' to 'a', which differ in size, format, levels or layers");
    EXPECT_EQ(fault(PassKind::compute, [](Pass& p) { p.blend = gpu::Blend::max; }),
              "pass 'odd' blends, but draws nothing");
    EXPECT_EQ(fault(PassKind::draw, [](Pass& p) { p.instances.count = 3; }),
              "pass 'odd' has a number of instances, but does not draw instances");
    EXPECT_EQ(fault(PassKind::compute,
                    [](Pass& p) {
                        p.groups.count = {4, 0, 1};
                    }),
              "pass 'odd' dispatches 0 groups along one axis; at least 1");
    EXPECT_EQ(fault(PassKind::instances, [&](Pass& p) { p.instances.indirect = table; }),
              "pass 'odd' takes its count from 'table' of 8 bytes; the command takes 16");
    EXPECT_EQ(fault(PassKind::draw,
                    [&](Pass& p) {
                        p.targets = {{a, std::nullopt, 0}};
                    }),
              "pass 'odd' draws to every level or layer of 'a' at once");
    EXPECT_EQ(fault(PassKind::draw,
                    [&](Pass& p) {
                        p.targets = {{a, 1, 0}};
                    }),
              "pass 'odd' uses level 1 of 'a', which has 1");
    EXPECT_EQ(fault(PassKind::draw,
                    [&](Pass& p) {
                        p.targets = {{a, 0, 2}};
                    }),
              "pass 'odd' uses layer 2 of 'a', which has 1");
    EXPECT_EQ(fault(PassKind::draw,
                    [](Pass& p) {
                        p.uniforms = {{1, std::vector<std::byte>(16)}, {1, std::vector<std::byte>(16)}};
                    }),
              "pass 'odd' has two uniform blocks at binding 1");
    EXPECT_EQ(fault(PassKind::draw, [](Pass&) {}), "");
}

TEST(FrameGraph, RefusesToFilterIntegers) {
    Graph graph;
    Pass pass = pass_named("smooth", PassKind::draw);
    pass.reads = {{.texture = graph.import_texture("ids", kIds), .filter = gpu::Filter::linear}};
    pass.targets = {{graph.fresh("out")}};
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(pass); }),
              "pass 'smooth' reads 'ids' with a linear filter, but it holds integers");
}

TEST(FrameGraph, RefusesToWriteWhatIsImportedOrKeptOrOfTheFrameBefore) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    EXPECT_EQ(fault_of([&] { (void)graph.draw("over", {}, color); }),
              "pass 'over' writes 'color', which is imported");
    EXPECT_EQ(fault_of([&] { (void)graph.store("over", {}, color); }),
              "pass 'over' writes 'color', which is imported");
    const TextureHandle out = graph.draw("out", {color}, graph.fresh("out"));
    graph.keep(out);
    EXPECT_EQ(fault_of([&] { (void)graph.draw("over", {}, out); }),
              "pass 'over' writes 'out', which is kept as it was");
    const TextureHistory history = graph.create_history("accum", kFull);
    EXPECT_EQ(fault_of([&] { (void)graph.clear("over", {history.previous}); }),
              "pass 'over' writes 'accum.prev', which is what the frame before left");

    const BufferHandle table = graph.import_buffer("table", {16});
    EXPECT_EQ(fault_of([&] { (void)graph.compute("over", {}, table); }),
              "pass 'over' writes 'table', which is imported");
    const BufferHandle counts = graph.compute("counts", {}, graph.create_buffer("counts", {16}));
    graph.keep(counts);
    EXPECT_NE(fault_of([&] { (void)graph.compute("over", {}, counts); }), "");
    EXPECT_NE(
        fault_of([&] { (void)graph.compute("over", {}, graph.create_history_buffer("h", {4}).previous); }),
        "");
}

TEST(FrameGraph, RefusesToReadABufferThatThePassWrites) {
    Graph graph;
    const BufferHandle counts = graph.compute("counts", {}, graph.create_buffer("counts", {16}));
    EXPECT_EQ(fault_of([&] { (void)graph.compute("loop", {counts}, counts); }),
              "pass 'loop' uses 'counts' twice and writes it");
    Pass pass = pass_named("loop", PassKind::compute);
    pass.buffers = {{counts, 0, gpu::Access::read_write}};
    pass.groups.indirect = counts;
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(pass); }), "pass 'loop' uses 'counts' twice and writes it");
}

TEST(FrameGraph, RefusesLevelsBesideThoseThatAreFilledByThemselves) {
    Graph graph;
    TextureOptions options;
    options.auto_mips = true;
    const TextureHandle pyramid = graph.create_texture("pyramid", kPyramid, options);
    EXPECT_EQ(fault_of([&] {
                  (void)graph.draw_at("down", {}, {pyramid, 1, 0});
              }),
              "pass 'down' writes level 1 of 'pyramid', whose levels are filled from level 0");
    const TextureHandle filled = graph.draw("base", {}, pyramid);
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {filled}, graph.fresh("b")); }), "");
    EXPECT_NE(fault_of([&] { (void)graph.create_texture("ids", kIds, options); }), "");
}

TEST(FrameGraph, RefusesBuffersThatHoldNothingOrLessThanTheirClear) {
    Graph graph;
    EXPECT_EQ(fault_of([&] { (void)graph.create_buffer("none", {0}); }), "buffer 'none' has 0 bytes");
    EXPECT_EQ(fault_of([&] {
                  (void)graph.create_buffer("b", {8}, std::vector<std::uint32_t>{1, 2, 3});
              }),
              "buffer 'b' of 8 bytes is cleared to 3 words");
    EXPECT_NE(fault_of([&] { (void)graph.create_texture("none", {.width = 0, .height = 4}); }), "");
}

TEST(FrameGraph, RefusesAHandleOfAnotherGraph) {
    Graph graph;
    EXPECT_EQ(fault_of([&] {
                  (void)graph.draw("reader", {TextureHandle{7, 1}}, graph.fresh("a"));
              }),
              "pass 'reader' uses a texture that the graph does not have");
    EXPECT_NE(fault_of([&] { (void)graph.draw("writer", {}, TextureHandle{}); }), "");
    EXPECT_EQ(fault_of([&] { (void)graph.compute("counter", {}, BufferHandle{}); }),
              "pass 'counter' uses a buffer that the graph does not have");
}

}  // namespace
}  // namespace aftershade::graph
