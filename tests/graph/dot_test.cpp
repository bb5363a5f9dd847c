#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <unistd.h>

#include "tests/graph/graph_test.h"

namespace aftershade::graph {
namespace {

/// Everything that a drawing of a graph can hold.
std::string picture() {
    Graph graph;
    const TextureHandle color = graph.import_texture("capture.\"color\"", kFull);
    const TextureHistory history = graph.create_history("taa.accum", kFull);
    const BufferHistory exposure = graph.create_history_buffer("exposure.sum", {16});
    const BufferHandle sum = graph.compute("exposure.sum", {exposure.previous}, exposure.current);
    const TextureHandle pyramid =
        graph.draw_at("bloom.base", {color}, {graph.cleared("bloom.pyramid", kPyramid)});
    (void)graph.draw("bloom\\unused", {color}, graph.fresh("bloom.unused", kArray));
    const TextureHandle blended =
        graph.draw("taa.blend", {color, history.previous, pyramid}, history.current);
    graph.keep(graph.draw("out", {blended}, graph.fresh("out", kHalf)));
    graph.keep(sum);
    return to_dot(graph, graph.compile());
}

bool has(const std::string& text, const std::string& pattern) {
    return std::regex_search(text, std::regex(pattern));
}

TEST(Dot, SaysSizeFormatAndSlotAndWhatIsCulledOrHistory) {
    const std::string dot = picture();
    EXPECT_TRUE(has(dot, R"re(\[shape=box, label="taa\.blend"\];)re")) << dot;
    EXPECT_TRUE(has(dot, R"re(\[shape=box, label="bloom\\\\unused", color=grey, fontcolor=grey\];)re"));
    EXPECT_TRUE(has(dot, R"re(shape=ellipse, label="out\\n32x18 rgba32f\\nslot \d+"\])re"));
    EXPECT_TRUE(has(dot, R"re(label="bloom\.pyramid\\n64x36 r32f, 3 levels\\nslot \d+"\])re"));
    EXPECT_TRUE(has(dot, R"re(label="bloom\.unused\\n64x36 r32f, 2 layers", color=grey)re"));
    EXPECT_TRUE(has(dot, R"re(label="taa\.accum\.prev\\n64x36 rgba32f\\nslot \d+", style=dashed\])re"));
    EXPECT_TRUE(has(
        dot, R"re(shape=cylinder, label="exposure\.sum\\n16 bytes\\nbuffer slot \d+", style=dashed\])re"));
    EXPECT_TRUE(has(dot, R"re(r\d+_1 -> r\d+_1 \[style=dashed, constraint=false\];)re"));
    EXPECT_TRUE(has(dot, R"re(label="capture\.\\"color\\")re"));
}

TEST(Dot, DrawsAnEdgeForEachReadAndEachWrite) {
    Graph graph;
    const TextureHandle color = graph.import_texture("color", kFull);
    const TextureHandle a = graph.draw("a", {color, color}, graph.fresh("a"));
    graph.keep(graph.blend("b", {color}, a));
    const std::string dot = to_dot(graph, graph.compile());
    const std::regex edge(R"(\n  (\w+) -> (\w+);)");
    std::vector<std::pair<std::string, std::string>> edges;
    for (std::sregex_iterator it(dot.begin(), dot.end(), edge); it != std::sregex_iterator(); ++it)
        edges.emplace_back((*it)[1], (*it)[2]);
    const std::vector<std::pair<std::string, std::string>> expected = {
        {"r0_1", "p0"}, {"p0", "r1_1"}, {"r0_1", "p1"}, {"r1_1", "p1"}, {"p1", "r1_2"}};
    EXPECT_EQ(edges, expected) << dot;
}

TEST(Dot, IsWhatGraphvizTakes) {
    if (std::system("command -v dot >/dev/null") != 0) GTEST_SKIP() << "graphviz is not installed";
    const auto base = std::filesystem::temp_directory_path() / ("aftershade_dot_" + std::to_string(getpid()));
    const std::string source = base.string() + ".dot", svg = base.string() + ".svg";
    std::ofstream(source) << picture();
    EXPECT_EQ(std::system(("dot -Tsvg '" + source + "' -o '" + svg + "' 2>&1").c_str()), 0);
    std::stringstream text;
    text << std::ifstream(svg).rdbuf();
    EXPECT_TRUE(has(text.str(), "<title>p0</title>"));
    EXPECT_TRUE(has(text.str(), "taa\\.accum\\.prev"));
    std::filesystem::remove(source);
    std::filesystem::remove(svg);
}

}  // namespace
}  // namespace aftershade::graph
