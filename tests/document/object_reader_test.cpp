#include "framework/document/document.h"

#include "tests/documents.h"

namespace aftershade {
namespace {

using test::faults_of;
using test::Lines;
using test::parsed;
using Presence = ObjectReader::Presence;

const std::vector<std::string> kColours = {"red", "green", "blue"};

TEST(ObjectReader, TakesWhatIsThereAndSaysNothing) {
    const Node node =
        parsed(R"({"o": {}, "a": ["x", "y"], "t": "text", "n": 2, "i": 3, "b": true, "c": "red"})");
    Diagnostics diagnostics;
    ObjectReader reader(node, "the thing", diagnostics);
    EXPECT_EQ(reader.object("o"), &node.members[0].value);
    EXPECT_EQ(reader.texts("a"), (std::vector<std::string>{"x", "y"}));
    EXPECT_EQ(reader.text("t"), "text");
    EXPECT_EQ(reader.number("n"), 2.0);  // an integer is a number too
    EXPECT_EQ(reader.integer("i"), 3);
    EXPECT_EQ(reader.boolean("b"), true);
    EXPECT_EQ(reader.choice("c", kColours), "red");
    EXPECT_EQ(reader.text("absent"), std::nullopt);
    reader.finish();
    EXPECT_FALSE(diagnostics.has_errors());
}

TEST(ObjectReader, ListsAllFaultsAtOnce) {
    const auto read = [](const Node& node, Diagnostics& diagnostics) {
        ObjectReader reader(node, "the lens", diagnostics);
        reader.number("focal_length", Presence::required);
        reader.integer("blades");
        reader.choice("shape", std::vector<std::string>{"square", "hexagon"});
        reader.texts("notes");
        reader.text("maker", Presence::required);
        reader.finish();
    };
    const Lines expected = {
        "doc.json:2:21: error: 'focal_length' must be a number, not a string",
        "doc.json:3:13: error: 'blades' must be an integer, not a number",
        "doc.json:3:27: error: 'shape' is 'hexagn' but must be 'square' or 'hexagon'; did you mean "
        "'hexagon'?",
        "doc.json:4:18: error: 'notes' holds strings, not null",
        "doc.json:1:3: error: the lens has no 'maker'",
        "doc.json:5:5: error: the lens has no key 'mker'; did you mean 'maker'?",
        "doc.json:6:5: error: the lens has no key 'zzzzzzzz'",
    };
    EXPECT_EQ(faults_of("  {\n"
                        "    \"focal_length\": \"50\",\n"
                        "  \"blades\": 6.5, \"shape\": \"hexagn\",\n"
                        "  \"notes\": [\"a\", null],\n"
                        "    \"mker\": \"us\",\n"
                        "    \"zzzzzzzz\": 0 }",
                        read),
              expected);
}

TEST(ObjectReader, WantsAnObject) {
    const auto read = [](const Node& node, Diagnostics& diagnostics) {
        ObjectReader reader(node, "the lens", diagnostics);
        EXPECT_FALSE(reader.is_object());
        EXPECT_EQ(reader.text("maker", Presence::required), std::nullopt);
        reader.finish();
    };
    EXPECT_EQ(faults_of(" [1]", read),
              Lines{"doc.json:1:2: error: the lens must be an object, not an array"});
    EXPECT_EQ(faults_of("true", read),
              Lines{"doc.json:1:1: error: the lens must be an object, not true or false"});
}

TEST(ObjectReader, KnowsDocumentVersionOneOnly) {
    const auto read = [](const Node& node, Diagnostics& diagnostics) {
        ObjectReader reader(node, "the look", diagnostics);
        check_document_version(reader, node, diagnostics);
        reader.finish();
    };
    EXPECT_EQ(faults_of(R"({"aftershade": 1})", read), Lines{});
    EXPECT_EQ(faults_of("{}", read), Lines{"doc.json:1:1: error: the look has no 'aftershade'"});
    EXPECT_EQ(faults_of(R"({"aftershade": 2})", read),
              Lines{"doc.json:1:16: error: document version 2 is not known; this program reads version 1"});
    EXPECT_EQ(faults_of(R"({"aftershade": "1"})", read),
              Lines{"doc.json:1:16: error: 'aftershade' must be an integer, not a string"});
}

}  // namespace
}  // namespace aftershade
