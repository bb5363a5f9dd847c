// Which passes of a graph run.
#include "tests/graph/graph_test.h"

namespace aftershade::graph {
namespace {

TEST(Culling, WithoutAKeptTextureRunsNothing) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle a = graph.draw("a", {color}, graph.fresh("a"));
    const CompiledGraph compiled = graph.compile();
    EXPECT_TRUE(compiled.passes.empty());
    EXPECT_TRUE(compiled.slots.empty());
    EXPECT_EQ(slot(compiled, color), -1);
    EXPECT_EQ(slot(compiled, a), -1);
    EXPECT_EQ(compiled.bytes, 0u);
}

// color -> a -> out (kept)
//        \> b -> c
TEST(Culling, DropsABranchThatNothingKeptDependsOn) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle a = graph.draw("a", {color}, graph.fresh("a"));
    const TextureHandle b = graph.draw("b", {a}, graph.fresh("b"));
    const TextureHandle c = graph.draw("c", {b}, graph.fresh("c"));
    graph.keep(graph.draw("out", {a}, graph.fresh("out")));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.passes, (std::vector<int>{0, 3}));
    EXPECT_EQ(slot(compiled, b), -1);
    EXPECT_EQ(slot(compiled, c), -1);
}

TEST(Culling, GivesNoMemoryToAnImportThatOnlyCulledPassesRead) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle depth = graph.import_texture("depth", kOneChannel);
    (void)graph.draw("unused", {depth}, graph.fresh("unused"));
    graph.keep(graph.draw("out", {color}, graph.fresh("out")));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(slot(compiled, depth), -1);
    EXPECT_EQ(compiled.bytes, 2 * kFullBytes);
}

TEST(Culling, LeavesPassesInTheOrderTheyWereAdded) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle a = graph.draw("a", {color}, graph.fresh("a"));
    const TextureHandle b = graph.draw("b", {color}, graph.fresh("b"));
    graph.keep(graph.draw("c", {b, a}, graph.fresh("c")));
    EXPECT_EQ(graph.running(), (Names{"a", "b", "c"}));
}

TEST(Culling, KeepsAPassForItsSecondTargetAndGivesTheFirstOneMemoryToo) {
    Graph graph;
    const auto both = graph.draws("both", {}, {graph.fresh("a"), graph.fresh("b")});
    graph.keep(both[1]);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.passes.size(), 1u);
    EXPECT_GE(slot(compiled, both[0]), 0);
    EXPECT_NE(slot(compiled, both[0]), slot(compiled, both[1]));
}

TEST(Culling, DropsAWriteThatAWholeDrawReplacesUnread) {
    Graph graph;
    TextureHandle a = graph.draw("unread", {}, graph.fresh("a"));
    a = graph.draw("whole", {}, a);
    graph.keep(a);
    EXPECT_EQ(graph.running(), (Names{"whole"}));
}

TEST(Culling, KeepsAWriteThatWasReadBeforeItWasReplaced) {
    Graph graph;
    TextureHandle a = graph.draw("first", {}, graph.fresh("a"));
    const TextureHandle b = graph.draw("reader", {a}, graph.fresh("b"));
    a = graph.draw("second", {b}, a);
    graph.keep(a);
    EXPECT_EQ(graph.running(), (Names{"first", "reader", "second"}));
}

TEST(Culling, KeepsWhatAPartialWriteLeavesStanding) {
    const auto running = [](auto second, const gpu::TextureDesc& desc = kFull) {
        Graph graph;
        graph.keep(second(graph, graph.clear("first", {graph.fresh("a", desc), std::nullopt, std::nullopt})));
        return graph.running();
    };
    const Names both = {"first", "second"}, second_only = {"second"};
    EXPECT_EQ(running([](Graph& g, TextureHandle a) { return g.blend("second", {}, a); }), both);
    EXPECT_EQ(running([](Graph& g, TextureHandle a) { return g.store("second", {}, a); }), both);
    EXPECT_EQ(running([](Graph& g, TextureHandle a) {
                  Pass pass = pass_named("second", PassKind::instances);
                  pass.targets = {{a}};
                  return g.add_pass(pass).targets[0];
              }),
              both);
    const auto draw = [](Graph& g, TextureHandle a) { return g.draw("second", {}, a); };
    EXPECT_EQ(running(draw, kPyramid), both);  // one level of three
    EXPECT_EQ(running(draw, kArray), both);    // one layer of two
    EXPECT_EQ(running(draw, kFull), second_only);
    EXPECT_EQ(running(
                  [](Graph& g, TextureHandle a) {
                      return g.clear("second", {a, 1, 0});
                  },
                  kPyramid),
              both);
    EXPECT_EQ(running(
                  [](Graph& g, TextureHandle a) {
                      return g.clear("second", {a, std::nullopt, std::nullopt});
                  },
                  kPyramid),
              second_only);
}

TEST(Culling, FollowsBuffersAndCountsThatComeFromThem) {
    Graph graph;
    const BufferHandle table = graph.import_buffer("table", {64});
    const BufferHandle count = graph.compute(
        "count", {table}, graph.create_buffer("count", {16}, {{4, 0, 0, 0}}), gpu::Access::read_write);
    const BufferHandle unused = graph.compute("unused", {table}, graph.create_buffer("unused", {16}));
    Pass splats = pass_named("splats", PassKind::instances);
    splats.targets = {{graph.cleared("sum")}};
    splats.instances.indirect = count;
    graph.keep(graph.add_pass(splats).targets[0]);
    EXPECT_EQ(graph.running(), (Names{"count", "splats"}));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(slot(compiled, unused), -1);
    EXPECT_EQ(compiled.buffer_cleared_before[std::size_t(count.buffer)], 0);
    EXPECT_EQ(compiled.bytes, kFullBytes + 64 + 16);
}

TEST(Culling, ClearsBeforeTheFirstUseAndOnlyWhatIsSeen) {
    Graph graph;
    const TextureHandle input = graph.import_texture("input", kFull);
    const TextureHandle sum = graph.cleared("sum"), replaced = graph.cleared("replaced"),
                        untouched = graph.cleared("untouched"), culled = graph.cleared("culled");
    const TextureHandle a = graph.draw("a", {input}, replaced);
    const TextureHandle b = graph.blend("b", {a}, sum);
    (void)graph.blend("c", {}, culled);
    graph.keep(graph.blend("d", {}, b));
    graph.keep(untouched);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(graph.running(), (Names{"a", "b", "d"}));
    const auto& cleared = compiled.texture_cleared_before;
    EXPECT_EQ(cleared[std::size_t(input.texture)], -1);
    EXPECT_EQ(cleared[std::size_t(sum.texture)], 1);
    EXPECT_EQ(cleared[std::size_t(replaced.texture)], -1);
    EXPECT_EQ(cleared[std::size_t(untouched.texture)], 3);
    EXPECT_EQ(cleared[std::size_t(culled.texture)], -1);
}

//  accum.prev -> blur -> out (kept)      accum is written for the next frame's accum.prev,
//  moments.prev -> accum                 whose pass reads moments.prev, so moments is written too
TEST(Culling, FollowsHistoriesThroughTheFramesBefore) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHistory accum = graph.create_history("accum", kFull);
    const TextureHistory moments = graph.create_history("moments", kFull);
    const TextureHistory idle = graph.create_history("idle", kFull);
    (void)graph.draw("idle", {color, idle.previous}, idle.current);
    (void)graph.draw("moments", {color}, moments.current);
    (void)graph.draw("accum", {color, moments.previous}, accum.current);
    const TextureHandle out = graph.draw("out", {accum.previous}, graph.fresh("out"));
    EXPECT_TRUE(graph.running().empty());
    graph.keep(out);
    EXPECT_EQ(graph.running(), (Names{"moments", "accum", "out"}));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(slot(compiled, idle.current), -1);
    EXPECT_EQ(slot(compiled, idle.previous), -1);
    EXPECT_NE(slot(compiled, accum.current), slot(compiled, accum.previous));
}

TEST(Culling, WritesAHistoryThatIsReadWithoutItsPastOnce) {
    Graph graph;
    const TextureHistory history = graph.create_history("accum", kFull);
    const TextureHandle current = graph.draw("accum", {}, history.current);
    graph.keep(graph.draw("out", {current}, graph.fresh("out")));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(slot(compiled, history.previous), -1);
    EXPECT_EQ(compiled.bytes, 2 * kFullBytes);
    EXPECT_EQ(fault_of([&] {
                  (void)graph.draw("early", {graph.create_history("b", kFull).current}, graph.fresh("c"));
              }),
              "pass 'early' reads 'b' before any write");
}

TEST(Culling, KeepsTheLastOfSeveralWritesToAHistory) {
    Graph graph;
    const TextureHistory history = graph.create_history("accum", kFull);
    TextureHandle current = graph.draw("first", {}, history.current);
    current = graph.draw("second", {}, current);
    (void)graph.blend("third", {}, current);
    graph.keep(graph.draw("out", {history.previous}, graph.fresh("out")));
    EXPECT_EQ(graph.running(), (Names{"second", "third", "out"}));
}

TEST(Culling, FollowsHistoriesOfBuffers) {
    Graph graph;
    const BufferHistory history = graph.create_history_buffer("exposure", {16});
    const BufferHandle current = graph.compute("expose", {history.previous}, history.current);
    EXPECT_TRUE(graph.running().empty());
    graph.keep(current);
    EXPECT_EQ(graph.running(), (Names{"expose"}));
    const CompiledGraph compiled = graph.compile();
    EXPECT_NE(slot(compiled, history.current), slot(compiled, history.previous));
    EXPECT_EQ(compiled.buffer_slots.size(), 2u);
}

}  // namespace
}  // namespace aftershade::graph
