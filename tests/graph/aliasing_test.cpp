// Which textures and buffers share memory.
#include <algorithm>
#include <random>

#include "tests/graph/graph_test.h"

namespace aftershade::graph {
namespace {

/// color -> a -> b -> c -> d -> out, all of one description.
struct Chain : Graph {
    TextureHandle color = import_texture("color", kFull);
    TextureHandle a = draw("a", {color}, fresh("a"));
    TextureHandle b = draw("b", {a}, fresh("b"));
    TextureHandle c = draw("c", {b}, fresh("c"));
    TextureHandle d = draw("d", {c}, fresh("d"));
    TextureHandle out = draw("out", {d}, fresh("out"));
};

TEST(Aliasing, SharesMemoryBetweenLifetimesThatDoNotMeet) {
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

TEST(Aliasing, NeverSharesTheMemoryOfAnImport) {
    Chain chain;
    chain.keep(chain.out);
    const CompiledGraph compiled = chain.compile();
    for (const TextureHandle other : {chain.a, chain.b, chain.c, chain.d, chain.out})
        EXPECT_NE(slot(compiled, other), slot(compiled, chain.color));
}

/// source -> (copy) -> copied -> (blend) -> out, which is kept.
struct Copied : Graph {
    TextureHandle copy_of(TextureHandle from, TextureHandle to) {
        Pass pass = pass_named("copy", PassKind::copy, {from});
        pass.targets = {{to}};
        return add_pass(std::move(pass)).targets.front();
    }
    void finish(TextureHandle to) {
        copied = copy_of(source, to);
        out = blend("add", {}, copied);
        keep(out);
    }
    bool is_in_place(bool shares_memory = true) const {
        const CompiledGraph compiled = compile(shares_memory);
        return slot(compiled, out) == slot(compiled, source);
    }

    TextureHandle source = draw("source", {}, fresh("source")), copied, out;
};

TEST(Aliasing, LeavesACopyWhereItsSourceIsIfNothingNeedsTheSourceAfterwards) {
    Copied of_pass;
    of_pass.finish(of_pass.fresh("copied"));
    EXPECT_TRUE(of_pass.is_in_place());
    EXPECT_EQ(of_pass.compile().bytes, kFullBytes);
    Copied of_capture;
    of_capture.source = of_capture.import_texture("color", kFull, true);
    of_capture.finish(of_capture.fresh("copied"));
    EXPECT_TRUE(of_capture.is_in_place());
}

TEST(Aliasing, CopiesWhatALaterPassReads) {
    Copied graph;
    graph.copied = graph.copy_of(graph.source, graph.fresh("copied"));
    graph.out = graph.draw("later", {graph.copied, graph.source}, graph.fresh("out"));
    graph.keep(graph.out);
    const CompiledGraph compiled = graph.compile();
    EXPECT_NE(slot(compiled, graph.copied), slot(compiled, graph.source));
}

TEST(Aliasing, CopiesWhatTheNextFrameOrTheCallerNeeds) {
    Copied kept;
    kept.finish(kept.fresh("copied"));
    kept.keep(kept.source);
    EXPECT_FALSE(kept.is_in_place());
    Copied given_once;
    given_once.source = given_once.import_texture("table", kFull);
    given_once.finish(given_once.fresh("copied"));
    EXPECT_FALSE(given_once.is_in_place());
    Copied from_history;
    from_history.source = from_history.create_history("accum", kFull).previous;
    from_history.finish(from_history.fresh("copied"));
    EXPECT_FALSE(from_history.is_in_place());
    Copied apart;
    apart.finish(apart.fresh("copied"));
    EXPECT_FALSE(apart.is_in_place(false));
}

TEST(Aliasing, CopiesIntoWhatWasUsedBefore) {
    Copied graph;
    const TextureHandle used = graph.draw("before", {}, graph.fresh("copied"));
    const TextureHandle seen = graph.draw("seen", {used}, graph.fresh("seen"));
    graph.keep(seen);
    graph.finish(used);
    EXPECT_FALSE(graph.is_in_place());
}

TEST(Aliasing, NeverSharesTheMemoryOfAHistory) {
    Graph graph;
    const TextureHistory history = graph.create_history("accum", kFull);
    TextureHandle last = graph.draw("a", {history.previous}, graph.fresh("a"));
    last = graph.draw("b", {last}, graph.fresh("b"));
    last = graph.draw("c", {last}, graph.fresh("c"));
    const TextureHandle current = graph.draw("accum", {last}, history.current);
    last = graph.draw("d", {current}, graph.fresh("d"));
    last = graph.draw("e", {last}, graph.fresh("e"));
    graph.keep(last);
    const CompiledGraph compiled = graph.compile();
    ASSERT_EQ(compiled.passes.size(), 6u);
    for (std::size_t i = 0; i < graph.textures().size(); ++i)
        for (const TextureHandle own : {history.previous, history.current})
            if (int(i) != own.texture) {
                EXPECT_NE(compiled.slot_of_texture[i], slot(compiled, own)) << i;
            }
    EXPECT_EQ(compiled.slots.size(), 4u);
}

TEST(Aliasing, LeavesTheMemoryOfAKeptTextureAloneToTheEndOfTheFrame) {
    Chain chain;
    chain.keep(chain.a);
    chain.keep(chain.out);
    const CompiledGraph compiled = chain.compile();
    for (const TextureHandle later : {chain.b, chain.c, chain.d, chain.out})
        EXPECT_NE(slot(compiled, later), slot(compiled, chain.a));
    EXPECT_EQ(compiled.bytes, 4 * kFullBytes);
}

TEST(Aliasing, DoesNotShareMemoryBetweenTwoDescriptions) {
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

TEST(Aliasing, SharesMemoryBetweenFormatsOfAsManyBytes) {
    const gpu::TextureDesc words{.width = 64, .height = 36, .format = gpu::TextureFormat::rgba32ui};
    Graph graph;
    const TextureHandle a = graph.draw("a", {}, graph.fresh("a"));
    const TextureHandle b = graph.draw("b", {a}, graph.fresh("b", kOneChannel));
    const TextureHandle c = graph.draw("c", {b}, graph.fresh("c", words));
    const TextureHandle d = graph.draw("d", {c}, graph.fresh("d", kIds));
    graph.keep(d);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(slot(compiled, a), slot(compiled, c));
    EXPECT_EQ(slot(compiled, b), slot(compiled, d));
    EXPECT_EQ(compiled.bytes, kFullBytes + kFullBytes / 4);
}

TEST(Aliasing, GivesAllVersionsOfATextureOneMemory) {
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

TEST(Aliasing, CountsBytesByFormat) {
    Graph graph;
    const TextureHandle coc = graph.draw("coc", {}, graph.fresh("coc", kOneChannel));
    graph.keep(graph.draw("half", {coc}, graph.fresh("half", kHalf)));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.bytes, 64u * 36 * 4 + 32u * 18 * 16);
    EXPECT_EQ(compiled.bytes_unaliased, compiled.bytes);
}

TEST(Aliasing, SharesTheMemoryOfClearedTexturesAndClearsItInBetween) {
    Graph graph;
    const TextureHandle a = graph.blend("a", {}, graph.cleared("a"));
    const TextureHandle b = graph.draw("b", {a}, graph.fresh("b"));
    const TextureHandle c = graph.blend("c", {b}, graph.cleared("c"));
    graph.keep(graph.draw("out", {c}, graph.fresh("out", kHalf)));
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(slot(compiled, a), slot(compiled, c));
    EXPECT_EQ(compiled.texture_cleared_before[std::size_t(a.texture)], 0);
    EXPECT_EQ(compiled.texture_cleared_before[std::size_t(c.texture)], 2);
}

TEST(Aliasing, SharesTheMemoryOfBuffersOfOneSize) {
    Graph graph;
    BufferHandle last = graph.import_buffer("input", {64});
    for (int i = 0; i < 6; ++i)
        last = graph.compute("step", {last}, graph.create_buffer("b" + std::to_string(i), {64}));
    last = graph.compute("less", {last}, graph.create_buffer("less", {32}));
    graph.keep(last);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.bytes, 3u * 64 + 32);
    EXPECT_EQ(compiled.bytes_unaliased, 7u * 64 + 32);
}

TEST(Aliasing, NeedsAtMostHalfTheMemoryForAChainOfEightSteps) {
    Graph graph;
    TextureHandle last = graph.import_texture("color", kFull);
    for (int i = 0; i < 8; ++i) {
        // Each step as most are: something small of its own, an intermediate, a result.
        const std::string step = "step" + std::to_string(i);
        const TextureHandle coc = graph.draw(step + ".coc", {last}, graph.fresh(step + ".coc", kOneChannel));
        const TextureHandle blur = graph.draw(step + ".blur", {last, coc}, graph.fresh(step + ".blur"));
        last = graph.draw(step + ".out", {last, blur}, graph.fresh(step + ".out"));
    }
    graph.keep(last);
    const CompiledGraph compiled = graph.compile();
    EXPECT_EQ(compiled.passes.size(), 24u);
    EXPECT_LE(2 * compiled.bytes, compiled.bytes_unaliased);
}

/// A graph of one description: each pass reads up to three of what is there and draws, blends onto, or draws
/// over something; a few are kept.
struct RandomGraph : Graph {
    explicit RandomGraph(unsigned seed) {
        std::mt19937 random(seed);
        const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
        std::vector<TextureHandle> live = {import_texture("input", kFull, seed % 2 == 0)};
        const std::size_t passes = 3 + below(30);
        for (std::size_t i = 0; i < passes; ++i) {
            const std::string name = "p" + std::to_string(i);
            Pass pass = pass_named(name, PassKind::draw);
            for (std::size_t k = below(4); k-- > 0;) {
                const TextureHandle read =
                    live[live.size() - 1 - below(std::min<std::size_t>(live.size(), 5))];
                pass.reads.push_back({.texture = read, .binding = int(pass.reads.size())});
            }
            const std::size_t over = below(live.size());
            const auto is_over = [&](const Read& read) { return read.texture == live[over]; };
            const bool again =
                over > 0 && below(4) == 0 && std::none_of(pass.reads.begin(), pass.reads.end(), is_over);
            if (again && below(2) == 0) pass.blend = gpu::Blend::add;
            pass.targets = {{again ? live[over] : fresh(name)}};
            const TextureHandle made = add_pass(pass).targets[0];
            if (again) {
                live[over] = made;
            } else {
                live.push_back(made);
            }
        }
        keep(live.back());
        for (std::size_t i = below(3); i-- > 0;) keep(live[below(live.size())]);
    }
};

/// How many of the textures that a graph's passes touch hold something at once, counted pass by pass.
std::size_t most_alive(const FrameGraph& graph, const std::vector<int>& passes) {
    const auto touches = [&](int pass, int texture) {
        for (const Read& read : graph.pass(pass).reads)
            if (read.texture.texture == texture) return true;
        for (const Target& target : graph.pass(pass).targets)
            if (target.texture.texture == texture) return true;
        return false;
    };
    std::size_t most = 0;
    for (std::size_t at = 0; at < passes.size(); ++at) {
        std::size_t alive = 0;
        for (std::size_t i = 0; i < graph.textures().size(); ++i) {
            bool before = false, after = false;  // both with the pass itself
            for (std::size_t p = 0; p < passes.size(); ++p) {
                if (!touches(passes[p], int(i))) continue;
                before = before || p <= at;
                after = after || p >= at;
            }
            const bool used = before || after;
            const FrameGraph::Texture& texture = graph.textures()[i];
            if (texture.imported && (used || texture.kept)) before = true;
            if (texture.imported && (texture.kept || (used && !texture.is_given_each_frame))) after = true;
            if (texture.kept && used) after = true;
            if (before && after) ++alive;
        }
        most = std::max(most, alive);
    }
    return most;
}

/// Which passes matter, by going from what is kept to the last pass that wrote it, and on from there.
std::vector<int> passes_that_matter(const FrameGraph& graph) {
    std::vector<std::pair<int, int>> open;  // texture and version
    for (std::size_t i = 0; i < graph.textures().size(); ++i)
        if (graph.textures()[i].kept) open.emplace_back(int(i), graph.textures()[i].version);
    std::vector<bool> matters(std::size_t(graph.pass_count()));
    while (!open.empty()) {
        const auto [texture, version] = open.back();
        open.pop_back();
        for (int i = 0; i < graph.pass_count(); ++i) {
            if (graph.written(i).targets[0] != TextureHandle{texture, version} || matters[std::size_t(i)])
                continue;
            matters[std::size_t(i)] = true;
            const Pass& pass = graph.pass(i);
            for (const Read& read : pass.reads) open.emplace_back(read.texture.texture, read.texture.version);
            if (pass.blend != gpu::Blend::none) open.emplace_back(texture, version - 1);
        }
    }
    std::vector<int> passes;
    for (int i = 0; i < graph.pass_count(); ++i)
        if (matters[std::size_t(i)]) passes.push_back(i);
    return passes;
}

TEST(Aliasing, TakesAsMuchMemoryAsLivesAtOnceInRandomGraphs) {
    std::size_t shared = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const RandomGraph graph(seed);
        const CompiledGraph compiled = graph.compile();
        ASSERT_EQ(compiled.passes, passes_that_matter(graph)) << seed;
        ASSERT_EQ(compiled.bytes, most_alive(graph, compiled.passes) * kFullBytes) << seed;
        shared += compiled.bytes < compiled.bytes_unaliased;
    }
    EXPECT_GT(shared, 100u);  // the graphs are such that there is something to share
}

/// Runs each pass on what its memory holds, as names of versions: nobody may find another's.
TEST(Aliasing, NeverLosesAVersionBeforeItsLastReadInRandomGraphs) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        const RandomGraph graph(seed);
        const CompiledGraph compiled = graph.compile();
        std::vector<TextureHandle> memory(compiled.slots.size());
        for (std::size_t i = 0; i < graph.textures().size(); ++i)
            if (graph.textures()[i].imported && compiled.slot_of_texture[i] >= 0)
                memory[std::size_t(compiled.slot_of_texture[i])] = {int(i), 1};
        for (const int index : compiled.passes) {
            const Pass& pass = graph.pass(index);
            for (const Read& read : pass.reads)
                ASSERT_EQ(memory[std::size_t(slot(compiled, read.texture))], read.texture) << seed;
            const TextureHandle target = pass.targets[0].texture;
            if (pass.blend != gpu::Blend::none) {
                ASSERT_EQ(memory[std::size_t(slot(compiled, target))], target) << seed;
            }
            memory[std::size_t(slot(compiled, target))] = graph.written(index).targets[0];
        }
        for (std::size_t i = 0; i < graph.textures().size(); ++i) {
            if (!graph.textures()[i].kept) continue;
            const TextureHandle kept{int(i), graph.textures()[i].version};
            ASSERT_EQ(memory[std::size_t(slot(compiled, kept))], kept) << seed;
        }
    }
}

}  // namespace
}  // namespace aftershade::graph
