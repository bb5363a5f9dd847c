// Textures that are cleared only where they were drawn to before, against what a clear of every texel leaves.
#include <array>
#include <initializer_list>
#include <memory>
#include <utility>

#include "tests/graph/executor_test.h"

namespace aftershade::graph {
namespace {

constexpr float kClear = 7;
constexpr int kNowhere = 100;  // a column outside the picture

/// Draws `value + column` to a column of a cleared texture, and copies what is there then.
class SparseOn : public GraphOn {
protected:
    struct Columns {
        Graph graph;
        TextureHandle sparse, copy;
        std::vector<int> listing;  ///< passes that say which column
    };

    void SetUp() override {
        GraphOn::SetUp();
        if (IsSkipped()) return;
        list_ = shared(computes(R"(layout(local_size_x = 1) in;
layout(std140, binding = 1) uniform Block { float column; };
layout(std430, binding = 0) writeonly buffer Places { uvec4 place[]; };)",
                                "    place[0] = uvec4(uint(column));"));
        draw_ = shared(columns("float(column) + 1000.0"));
        wipe_ = shared(columns("7.0"));
        copy_ = shared(draws("result = texelFetch(source, p, 0).r;"));
    }

    using Shared = std::shared_ptr<const gpu::Program>;
    static Shared shared(gpu::Program program) {
        return std::make_shared<const gpu::Program>(std::move(program));
    }

    gpu::Program columns(const std::string& value) {
        return gpu::Program::draw(context(), R"(#version 450 core
layout(std430, binding = 0) readonly buffer Places { uvec4 place[]; };
flat out uint column;
void main() {
    column = place[0].x;
    vec2 texel = vec2(float(column) + float(gl_VertexID & 1), 3.0 * float(gl_VertexID >> 1));
    gl_Position = vec4(texel / vec2(5.0, 3.0) * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
})",
                                  R"(#version 450 core
flat in uint column;
layout(std140, binding = 0) uniform Block { vec4 unused; };
layout(location = 0) out float result;
void main() { result = )" + value + "; }",
                                  "columns");
    }

    BufferHandle add_list(Columns& columns, BufferHandle places) {
        Pass pass = with(pass_named("list", PassKind::compute), *list_);
        pass.buffers = {{places, 0, gpu::Access::write}};
        pass.uniforms = {{1, block_of(0)}};
        columns.listing.push_back(columns.graph.pass_count());
        return columns.graph.add_pass(pass).buffers.front();
    }

    Pass column_pass(TextureHandle target, BufferHandle places, bool wipes = true) {
        Pass pass = with(pass_named("column", PassKind::instances), *draw_);
        pass.targets = {{target}};
        pass.instances.count = 1;
        pass.buffers = {{places, 0, gpu::Access::read}};
        if (wipes)
            pass.wipes = {Wipe{[this] { return wipe_; }, {0, block_of(0)}, {places, 0, gpu::Access::read}}};
        return pass;
    }

    /// As wipe_, but only where the buffer at binding 1 has another column.
    Shared rest() {
        return shared(gpu::Program::draw(context(), R"(#version 450 core
layout(std430, binding = 0) readonly buffer Places { uvec4 place[]; };
layout(std430, binding = 1) readonly buffer NextPlaces { uvec4 next_place[]; };
void main() {
    vec2 texel = vec2(float(place[0].x) + float(gl_VertexID & 1), 3.0 * float(gl_VertexID >> 1));
    if (place[0].x == next_place[0].x) texel = vec2(0.0);
    gl_Position = vec4(texel / vec2(5.0, 3.0) * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
})",
                                         R"(#version 450 core
layout(std140, binding = 0) uniform Block { vec4 unused; };
layout(location = 0) out float result;
void main() { result = 7.0; })",
                                         "rest"));
    }

    Pass column_pass_that_wipes_the_rest(TextureHandle target, BufferHandle places, const Shared& rest) {
        Pass pass = column_pass(target, places);
        pass.wipes = {Wipe{[rest] { return rest; }, {0, block_of(0)}, {places, 0, gpu::Access::read}, 1}};
        return pass;
    }

    static TextureHandle cleared(Graph& graph, const std::string& name = "sparse") {
        TextureOptions options;
        options.clear = {kClear, kClear, kClear, kClear};
        return graph.create_texture(name, kSmall, options);
    }

    /// `lists` draws, each of its own column.
    Columns columns_of(int lists = 1) {
        Columns columns;
        columns.sparse = cleared(columns.graph);
        for (int i = 0; i < lists; ++i) {
            const BufferHandle places = add_list(columns, columns.graph.create_buffer("places", {16}));
            columns.sparse = columns.graph.add_pass(column_pass(columns.sparse, places)).targets.front();
        }
        columns.copy =
            columns.graph
                .add_pass(draw_of("copy", *copy_, {columns.sparse}, columns.graph.fresh("copy", kSmall)))
                .targets.front();
        columns.graph.keep(columns.copy);
        return columns;
    }

    static Floats expected(std::initializer_list<int> columns) {
        Floats values(kWidth * kHeight, kClear);
        for (const int column : columns)
            for (int y = 0; y < kHeight && column < kWidth; ++y)
                values[std::size_t(y * kWidth + column)] = float(column) + 1000;
        return values;
    }

    static void set_columns(Executor& executor, const Columns& of, std::initializer_list<int> columns) {
        std::size_t i = 0;
        for (const int column : columns) executor.set_uniforms(of.listing[i++], 1, block_of(float(column)));
    }

    Shared list_, draw_, wipe_, copy_;

    static void poke(gpu::Texture& texture, int column, float value) {
        Floats values = texture.read_floats();
        values[std::size_t(column)] = value;
        texture.upload(values);
    }
};
ON_EACH_BACKEND(SparseOn);

TEST_P(SparseOn, HoldsItsClearValueWhereTheFrameDoesNotDraw) {
    const Columns columns = columns_of(2);
    Executor executor(context(), columns.graph);
    ASSERT_EQ(executor.compiled().sparse.size(), 1u);
    EXPECT_EQ(executor.compiled().sparse.front().places.size(), 2u);
    for (const auto& [a, b] : {std::pair(0, 3), {3, 0}, {kNowhere, 1}, {kNowhere, kNowhere}, {4, 4}}) {
        set_columns(executor, columns, {a, b});
        executor.run(false);
        EXPECT_EQ(executor.texture(columns.copy)->read_floats(), expected({a, b})) << a << ", " << b;
    }
}

TEST_P(SparseOn, IsClearedAsAWholeOnceAndThenOnlyWhereAPassDrew) {
    const Columns columns = columns_of();
    Executor executor(context(), columns.graph);
    set_columns(executor, columns, {1});
    executor.run(false);
    // What no pass has drawn shows what no clear has touched.
    gpu::Texture& memory = *executor.texture(columns.sparse);
    poke(memory, 1, -1);
    poke(memory, 2, -2);
    set_columns(executor, columns, {4});
    executor.run(false);
    Floats want = expected({4});
    want[2] = -2;
    EXPECT_EQ(executor.texture(columns.copy)->read_floats(), want);
}

TEST_P(SparseOn, IsClearedAsAWholeAfterAFrameOfWhichAPartRanTwice) {
    const Columns columns = columns_of();
    Executor executor(context(), columns.graph);
    const int copy = columns.graph.pass_count() - 1;
    for (int frame = 0; frame < 3; ++frame) {
        for (const int column : {0, 2}) {  // sub-frames, each with a column of its own
            set_columns(executor, columns, {column});
            executor.run(false, {}, {0, copy});
        }
        executor.run(false, {}, {copy, -1});
        EXPECT_EQ(executor.texture(columns.copy)->read_floats(), expected({2})) << frame;
        set_columns(executor, columns, {frame});
        executor.run(false);
        EXPECT_EQ(executor.texture(columns.copy)->read_floats(), expected({frame})) << frame;
    }
}

TEST_P(SparseOn, StaysAsItIsWhereLaterPassesAloneRunAgain) {
    Columns columns = columns_of();
    columns.graph.keep(columns.sparse);
    Executor executor(context(), columns.graph, false);
    const int copy = columns.graph.pass_count() - 1;
    set_columns(executor, columns, {1});
    executor.run(false);
    for (int again = 0; again < 2; ++again) {
        executor.run(false, {}, {copy, -1});
        EXPECT_EQ(executor.texture(columns.copy)->read_floats(), expected({1}));
        EXPECT_EQ(executor.texture(columns.sparse)->read_floats(), expected({1}));
    }
    set_columns(executor, columns, {3});
    executor.run(false);
    EXPECT_EQ(executor.texture(columns.copy)->read_floats(), expected({3}));
}

TEST_P(SparseOn, IsNoTextureWhoseMemoryALaterOneCanTake) {
    Columns columns = columns_of();
    Graph& graph = columns.graph;
    TextureHandle last = columns.copy;
    for (int i = 0; i < 3; ++i)
        last = graph.add_pass(draw_of("later", *copy_, {last}, graph.fresh("later", kSmall))).targets.front();
    graph.keep(last);
    Executor executor(context(), graph);
    const CompiledGraph& compiled = executor.compiled();
    EXPECT_TRUE(compiled.sparse.empty());
    EXPECT_GT(std::ranges::count(compiled.slot_of_texture, slot(compiled, columns.sparse)), 1);
    for (const int column : {2, 0, 1}) {
        set_columns(executor, columns, {column});
        executor.run(false);
        EXPECT_EQ(executor.texture(last)->read_floats(), expected({column}));
    }
}

TEST_P(SparseOn, KeepsItsListsFromBuffersOfLaterPasses) {
    Columns columns = columns_of();
    Graph& graph = columns.graph;
    const TextureHandle second = cleared(graph, "second");
    const BufferHandle places = add_list(columns, graph.create_buffer("more places", {16}));
    const TextureHandle drawn = graph.add_pass(column_pass(second, places)).targets.front();
    graph.keep(drawn);
    graph.keep(columns.sparse);  // else the second could take its memory
    Executor executor(context(), graph);
    ASSERT_EQ(executor.compiled().sparse.size(), 2u);
    for (const auto& [a, b] : {std::pair(2, 1), {0, 3}, {kNowhere, 2}}) {
        set_columns(executor, columns, {a, b});
        executor.run(false);
        EXPECT_EQ(executor.texture(columns.copy)->read_floats(), expected({a}));
        EXPECT_EQ(executor.texture(drawn)->read_floats(), expected({b}));
    }
}

TEST_P(SparseOn, NeedsAWipeForEveryDraw) {
    const auto sparse_count = [&](const auto& add) {
        Columns columns;
        TextureHandle target = cleared(columns.graph);
        const BufferHandle places = add_list(columns, columns.graph.create_buffer("places", {16}));
        target = columns.graph.add_pass(column_pass(target, places)).targets.front();
        columns.graph.keep(add(columns, target, places));
        return columns.graph.compile().sparse.size();
    };
    EXPECT_EQ(sparse_count([](Columns&, TextureHandle target, BufferHandle) { return target; }), 1u);
    EXPECT_EQ(sparse_count([&](Columns& columns, TextureHandle target, BufferHandle places) {
                  return columns.graph.add_pass(column_pass(target, places, false)).targets.front();
              }),
              0u);
    EXPECT_EQ(sparse_count([](Columns& columns, TextureHandle target, BufferHandle) {
                  return columns.graph.blend("whole", {}, target);
              }),
              0u);
    EXPECT_EQ(sparse_count([](Columns& columns, TextureHandle target, BufferHandle) {
                  return columns.graph.store("image", {}, target);
              }),
              0u);
    EXPECT_EQ(sparse_count([](Columns& columns, TextureHandle target, BufferHandle) {
                  return columns.graph.clear("clear", {target});
              }),
              0u);
}

TEST_P(SparseOn, KnowsWhereItDrewAfterTheListHasChangedInTheSameFrame) {
    Columns columns;
    Graph& graph = columns.graph;
    BufferHandle places = add_list(columns, graph.create_buffer("places", {16}));
    columns.sparse = graph.add_pass(column_pass(cleared(graph), places)).targets.front();
    places = add_list(columns, places);
    columns.sparse = graph.add_pass(column_pass(columns.sparse, places)).targets.front();
    graph.keep(columns.sparse);
    Executor executor(context(), graph);
    ASSERT_EQ(executor.compiled().sparse.size(), 1u);
    for (const auto& [a, b] : {std::pair(0, 3), {3, 1}, {kNowhere, 2}, {4, kNowhere}}) {
        set_columns(executor, columns, {a, b});
        executor.run(false);
        EXPECT_EQ(executor.texture(columns.sparse)->read_floats(), expected({a, b})) << a << ", " << b;
    }
}

/// A texture with history has two memories, which change places.
TEST_P(SparseOn, IsAHistoryToo) {
    TextureOptions options;
    options.clear = {kClear, kClear, kClear, kClear};
    Columns columns;
    Graph& graph = columns.graph;
    const BufferHandle places = add_list(columns, graph.create_buffer("places", {16}));
    const TextureHistory history = graph.create_history("history", kSmall, options);
    const TextureHandle before =
        graph.add_pass(draw_of("before", *copy_, {history.previous}, graph.fresh("before", kSmall)))
            .targets.front();
    const TextureHandle current = graph.add_pass(column_pass(history.current, places)).targets.front();
    const TextureHandle now =
        graph.add_pass(draw_of("now", *copy_, {current}, graph.fresh("now", kSmall))).targets.front();
    graph.keep(before);
    graph.keep(now);
    Executor executor(context(), graph);
    ASSERT_EQ(executor.compiled().sparse.size(), 1u);
    const auto run = [&](int column, const Floats& left) {
        set_columns(executor, columns, {column});
        executor.run(false);
        EXPECT_EQ(executor.texture(now)->read_floats(), expected({column})) << column;
        EXPECT_EQ(executor.texture(before)->read_floats(), left) << column;
    };
    Floats left(kWidth * kHeight, 0.0f);
    for (const int column : {0, 3, 1, 1, kNowhere, 4, 2}) {
        run(column, left);
        left = expected({column});
    }
    // Whatever is given to it from outside is gone two frames later, as is the zero of a cut.
    left.assign(left.size(), 5.0f);
    executor.history_to_write().textures.at("history")->upload(left);
    run(0, left);
    run(1, expected({0}));
    executor.clear_history();
    run(2, Floats(kWidth * kHeight, 0.0f));
    run(3, expected({2}));
    run(4, expected({3}));
}

/// What is drawn again needs no wipe; what is not, does.
TEST_P(SparseOn, GivesAWipeThePlacesThatThePassDrawsNext) {
    const Shared rest = this->rest();
    for (const int lists : {1, 2}) {
        Columns columns;
        Graph& graph = columns.graph;
        columns.sparse = cleared(graph);
        for (int i = 0; i < lists; ++i) {
            const BufferHandle places = add_list(columns, graph.create_buffer("places", {16}));
            columns.sparse =
                graph.add_pass(column_pass_that_wipes_the_rest(columns.sparse, places, rest)).targets.front();
        }
        graph.keep(columns.sparse);
        Executor executor(context(), graph);
        ASSERT_EQ(executor.compiled().sparse.size(), 1u);
        for (const auto& [a, b] : {std::pair(1, 2), {1, 2}, {3, 1}, {3, 4}, {kNowhere, kNowhere}, {2, 3}}) {
            if (lists == 1) set_columns(executor, columns, {a});
            else set_columns(executor, columns, {a, b});
            executor.run(false);
            EXPECT_EQ(executor.texture(columns.sparse)->read_floats(),
                      lists == 1 ? expected({a}) : expected({a, b}))
                << a << ", " << b;
        }
    }
}

/// Both draws leave the rows below the first as they are, although their wipes say otherwise: there a column
/// shows whether it was wiped.
TEST_P(SparseOn, WipesNothingOfWhatTheFirstOfSeveralPassesDrawsOver) {
    draw_ = shared(columns("float(column) + 1000.0; if (gl_FragCoord.y > 1.0) discard"));
    const Shared rest = this->rest();
    constexpr float kStale = -1;
    const auto row_below = [&](bool is_read_between, std::initializer_list<int> now, float second_tiles = 0) {
        Columns columns;
        Graph& graph = columns.graph;
        columns.sparse = cleared(graph);
        std::array<BufferHandle, 2> places;
        for (BufferHandle& list : places) list = add_list(columns, graph.create_buffer("places", {16}));
        if (is_read_between)
            graph.keep(graph.add_pass(draw_of("look", *copy_, {columns.sparse}, graph.fresh("look", kSmall)))
                           .targets.front());
        for (std::size_t i = 0; i < places.size(); ++i) {
            Pass pass = column_pass_that_wipes_the_rest(columns.sparse, places[i], rest);
            pass.wipes.front()->uniforms.bytes = block_of(i == 0 ? 0 : second_tiles);
            columns.sparse = graph.add_pass(pass).targets.front();
        }
        graph.keep(columns.sparse);
        Executor executor(context(), graph);
        EXPECT_EQ(executor.compiled().sparse.size(), 1u);
        set_columns(executor, columns, {1, 2});
        executor.run(false);
        gpu::Texture& memory = *executor.texture(columns.sparse);
        memory.upload(Floats(std::size_t(kWidth) * kHeight, kStale));
        set_columns(executor, columns, now);
        executor.run(false);
        const Floats values = memory.read_floats();
        return Floats(values.begin() + kWidth, values.begin() + 3 + kWidth);
    };
    EXPECT_EQ(row_below(false, {1, 2}), (Floats{kStale, kStale, kClear})) << "the second pass's place alone";
    EXPECT_EQ(row_below(false, {2, 3}), (Floats{kStale, kClear, kStale})) << "now the first pass draws there";
    EXPECT_EQ(row_below(false, {3, 1}), (Floats{kStale, kClear, kClear}));
    EXPECT_EQ(row_below(true, {1, 2}), (Floats{kStale, kClear, kClear})) << "a pass sees it before";
    EXPECT_EQ(row_below(false, {2, 3}, 1), (Floats{kStale, kClear, kClear})) << "tiles of another size";
}

/// Where one level is drawn next, the other keeps its wipe.
TEST_P(SparseOn, WipesEachLevelByWhatIsDrawnToItNext) {
    constexpr int kLevels = 2;
    const Shared rest = this->rest();
    Columns columns;
    Graph& graph = columns.graph;
    TextureOptions options;
    options.clear = {kClear, kClear, kClear, kClear};
    gpu::TextureDesc desc = kSmall;
    desc.width *= 2;
    desc.height *= 2;
    desc.mips = kLevels;
    columns.sparse = graph.create_texture("sparse", desc, options);
    std::array<BufferHandle, kLevels> places;
    for (BufferHandle& list : places) list = add_list(columns, graph.create_buffer("places", {16}));
    for (int level = 0; level < kLevels; ++level) {
        Pass pass = column_pass_that_wipes_the_rest(columns.sparse, places[std::size_t(level)], rest);
        pass.targets.front().level = level;
        columns.sparse = graph.add_pass(pass).targets.front();
    }
    graph.keep(columns.sparse);
    Executor executor(context(), graph);
    ASSERT_EQ(executor.compiled().sparse.size(), 1u);
    for (const auto& [a, b] :
         {std::pair(0, 3), {3, 0}, {1, 1}, {1, 2}, {2, kNowhere}, {kNowhere, 2}, {4, 4}}) {
        set_columns(executor, columns, {a, b});
        executor.run(false);
        const gpu::Texture& texture = *executor.texture(columns.sparse);
        EXPECT_EQ(texture.read_floats(1), expected({b})) << a << ", " << b;
        const Floats narrow = expected({a}), wide = texture.read_floats(0);
        for (std::size_t i = 0; i < wide.size(); ++i)
            EXPECT_EQ(wide[i], narrow[i % std::size_t(desc.width) / 2]) << i << ", " << a << ", " << b;
    }
}

TEST_P(SparseOn, RefusesWipesThatCannotWork) {
    Columns columns;
    Graph& graph = columns.graph;
    const BufferHandle places = add_list(columns, graph.create_buffer("places", {16}));
    const BufferHandle others = add_list(columns, graph.create_buffer("others", {16}));
    Pass pass = column_pass(graph.cleared("a", kSmall), places);
    pass.wipes[0]->places.buffer = others;
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(pass); }),
              "pass 'column' wipes 'a' where a buffer says that the pass does not read");
    pass = column_pass(graph.cleared("b", kSmall), places);
    pass.wipes[0]->program = nullptr;
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(pass); }),
              "pass 'column' wipes 'b' without a program or its block");
    pass.wipes.emplace_back();
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(pass); }),
              "pass 'column' has 2 wipes for 1 targets, or does not draw instances");
    const TextureHandle filled = graph.draw("fill", {}, graph.fresh("d", kSmall));
    EXPECT_EQ(fault_of([&] { (void)graph.add_pass(column_pass(filled, places)); }),
              "pass 'column' wipes 'd', which is not cleared");
}

}  // namespace
}  // namespace aftershade::graph
