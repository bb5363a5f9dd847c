#include "framework/graph/fusion.h"

#include "tests/graph/graph_test.h"

namespace aftershade::graph {
namespace {

/// Draws one after the other over `kFull`; those that follow read the one before by the pixel.
struct PixelChain : Graph {
    TextureHandle picture = import_texture("picture", kFull);

    TextureHandle leads(const std::string& name, TextureHandle read, const gpu::TextureDesc& desc = kFull) {
        return add(name, {read}, Fusing::leads, desc);
    }
    TextureHandle follows(const std::string& name, TextureHandle read, const gpu::TextureDesc& desc = kFull) {
        return add(name, {read}, Fusing::follows, desc);
    }
    TextureHandle add(const std::string& name, std::vector<TextureHandle> reads, Fusing fusing,
                      const gpu::TextureDesc& desc = kFull) {
        Pass pass = pass_named(name, PassKind::draw);
        for (const TextureHandle read : reads)
            pass.reads.push_back({.texture = read,
                                  .binding = int(pass.reads.size()),
                                  .is_pixel = fusing == Fusing::follows && pass.reads.empty()});
        pass.targets = {{create_texture(name, desc)}};
        pass.fusing = fusing;
        return add_pass(std::move(pass)).targets.front();
    }
    /// The names of the passes of each fusion: "a+b".
    std::vector<std::string> fusions(int divide_at = 0, FusionLimits limits = {}) const {
        std::vector<std::string> names;
        const FusionOptions options{limits, divide_at, [](int) { return 1; }};
        for (const Fusion& fusion : find_fusions(*this, compile(), options)) {
            std::string name;
            for (const int index : fusion.passes) name += (name.empty() ? "" : "+") + pass(index).name;
            names.push_back(name + ":" + std::to_string(fusion.targets.size()));
        }
        return names;
    }
};

using Names = std::vector<std::string>;

TEST(Fusion, JoinsAChainOfPixelReadsToItsFirstDraw) {
    PixelChain chain;
    chain.keep(chain.follows("c", chain.follows("b", chain.leads("a", chain.picture))));
    EXPECT_EQ(chain.fusions(), (Names{"a+b+c:1"}));
}

TEST(Fusion, EndsBeforeAReadOfOtherPixels) {
    PixelChain chain;
    const TextureHandle b = chain.follows("b", chain.leads("a", chain.picture));
    chain.keep(chain.follows("d", chain.leads("c", b)));
    EXPECT_EQ(chain.fusions(), (Names{"a+b:1", "c+d:1"}));
}

TEST(Fusion, KeepsAsATargetWhatIsTappedOrReadLater) {
    PixelChain tapped;
    const TextureHandle a = tapped.leads("a", tapped.picture);
    tapped.keep(tapped.follows("b", a));
    tapped.keep(a);
    EXPECT_EQ(tapped.fusions(), (Names{"a+b:2"}));

    PixelChain read;
    const TextureHandle first = read.leads("a", read.picture);
    const TextureHandle second = read.follows("b", first);
    read.keep(read.add("later", {first, second}, Fusing::never));
    EXPECT_EQ(read.fusions(), (Names{"a+b:2"}));
}

TEST(Fusion, DoesNotDelayWhatAPassBetweenNeeds) {
    PixelChain chain;
    const TextureHandle a = chain.leads("a", chain.picture);
    const TextureHandle between = chain.add("between", {a}, Fusing::never);
    chain.keep(chain.add("b", {a, between}, Fusing::follows));
    EXPECT_EQ(chain.fusions(), Names{});
}

TEST(Fusion, DoesNotReadLaterWhatIsOverwrittenBetween) {
    PixelChain chain;
    const TextureHandle t = chain.create_texture("t", kFull);
    const TextureHandle old = chain.draw("write", {chain.picture}, t);
    const TextureHandle a = chain.leads("a", old);
    const TextureHandle renewed = chain.draw("write again", {chain.picture}, old);
    chain.keep(chain.add("b", {a, renewed}, Fusing::follows));
    EXPECT_EQ(chain.fusions(), Names{});
}

TEST(Fusion, LeavesOutFormatsThatRoundAndOtherSizes) {
    gpu::TextureDesc half = kFull;
    half.format = gpu::TextureFormat::rgba16f;
    PixelChain rounded;
    rounded.keep(rounded.follows("b", rounded.leads("a", rounded.picture, half)));
    EXPECT_EQ(rounded.fusions(), Names{});
    PixelChain smaller;
    smaller.keep(smaller.follows("b", smaller.leads("a", smaller.picture), kHalf));
    EXPECT_EQ(smaller.fusions(), Names{});
}

TEST(Fusion, DividesWhereSubframesEndAndAtTheLimitsOfGl) {
    PixelChain chain;
    const TextureHandle b = chain.follows("b", chain.leads("a", chain.picture));
    chain.keep(chain.follows("d", chain.follows("c", b)));
    EXPECT_EQ(chain.fusions(2), (Names{"a+b:1", "c+d:1"}));
    EXPECT_EQ(chain.fusions(0, {.blocks = 3}), (Names{"a+b+c:1"}));
    EXPECT_EQ(chain.fusions(0, {.parts = 2}), (Names{"a+b:1", "c+d:1"}));
}

TEST(Fusion, KeepsAHistoryThatTheNextFrameReads) {
    PixelChain chain;
    const TextureHistory history = chain.create_history("kept", kFull);
    Pass pass = pass_named("a", PassKind::draw, {history.previous});
    pass.targets = {{history.current}};
    pass.fusing = Fusing::leads;
    const TextureHandle a = chain.add_pass(std::move(pass)).targets.front();
    chain.keep(chain.follows("b", a));
    EXPECT_EQ(chain.fusions(), (Names{"a+b:2"}));
}

TEST(Fusion, GivesTheMemoryBetweenItsPartsBack) {
    PixelChain chain;
    const TextureHandle a = chain.leads("a", chain.picture);
    const TextureHandle c = chain.follows("c", chain.follows("b", a));
    chain.keep(c);
    const FusionOptions options{{}, 0, [](int) { return 1; }};
    const auto found = find_fusions(chain, chain.compile(), options);
    ASSERT_EQ(found.size(), 1u);
    const CompiledGraph apart = chain.compile();
    Pass fused = pass_named("a+b+c", PassKind::draw, {chain.picture});
    fused.targets = {{found[0].targets[0]}};
    chain.fuse(found[0].passes, std::move(fused), found[0].targets);
    const CompiledGraph together = chain.compile();
    EXPECT_EQ(apart.passes.size(), 3u);
    EXPECT_EQ(together.passes, std::vector<int>{2});
    EXPECT_EQ(together.bytes_unaliased + 2 * kFullBytes, apart.bytes_unaliased);
    EXPECT_EQ(together.slot_of_texture[std::size_t(a.texture)], -1);
    EXPECT_EQ(to_dot(chain, together).find("label=\"b\""), std::string::npos);
}

}  // namespace
}  // namespace aftershade::graph
