#include "framework/graph/frame_graph.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

namespace aftershade::graph {
namespace {

using gpu::TextureFormat;

const gpu::TextureDesc kFull{.width = 64, .height = 36, .format = TextureFormat::rgba32f};
const gpu::TextureDesc kHalf{.width = 32, .height = 18, .format = TextureFormat::rgba32f};
const gpu::TextureDesc kOneChannel{.width = 64, .height = 36, .format = TextureFormat::r32f};
constexpr std::uint64_t kFullBytes = 64 * 36 * 16;

/// Passes without programs: compiling a graph draws nothing.
struct Graph : FrameGraph {
    std::vector<TextureHandle> pass(const std::string& name, std::initializer_list<TextureHandle> reads,
                                    std::initializer_list<TextureHandle> targets) {
        Pass pass;
        pass.name = name;
        for (const TextureHandle handle : reads) pass.reads.push_back({handle, int(pass.reads.size())});
        return add_pass(std::move(pass), std::vector<TextureHandle>(targets));
    }
    TextureHandle draw(const std::string& name, std::initializer_list<TextureHandle> reads,
                       TextureHandle target) {
        return pass(name, reads, {target}).front();
    }
    TextureHandle fresh(const std::string& name, const gpu::TextureDesc& desc = kFull) {
        return create_texture(name, desc);
    }
};

template <typename Action>
std::string fault_of(Action action) {
    try {
        action();
    } catch (const GraphError& error) {
        return error.what();
    }
    return {};
}

int slot(const CompiledGraph& compiled, TextureHandle handle) {
    return compiled.slot_of_texture[std::size_t(handle.texture)];
}

TEST(FrameGraph, WithoutAKeptTextureRunsNothing) {
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
TEST(FrameGraph, CullsABranchThatNothingKeptDependsOn) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle a = graph.draw("a", {color}, graph.fresh("a"));
    const TextureHandle b = graph.draw("b", {a}, graph.fresh("b"));
    const TextureHandle c = graph.draw("c", {b}, graph.fresh("c"));
    const TextureHandle out = graph.draw("out", {a}, graph.fresh("out"));
    graph.keep(out);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.passes, (std::vector<int>{0, 3}));
    EXPECT_EQ(slot(compiled, b), -1);
    EXPECT_EQ(slot(compiled, c), -1);
}

TEST(FrameGraph, GivesNoMemoryToAnImportThatOnlyCulledPassesRead) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle depth = graph.import_texture("depth", kOneChannel);
    (void)graph.draw("unused", {depth}, graph.fresh("unused"));
    graph.keep(graph.draw("out", {color}, graph.fresh("out")));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(slot(compiled, depth), -1);
    EXPECT_EQ(compiled.bytes, 2 * kFullBytes);
}

TEST(FrameGraph, RunsPassesInTheOrderTheyWereAdded) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle a = graph.draw("a", {color}, graph.fresh("a"));
    const TextureHandle b = graph.draw("b", {color}, graph.fresh("b"));
    const TextureHandle c = graph.draw("c", {b, a}, graph.fresh("c"));
    graph.keep(c);
    EXPECT_EQ(graph.compile().passes, (std::vector<int>{0, 1, 2}));
}

TEST(FrameGraph, KeepsAPassForItsSecondTargetAndGivesTheFirstOneMemoryToo) {
    Graph graph;
    const auto both = graph.pass("both", {}, {graph.fresh("a"), graph.fresh("b")});
    graph.keep(both[1]);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.passes.size(), 1u);
    EXPECT_GE(slot(compiled, both[0]), 0);
    EXPECT_NE(slot(compiled, both[0]), slot(compiled, both[1]));
}

TEST(FrameGraph, RefusesAHandleThatALaterWriteMadeStale) {
    Graph graph;
    const TextureHandle first = graph.draw("first", {}, graph.fresh("a"));
    const TextureHandle second = graph.draw("second", {}, first);
    EXPECT_EQ(second.texture, first.texture);
    EXPECT_EQ(second.version, first.version + 1);
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {first}, graph.fresh("b")); }),
              "pass 'reader' uses version 1 of 'a', which has been written since and is now version 2");
    EXPECT_NE(fault_of([&] { (void)graph.draw("writer", {}, first); }), "");
    EXPECT_NE(fault_of([&] { graph.keep(first); }), "");
    EXPECT_EQ(fault_of([&] { graph.keep(second); }), "");
}

TEST(FrameGraph, RefusesAReadBeforeAnyWrite) {
    Graph graph;
    const TextureHandle empty = graph.fresh("empty");
    EXPECT_EQ(fault_of([&] { (void)graph.draw("reader", {empty}, graph.fresh("b")); }),
              "pass 'reader' reads 'empty' before any write");
    EXPECT_NE(fault_of([&] { graph.keep(empty); }), "");
}

//   +-> a --+
//   +-------+   a pass that samples its own target
TEST(FrameGraph, RefusesFeedback) {
    Graph graph;
    const TextureHandle a = graph.draw("a", {}, graph.fresh("a"));
    EXPECT_EQ(fault_of([&] { (void)graph.draw("loop", {a}, a); }), "pass 'loop' reads and writes 'a'");
}

TEST(FrameGraph, RefusesTargetsOfTwoSizes) {
    Graph graph;
    const TextureHandle full = graph.fresh("full"), half = graph.fresh("half", kHalf);
    EXPECT_EQ(fault_of([&] {
                  (void)graph.pass("both", {}, {full, half});
              }),
              "pass 'both' writes targets of two sizes");
}

TEST(FrameGraph, TakesTargetsOfTwoFormats) {
    Graph graph;
    EXPECT_EQ(graph.pass("both", {}, {graph.fresh("a"), graph.fresh("b", kOneChannel)}).size(), 2u);
}

TEST(FrameGraph, RefusesAPassThatWritesNothingOrOneTextureTwice) {
    Graph graph;
    EXPECT_EQ(fault_of([&] { (void)graph.pass("idle", {}, {}); }), "pass 'idle' writes nothing");
    const TextureHandle a = graph.fresh("a");
    EXPECT_NE(fault_of([&] { (void)graph.pass("twice", {}, {a, a}); }), "");
}

TEST(FrameGraph, RefusesToWriteWhatIsImportedOrKept) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    EXPECT_NE(fault_of([&] { (void)graph.draw("over_import", {}, color); }), "");
    const TextureHandle out = graph.draw("out", {color}, graph.fresh("out"));
    graph.keep(out);
    EXPECT_NE(fault_of([&] { (void)graph.draw("over_kept", {}, out); }), "");
}

TEST(FrameGraph, RefusesAHandleOfAnotherGraph) {
    Graph graph;
    EXPECT_NE(fault_of([&] { (void)graph.draw("reader", {TextureHandle{7, 1}}, graph.fresh("a")); }), "");
    EXPECT_NE(fault_of([&] { (void)graph.draw("writer", {}, TextureHandle{}); }), "");
}

/// color -> a -> b -> c -> d -> out, all of one description.
struct Chain : Graph {
    TextureHandle color = import_texture("color", kFull);
    TextureHandle a = draw("a", {color}, fresh("a"));
    TextureHandle b = draw("b", {a}, fresh("b"));
    TextureHandle c = draw("c", {b}, fresh("c"));
    TextureHandle d = draw("d", {c}, fresh("d"));
    TextureHandle out = draw("out", {d}, fresh("out"));
};

TEST(FrameGraph, SharesMemoryBetweenLifetimesThatDoNotMeet) {
    Chain chain;
    chain.keep(chain.out);
    const CompiledGraph compiled = chain.compile();
    EXPECT_EQ(slot(compiled, chain.a), slot(compiled, chain.c));
    EXPECT_EQ(slot(compiled, chain.b), slot(compiled, chain.d));
    // A pass never reads the memory that it writes.
    EXPECT_NE(slot(compiled, chain.a), slot(compiled, chain.b));
    EXPECT_NE(slot(compiled, chain.d), slot(compiled, chain.out));
    // color, and two to go back and forth between.
    EXPECT_EQ(compiled.bytes, 3 * kFullBytes);
    EXPECT_EQ(compiled.bytes_unaliased, 6 * kFullBytes);
}

TEST(FrameGraph, NeverSharesTheMemoryOfAnImport) {
    Chain chain;
    chain.keep(chain.out);
    const CompiledGraph compiled = chain.compile();
    for (const TextureHandle other : {chain.a, chain.b, chain.c, chain.d, chain.out})
        EXPECT_NE(slot(compiled, other), slot(compiled, chain.color));
}

TEST(FrameGraph, LeavesTheMemoryOfAKeptTextureAloneToTheEndOfTheFrame) {
    Chain chain;
    chain.keep(chain.a);
    chain.keep(chain.out);
    const CompiledGraph compiled = chain.compile();
    for (const TextureHandle later : {chain.b, chain.c, chain.d, chain.out})
        EXPECT_NE(slot(compiled, later), slot(compiled, chain.a));
    EXPECT_EQ(compiled.bytes, 4 * kFullBytes);
}

TEST(FrameGraph, DoesNotShareMemoryBetweenTwoDescriptions) {
    for (const gpu::TextureDesc& other : {kHalf, kOneChannel}) {
        Graph graph;
        const TextureHandle a = graph.draw("a", {}, graph.fresh("a"));
        const TextureHandle b = graph.draw("b", {a}, graph.fresh("b", other));
        const TextureHandle c = graph.draw("c", {b}, graph.fresh("c"));
        const TextureHandle d = graph.draw("d", {c}, graph.fresh("d", other));
        graph.keep(d);
        const CompiledGraph compiled = graph.compile();
        EXPECT_EQ(slot(compiled, a), slot(compiled, c));
        EXPECT_NE(slot(compiled, a), slot(compiled, b));
        EXPECT_EQ(slot(compiled, b), slot(compiled, d));
        EXPECT_EQ(compiled.slots[std::size_t(slot(compiled, d))], other);
    }
}

TEST(FrameGraph, GivesAllVersionsOfATextureOneMemory) {
    Graph graph;
    const TextureHandle once = graph.draw("once", {}, graph.fresh("a"));
    const TextureHandle b = graph.draw("b", {once}, graph.fresh("b"));
    const TextureHandle twice = graph.draw("twice", {b}, once);
    graph.keep(twice);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.passes.size(), 3u);
    EXPECT_EQ(slot(compiled, once), slot(compiled, twice));
    EXPECT_EQ(compiled.bytes, 2 * kFullBytes);
}

TEST(FrameGraph, CountsBytesByFormat) {
    Graph graph;
    const TextureHandle coc = graph.draw("coc", {}, graph.fresh("coc", kOneChannel));
    graph.keep(graph.draw("half", {coc}, graph.fresh("half", kHalf)));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.bytes, 64u * 36 * 4 + 32u * 18 * 16);
    EXPECT_EQ(compiled.bytes_unaliased, compiled.bytes);
}

}  // namespace
}  // namespace aftershade::graph
