#include "framework/document/grammar.h"

#include <nlohmann/json.hpp>

#include "framework/document/grammar_reader.h"
#include "framework/document/grammar_schema.h"
#include "framework/document/grammar_table.h"
#include "tests/documents.h"

namespace aftershade::grammar {
namespace {

using nlohmann::json;
using test::faults_of;
using test::Lines;
using test::parsed;

ParamSpec focus_distance() {
    ParamSpec spec;
    spec.name = "focus_distance";
    spec.unit = "m";
    spec.min = 0.01;
    spec.default_value = 5.0;
    spec.doc = "To the plane in focus.";
    return spec;
}

Block lens_block(const std::vector<Key>& more = {}) {
    Block block{
        .name = "lens",
        .thing = "the lens",
        .doc = "What the camera looks through.",
        .keys = {required("maker", text(), "Who made it."),
                 optional("blades", integer(0, 32), "Corners of the aperture.", "6"),
                 optional("coating", choice({"none", "single", "multi"}), "Of the glass.", R"("single")"),
                 field(focus_distance()), optional("notes", list(text()), "What is known of it.")}};
    block.keys.insert(block.keys.end(), more.begin(), more.end());
    return block;
}

Lines faults(const std::string& text, const Block& block) {
    return faults_of(text,
                     [&](const Node& node, Diagnostics& diagnostics) { check(node, block, diagnostics); });
}

std::string fault(const std::string& value, const Form& form) {
    const Block block{.name = "thing", .thing = "the thing", .keys = {optional("key", form, "")}};
    const Lines lines = faults("{\"key\": " + value + "}", block);
    const std::string head = "error: ";
    return lines.empty() ? "" : lines[0].substr(lines[0].find(head) + head.size());
}

json schema_of(const Form& form) {
    const Block block{.name = "thing", .keys = {optional("key", form, "")}};
    return json::parse(schema_text("A thing", block))["properties"]["key"];
}

TEST(Grammar, TakesAKeyOfOneDeclarationInCheckSchemaAndTable) {
    const Block before = lens_block();
    const Block after = lens_block({optional("weight", number({.min = 0, .max = 9}), "Kilograms.", "0.5")});
    const std::string document = R"({"maker": "us", "weight": 10})";
    EXPECT_EQ(faults(document, before), Lines{"doc.json:1:17: error: the lens has no key 'weight'"});
    EXPECT_EQ(faults(document, after), Lines{"doc.json:1:27: error: 'weight' must be from 0 to 9, not 10"});
    EXPECT_EQ(faults(R"({"maker": "us", "wieght": 1})", after),
              Lines{"doc.json:1:17: error: the lens has no key 'wieght'; did you mean 'weight'?"});
    EXPECT_FALSE(json::parse(schema_text("Lens", before))["properties"].contains("weight"));
    EXPECT_EQ(json::parse(schema_text("Lens", after))["properties"]["weight"],
              json::parse(R"({"type": "number", "minimum": 0, "maximum": 9, "description": "Kilograms.",
                              "default": 0.5})"));
    EXPECT_EQ(table_of(before).find("weight"), std::string::npos);
    EXPECT_NE(table_of(after).find("| `weight` | float |  | 0 to 9 | 0.5 | Kilograms. |\n"),
              std::string::npos)
        << table_of(after);
    EXPECT_EQ(Reader(parsed(R"({"maker": "us"})"), after).number("weight"), 0.5);
}

TEST(Grammar, ReportsEveryFaultWithItsPlaceInTheOrderOfTheKeys) {
    EXPECT_EQ(
        faults("{ \"blads\": 3,\n  \"focus_distance\": \"5 s\",\n  \"coating\": \"doubel\", \"blades\": 33,\n"
               "  \"notes\": [\"a\", 1] }",
               lens_block()),
        (Lines{
            "doc.json:1:1: error: the lens has no 'maker'",
            "doc.json:3:34: error: 'blades' must be from 0 to 32, not 33",
            "doc.json:3:14: error: 'coating' is 'doubel' but must be 'none', 'single' or 'multi'",
            "doc.json:2:21: error: focus_distance: '5 s' cannot be converted to m; write 'um', 'mm', 'cm', "
            "'m', 'km', 'in' or 'ft'",
            "doc.json:4:18: error: 'notes' holds strings, not an integer",
            "doc.json:1:3: error: the lens has no key 'blads'; did you mean 'blades'?"}));
    EXPECT_EQ(faults("[]", lens_block()),
              Lines{"doc.json:1:1: error: the lens must be an object, not an array"});
}

TEST(Grammar, HasAHeadInDocuments) {
    Block block = lens_block();
    block.is_document = true;
    EXPECT_EQ(faults(R"({"aftershade": 1, "$schema": "x", "maker": "us"})", block), Lines{});
    EXPECT_EQ(faults(R"({"aftershade": 2, "maker": "us"})", block),
              Lines{"doc.json:1:16: error: document version 2 is not known; this program reads version 1"});
    EXPECT_EQ(faults(R"({"aftershade": "1", "$schema": 1, "maker": "us"})", block),
              (Lines{"doc.json:1:16: error: 'aftershade' must be an integer, not a string",
                     "doc.json:1:32: error: '$schema' must be a string, not an integer"}));
    EXPECT_EQ(faults(R"({"maker": "us"})", block),
              Lines{"doc.json:1:1: error: the lens has no 'aftershade'"});
    const json schema = json::parse(schema_text("Lens", block));
    EXPECT_EQ(schema["title"], "Lens");
    EXPECT_EQ(schema["required"], json::parse(R"(["aftershade", "maker"])"));
    EXPECT_EQ(schema["properties"]["aftershade"]["const"], 1);
}

bool is_lower(const std::string& text) {
    return !text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos;
}

const Pattern kAov = {"^aov:.+$", [](const std::string& t) { return t.starts_with("aov:") && t.size() > 4; }};

TEST(Grammar, SaysOfEachFormWhatDoesNotFit) {
    const std::tuple<Form, const char*, const char*> cases[] = {
        {boolean(), "1", "'key' must be true or false, not an integer"},
        {integer(), "0.5", "'key' must be an integer, not a number"},
        {integer(1, 1024), "0", "'key' must be from 1 to 1024, not 0"},
        {number({.above = 0}), "0", "'key' must be above 0, not 0"},
        {number({.above = 0, .max = 4}), "5", "'key' must be above 0 and at most 4, not 5"},
        {number({.min = 0}), "-1", "'key' must be at least 0, not -1"},
        {text({.min_length = 1}), "\"\"", "'key' is empty"},
        {text({.pattern = {"^[a-z]+$", is_lower}, .fault = "'{}' is no word"}), "\"A\"", "'A' is no word"},
        {text({.pattern = {"^x$", [](const std::string& t) { return t == "x"; }}, .noun = "the x"}), "\"y\"",
         "'key' is 'y', which is not the x"},
        {snake_case(), "\"A\"", "the name 'A' must be snake_case: a-z, 0-9 and _, beginning with a letter"},
        {name_of({"color", "depth"}, "a role", kAov), "\"dpth\"",
         "'dpth' is not a role; did you mean 'depth'?"},
        {constant("true"), "false", "'key' must be true"},
        {list(integer(), {.min = 2, .max = 2}), "[1]", "'key' holds 2 items, not 1"},
        {list(integer(), {.min = 1}), "[]", "'key' holds at least 1 item, not 0"},
        {list(integer(), {.max = 2, .fault = "two at most"}), "[1, 2, 3]", "two at most"},
        {list(text(), {.unique = true}), R"(["a", "b", "a"])", "'key' holds 'a' twice"},
        {named(integer(), "parameter"), R"({"Gain": 1})",
         "parameter 'Gain' must be snake_case: a-z, 0-9 and _, beginning with a letter"},
        {map(integer(), {.min = 1, .max = 1}), "{}", "'key' has 1 member, not 0"},
        {any_of({integer(1, 9), text()}), "true", "'key' must be an integer or a string, not true or false"},
        {any_of({integer(1, 9), text()}), "10", "'key' must be from 1 to 9, not 10"},
        {any_of({integer(1, 9), text()}, "'{}' is a number or its name"), "10",
         "'key' is a number or its name"},
        {by_kind({integer(1, 9), text()}, "a number or its name"), "10", "'key' must be from 1 to 9, not 10"},
        {by_kind({integer(1, 9), text()}, "a number or its name"), "true", "a number or its name"},
        {with_fault(integer(1, 9), "'{}' is too much"), "10", "'key' is too much"},
        {shown_as(integer(1, 9), "digit"), "10", "'key' must be from 1 to 9, not 10"},
        {map(integer(), {.min = 1, .max = 1, .count_fault = "one name"}), "{}", "one name"},
        {map(integer(), {.pattern = {"^x$", [](const std::string& name) { return name == "x"; }},
                         .fault = "'{}' is no x"}),
         R"({"y": 1})", "'y' is no x"},
    };
    for (const auto& [form, value, message] : cases) EXPECT_EQ(fault(value, form), message);
}

TEST(Grammar, ReportsAFaultOfAnAlternativeByTheKindOfJsonThatItMeans) {
    const Form form = any_of(
        {constant("\"pixel\""),
         object({.name = "tile", .thing = "'per'", .keys = {required("tile", integer(2, 4096), "")}})});
    EXPECT_EQ(fault("\"pixel\"", form), "");
    EXPECT_EQ(fault(R"({"tile": 1})", form), "'tile' must be from 2 to 4096, not 1");
    EXPECT_EQ(fault("{}", form), "'per' has no 'tile'");
    EXPECT_EQ(fault("\"pixels\"", form), "'key' must be \"pixel\"");
}

TEST(Grammar, WritesTheSchemaOfEachForm) {
    const std::pair<Form, const char*> cases[] = {
        {boolean(), R"({"type": "boolean"})"},
        {integer(1, 1024), R"({"type": "integer", "minimum": 1, "maximum": 1024})"},
        {number({.above = 0}), R"({"type": "number", "exclusiveMinimum": 0})"},
        {text({.pattern = {"^a", [](const std::string& t) { return t.starts_with("a"); }}, .min_length = 1}),
         R"({"type": "string", "minLength": 1, "pattern": "^a"})"},
        {choice({"a", "b"}), R"({"enum": ["a", "b"]})"},
        {choice({"a"}), R"({"const": "a"})"},
        {constant("-1"), R"({"const": -1})"},
        {list(boolean(), {.min = 1, .max = 2, .unique = true}),
         R"({"type": "array", "items": {"type": "boolean"}, "minItems": 1, "maxItems": 2, "uniqueItems": true})"},
        {named(boolean(), "x", 1), R"({"type": "object", "propertyNames": {"pattern": "^[a-z][a-z0-9_]*$"},
            "additionalProperties": {"type": "boolean"}, "minProperties": 1})"},
        {any_of({boolean(), any_of({integer(), text()})}),
         R"({"anyOf": [{"type": "boolean"}, {"type": "integer"}, {"type": "string"}]})"},
        {custom({.type = "x", .schema = R"({"not": {}})"}), R"({"not": {}})"},
        {with_variables(list(boolean())),
         R"({"anyOf": [{"type": "array", "items": {"anyOf": [{"type": "boolean"},
            {"$ref": "#/$defs/Variable"}]}}, {"$ref": "#/$defs/Variable"}]})"},
    };
    for (const auto& [form, schema] : cases)
        EXPECT_EQ(schema_of(form), json::parse(schema)) << schema_of(form);
}

Block shape_block() {
    return {
        .name = "shape",
        .doc = "What is seen.",
        .keys = {optional("name", text(), "Its own.")},
        .selector = "type",
        .kinds = {
            {.name = "disk", .doc = "Round.", .keys = {required("radius", number(), "Of the rim.")}},
            {.name = "ball", .doc = "Round all over.", .keys = {required("radius", number(), "Of the rim.")}},
            {.name = "box", .keys = {optional("height", number(), "Upwards.", "1")}}}};
}

TEST(Grammar, ChoosesTheKeysOfAnObjectByItsKind) {
    const Block block{
        .name = "scene", .thing = "the scene", .keys = {optional("shapes", list(object(shape_block())), "")}};
    const auto with = [&](const std::string& shape) {
        return faults("{\"shapes\": [" + shape + "]}", block);
    };
    EXPECT_EQ(with(R"({"type": "disk", "radius": 1, "name": "a"}, {"type": "box"})"), Lines{});
    EXPECT_EQ(
        with(R"({"type": "box", "radius": 1})"),
        Lines{"doc.json:1:29: error: shapes[0] has no key 'radius'; it is a key of type 'disk' or 'ball'"});
    EXPECT_EQ(with("{}"), Lines{"doc.json:1:13: error: shapes[0] has no 'type'"});
    EXPECT_EQ(with(R"({"type": "cone", "radius": 1, "nmae": ""})"),
              (Lines{"doc.json:1:22: error: 'type' is 'cone' but must be 'disk', 'ball' or 'box'",
                     "doc.json:1:43: error: shapes[0] has no key 'nmae'; did you mean 'name'?"}));
    EXPECT_EQ(with("1"), Lines{"doc.json:1:13: error: shapes[0] must be an object, not an integer"});
    EXPECT_EQ(json::parse(schema_text("", shape_block()))["anyOf"][2],
              json::parse(R"({"type": "object", "properties": {"type": {"const": "box"},
                "height": {"type": "number", "description": "Upwards.", "default": 1},
                "name": {"type": "string", "description": "Its own."}},
                "additionalProperties": false, "required": ["type"]})"));
    EXPECT_EQ(table_of(shape_block()),
              "| key | of | type | default | |\n|---|---|---|---|---|\n"
              "| `type` |  | enum: disk, ball, box | required | Kind, which decides the other keys. |\n"
              "| `name` |  | text |  | Its own. |\n"
              "| `radius` | disk, ball | float | required | Of the rim. |\n"
              "| `height` | box | float | 1 | Upwards. |\n");
}

TEST(Grammar, HasADefaultKind) {
    Block block = shape_block();
    block.thing = "the shape";
    block.default_kind = "box";
    EXPECT_EQ(faults(R"({"height": 2})", block), Lines{});
    EXPECT_EQ(
        faults(R"({"radius": 2})", block),
        Lines{"doc.json:1:2: error: the shape has no key 'radius'; it is a key of type 'disk' or 'ball'"});
    EXPECT_EQ(Reader(parsed("{}"), block).kind(), "box");
    EXPECT_FALSE(json::parse(schema_text("", block))["anyOf"][2].contains("required"));
}

TEST(Grammar, HoldsKeysOfOneObjectAgainstEachOther) {
    const auto with = [](const Rule& rule) {
        return Block{.name = "it",
                     .thing = "the thing",
                     .keys = {optional("a", integer(), ""), optional("b", integer(), ""),
                              optional("c", integer(), "")},
                     .rules = {rule}};
    };
    const auto schema = [&](const Rule& rule) {
        json all = json::parse(schema_text("", with(rule)));
        for (const char* word : {"$schema", "title", "type", "properties", "additionalProperties"})
            all.erase(word);
        return all.dump();
    };
    const Rule one = exactly_one_of({"a", "b"});
    EXPECT_EQ(faults(R"({"a": 1})", with(one)), Lines{});
    EXPECT_EQ(faults(R"({"a": 1, "b": 1})", with(one)),
              Lines{"doc.json:1:1: error: the thing has one of 'a' and 'b'"});
    EXPECT_EQ(faults("{}", with(one)), Lines{"doc.json:1:1: error: the thing has one of 'a' and 'b'"});
    EXPECT_EQ(schema(one), R"({"oneOf":[{"required":["a"]},{"required":["b"]}]})");
    EXPECT_NE(table_of(with(one)).find("\nExactly one of `a` and `b`.\n"), std::string::npos);
    const Rule most = at_most_one_of({"a", "b", "c"});
    EXPECT_EQ(faults("{}", with(most)), Lines{});
    EXPECT_EQ(faults(R"({"a": 1, "c": 1})", with(most)),
              Lines{"doc.json:1:15: error: only one of 'a', 'b' and 'c' may be given"});
    EXPECT_EQ(schema(at_most_one_of({"a", "b"})), R"({"not":{"anyOf":[{"required":["a","b"]}]}})");
    const Rule least = at_least_one_of({"a", "b"});
    EXPECT_EQ(faults(R"({"a": 1, "b": 1})", with(least)), Lines{});
    EXPECT_EQ(faults(R"({"c": 1})", with(least)),
              Lines{"doc.json:1:1: error: the thing has at least one of 'a' and 'b'"});
    const Rule both = needs("a", "b", "no a without b");
    EXPECT_EQ(faults(R"({"b": 1})", with(both)), Lines{});
    EXPECT_EQ(faults(R"({"a": 1})", with(both)), Lines{"doc.json:1:7: error: no a without b"});
    EXPECT_EQ(schema(both), R"({"dependentRequired":{"a":["b"]}})");
}

TEST(Grammar, HoldsAnObjectToMoreWhereAKeyHasAValue) {
    const Block block{.name = "buffer",
                      .thing = "the buffer",
                      .keys = {optional("indirect", boolean(), ""), optional("element", text(), ""),
                               optional("count", integer(), ""), optional("history", boolean(), "")},
                      .rules = {when({.key = "indirect",
                                      .value = "true",
                                      .required = {"count"},
                                      .absent = {"history"},
                                      .narrowed = {{"element", choice({"uint"})}}})}};
    EXPECT_EQ(faults(R"({"indirect": false, "history": true})", block), Lines{});
    EXPECT_EQ(faults(R"({"indirect": true, "count": 4, "element": "uint"})", block), Lines{});
    EXPECT_EQ(faults(R"({"indirect": true, "history": true, "element": "vec2"})", block),
              (Lines{"doc.json:1:1: error: the buffer has no 'count'",
                     "doc.json:1:31: error: the buffer has no key 'history' where 'indirect' is true",
                     "doc.json:1:48: error: 'element' is 'vec2' but must be 'uint'"}));
    const json schema = json::parse(schema_text("", block));
    EXPECT_EQ(schema["if"],
              json::parse(R"({"properties": {"indirect": {"const": true}}, "required": ["indirect"]})"));
    EXPECT_EQ(schema["then"], json::parse(R"({"required": ["count"], "properties": {"history": false,
        "element": {"const": "uint"}}})"));
}

TEST(Grammar, ReportsOneFaultOfAValueAndOneOfARuleThatHasItsOwn) {
    const Block block{.name = "buffer",
                      .thing = "the buffer",
                      .keys = {optional("indirect", boolean(), ""), optional("count", integer(1, 9), ""),
                               optional("per", text(), "")},
                      .rules = {when({.key = "per", .narrowed = {{"count", integer(1, 4)}}}),
                                when({.key = "indirect",
                                      .value = "true",
                                      .required = {"count"},
                                      .absent = {"per"},
                                      .fault = "{} counts by itself"})}};
    EXPECT_EQ(faults(R"({"count": 10, "per": "x"})", block),
              Lines{"doc.json:1:11: error: 'count' must be from 1 to 9, not 10"});
    EXPECT_EQ(faults(R"({"count": 5, "per": "x"})", block),
              Lines{"doc.json:1:11: error: 'count' must be from 1 to 4, not 5"});
    EXPECT_EQ(faults(R"({"indirect": true, "per": "x"})", block),
              Lines{"doc.json:1:1: error: the buffer counts by itself"});
}

TEST(Grammar, PutsRulesThatSayTheSameWordBesideEachOther) {
    const Block block{
        .name = "it",
        .keys = {optional("a", integer(), ""), optional("b", integer(), ""), optional("c", integer(), "")},
        .rules = {needs("a", "b"), needs("b", "c"), exactly_one_of({"a", "b"}), exactly_one_of({"b", "c"})}};
    const json schema = json::parse(schema_text("", block));
    EXPECT_EQ(schema["dependentRequired"], json::parse(R"({"a": ["b"], "b": ["c"]})"));
    EXPECT_TRUE(schema.contains("oneOf"));
    EXPECT_EQ(schema["allOf"].size(), 1u);
}

TEST(Grammar, TakesKeysByTheirPattern) {
    const Block block{.name = "files",
                      .keys = {optional("color", text(), "")},
                      .others = {{kAov, text()}},
                      .unknown_key = "'{}' is not a role"};
    EXPECT_EQ(faults(R"({"color": "a", "aov:mist": "b"})", block), Lines{});
    EXPECT_EQ(faults(R"({"colour": "a", "aov:": "b", "aov:x": 1})", block),
              (Lines{"doc.json:1:2: error: 'colour' is not a role; did you mean 'color'?",
                     "doc.json:1:17: error: 'aov:' is not a role",
                     "doc.json:1:39: error: 'aov:x' must be a string, not an integer"}));
    EXPECT_EQ(json::parse(schema_text("", block))["patternProperties"],
              json::parse(R"({"^aov:.+$": {"type": "string"}})"));
}

const Block& group_block() {
    static const Block block{
        .name = "group",
        .thing = "the group",
        .keys = {required("members", list(by_key("members", object(group_block), object(lens_block()))), "")},
        .definition = "group"};
    return block;
}

TEST(Grammar, MayHoldABlockInItself) {
    EXPECT_EQ(faults(R"({"members": [{"maker": "a"}, {"members": [{"maker": "b", "blades": -1}]}, {}]})",
                     group_block()),
              (Lines{"doc.json:1:68: error: 'blades' must be from 0 to 32, not -1",
                     "doc.json:1:75: error: the lens has no 'maker'"}));
    const json schema =
        json::parse(schema_text("", Block{.name = "all", .keys = {optional("g", object(group_block), "")}}));
    const json item = schema["$defs"]["group"]["properties"]["members"]["items"];
    EXPECT_EQ(item["if"], json::parse(R"({"type": "object", "required": ["members"]})"));
    EXPECT_EQ(item["then"], json::parse(R"({"$ref": "#/$defs/group"})"));
    EXPECT_TRUE(item["else"]["properties"].contains("maker"));
    EXPECT_EQ(blocks_of(group_block()).size(), 2u);
    EXPECT_NE(table_of(group_block()).find("list of ([lens](#lens), or [group](#group))"), std::string::npos)
        << table_of(group_block());
}

TEST(Grammar, RefersToABlockThatHasADefinition) {
    Block lens = lens_block();
    lens.definition = "lens";
    const Block block{
        .name = "camera",
        .keys = {optional("lens", object(lens), ""), optional("spare", list(object(lens)), "")}};
    const json schema = json::parse(schema_text("", block));
    EXPECT_EQ(schema["properties"]["lens"], json::parse(R"({"$ref": "#/$defs/lens"})"));
    EXPECT_EQ(schema["properties"]["spare"]["items"], json::parse(R"({"$ref": "#/$defs/lens"})"));
    EXPECT_TRUE(schema["$defs"]["lens"]["properties"].contains("maker"));
    std::vector<std::string> names;
    for (const Block* one : blocks_of(block)) names.push_back(one->name);
    EXPECT_EQ(names, (std::vector<std::string>{"camera", "lens"}));
}

TEST(GrammarReader, GivesValuesDefaultsAndNothingForWhatIsNotSound) {
    const Block lens = lens_block();
    const Node node = parsed(R"({"maker": 7, "blades": 33, "coating": "multi", "focus_distance": "50 cm",
                                 "notes": ["a", 1]})");
    const Reader reader(node, lens);
    EXPECT_EQ(reader.text("maker"), "") << "it is no string";
    EXPECT_EQ(reader.integer("blades"), 6) << "33 are too many";
    EXPECT_FALSE(reader.has("blades"));
    EXPECT_EQ(reader.text("coating"), "multi");
    EXPECT_EQ(reader.choice("coating"), 2u);
    EXPECT_EQ(reader.components("focus_distance"), std::vector<double>{0.5});
    EXPECT_EQ(std::get<double>(*reader.value("focus_distance")), 0.5);
    EXPECT_EQ(reader.texts("notes"), std::vector<std::string>{"a"});
    const Node empty = parsed("{}");
    EXPECT_EQ(Reader(empty, lens).components("focus_distance"), std::vector<double>{5});
    EXPECT_EQ(Reader(empty, lens).choice("coating"), 1u);
    EXPECT_EQ(Reader(empty, lens).find("notes"), nullptr);
}

TEST(GrammarReader, GoesIntoObjectsListsAndMaps) {
    const Block block{
        .name = "kit",
        .keys = {optional("lens", object(lens_block()), ""), optional("list", list(object(lens_block())), ""),
                 optional("map", map(object(lens_block())), "")}};
    const Node node =
        parsed(R"({"lens": {"blades": 1}, "list": [0, {"blades": 2}], "map": {"wide": {"blades": 3}}})");
    const Reader reader(node, block);
    EXPECT_EQ(reader.object("lens")->integer("blades"), 1);
    ASSERT_EQ(reader.objects("list").size(), 1u);
    EXPECT_EQ(reader.objects("list")[0].integer("blades"), 2);
    EXPECT_EQ(reader.objects("list")[0].index(), 1u);
    ASSERT_EQ(reader.named("map").size(), 1u);
    EXPECT_EQ(reader.named("map")[0].member->key, "wide");
    EXPECT_EQ(reader.named("map")[0].reader.integer("blades"), 3);
}

TEST(GrammarReader, ReadsValuesByFrame) {
    const Block block{.name = "camera", .keys = {field(focus_distance(), {.animated = true})}};
    const Node node =
        parsed(R"({"focus_distance": {"keys": {"10": 2, "1": "50 cm"}, "interpolation": "smooth"}})");
    const Keyed value = Reader(node, block).keyed("focus_distance");
    EXPECT_EQ(value.frames, (std::vector<double>{1, 10}));
    EXPECT_EQ(value.values, (std::vector<std::vector<double>>{{0.5}, {2}}));
    EXPECT_EQ(interpolation_names()[value.interpolation], "smooth");
}

TEST(GrammarTable, StandsInTheMarkedRegionsOfAPage) {
    const Block lens = lens_block();
    const Tables tables = tables_of({{"kit", &lens}, {"bag", &lens}});
    EXPECT_EQ(tables.size(), 1u) << "a block that two documents have in common";
    std::vector<std::string> faults;
    const std::string page = "# Kit\n<!-- made by aftershade docs: kit.lens -->\nold\n<!-- end -->\nMore.\n";
    const std::string expected = "# Kit\n<!-- made by aftershade docs: kit.lens -->\n" +
                                 table_of(lens_block()) + "<!-- end -->\nMore.\n";
    EXPECT_EQ(with_tables(page, tables, faults), expected);
    EXPECT_EQ(with_tables(expected, tables, faults), expected);
    EXPECT_EQ(faults, Lines{});
    with_tables("<!-- made by aftershade docs: kit.lense -->\n<!-- end -->\n", tables, faults);
    with_tables("<!-- made by aftershade docs: kit.lens -->\n", tables, faults);
    EXPECT_EQ(faults, (Lines{"no table is named 'kit.lense'; did you mean 'kit.lens'?",
                             "a region begins that does not end in '<!-- end -->'"}));
}

}  // namespace
}  // namespace aftershade::grammar
