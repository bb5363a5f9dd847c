#include "framework/look/look.h"

#include <gtest/gtest.h>

#include <sstream>

#include "framework/look/look_grammar.h"

namespace aftershade {
namespace {

struct Parsed {
    std::optional<Look> look;
    std::string faults;
};

Parsed parse(const std::string& text) {
    Diagnostics diagnostics;
    Parsed parsed;
    if (const auto node = parse_document(text, "look", diagnostics))
        parsed.look = parse_look(*node, diagnostics);
    std::ostringstream out;
    diagnostics.print(out);
    parsed.faults = out.str();
    return parsed;
}

TEST(Look, ReadsEveryFieldOfAStep) {
    const Parsed parsed = parse(R"({ "$schema": "look.schema.json", "aftershade": 1, "steps": [
        // Comments are accepted.
        { "effect": "bokeh", "name": "lens", "enabled": false, "preset": "fast",
          "params": { "taps": 9, "shape": "square" },
          "in": { "depth": "capture.depth", "color": "other.color" } } ] })");
    EXPECT_EQ(parsed.faults, "");
    ASSERT_TRUE(parsed.look);
    EXPECT_EQ(parsed.look->file, "look");
    ASSERT_EQ(parsed.look->steps.size(), 1u);
    const LookStep& step = parsed.look->steps[0];
    EXPECT_EQ(step.effect, "bokeh");
    EXPECT_EQ(step.name, "lens");
    EXPECT_FALSE(step.enabled);
    EXPECT_EQ(step.preset, "fast");
    ASSERT_EQ(step.params.size(), 2u);
    EXPECT_EQ(step.params[1].key, "shape");
    ASSERT_EQ(step.wiring.size(), 2u);
    EXPECT_EQ(step.wiring[0].input, "depth");
    EXPECT_EQ(step.wiring[0].source, "capture");
    EXPECT_EQ(step.wiring[0].output, "depth");
    EXPECT_EQ(step.wiring[1].source, "other");
    EXPECT_EQ(step.place.line, 3);
}

TEST(Look, NamesAStepAfterItsEffectUnlessItSaysOtherwise) {
    const Parsed parsed =
        parse(R"({ "aftershade": 1, "steps": [ { "effect": "a" }, { "effect": "a", "name": "b" } ] })");
    EXPECT_EQ(parsed.faults, "");
    EXPECT_EQ(parsed.look->steps[0].name, "a");
    EXPECT_EQ(parsed.look->steps[1].name, "b");
    EXPECT_TRUE(parsed.look->steps[0].enabled);
}

TEST(Look, WarnsOfALookWithoutSteps) {
    const Parsed parsed = parse(R"({ "aftershade": 1, "steps": [] })");
    EXPECT_EQ(parsed.faults, "look:1:29: warning: the look has no steps: frames pass through\n");
    EXPECT_TRUE(parsed.look);
}

TEST(Look, RefusesANameThatWiringCannotTellFromTheCapture) {
    EXPECT_EQ(parse(R"({ "aftershade": 1, "steps": [ { "effect": "a", "name": "capture" } ] })").faults,
              "look:1:31: error: a step cannot be named 'capture': wiring uses this name for the capture\n");
}

TEST(Look, RefusesANameThatASetOrATapCouldNotSpell) {
    for (const char* name : {"a.b", "a/b", "A", "9a", "", " "}) {
        const Parsed parsed = parse(R"({ "aftershade": 1, "steps": [ { "effect": "a", "name": ")" +
                                    std::string(name) + "\" } ] }");
        EXPECT_NE(parsed.faults.find("must be snake_case"), std::string::npos)
            << "'" << name << "': " << parsed.faults;
    }
}

TEST(Look, ReportsTwoStepsOfOneNameBesideOtherFaults) {
    const Parsed parsed = parse(
        "{ \"aftershade\": 1, \"steps\": [\n{ \"effect\": \"a\", \"parms\": 1 },\n{ \"effect\": \"a\" } ] }");
    EXPECT_EQ(
        parsed.faults,
        "look:2:18: error: the step has no key 'parms'; did you mean 'params'?\n"
        "look:3:1: error: a second step named 'a'; give it a 'name' of its own (the first is at look:2:1)\n");
}

TEST(Look, DoesNotTakeTwoStepsWithoutEffectForTwoOfOneName) {
    EXPECT_EQ(parse("{ \"aftershade\": 1, \"steps\": [ {},\n{} ] }").faults,
              "look:1:31: error: the step has no 'effect'\nlook:2:1: error: the step has no 'effect'\n");
}

TEST(Look, RefusesEmptyWordsWhereSomethingMustBeNamed) {
    EXPECT_EQ(parse(R"({ "aftershade": 1, "steps": [ { "effect": "" } ] })").faults,
              "look:1:43: error: 'effect' is empty: it is the id of an effect\n");
    EXPECT_EQ(parse(R"({ "aftershade": 1, "steps": [ { "effect": "a", "mask": { "role": "" } } ] })").faults,
              "look:1:66: error: 'role' is empty\n");
    EXPECT_EQ(parse(R"({ "aftershade": 1, "steps": [ { "effect": "a", "mask": { "file": "" } } ] })").faults,
              "look:1:66: error: 'file' is empty\n");
}

Parsed parse_masked(const std::string& objects) {
    return parse(R"({ "aftershade": 1, "steps": [ { "effect": "a", "mask": { "object": )" + objects +
                 " } } ] }");
}

TEST(Look, ReadsTheObjectsOfAMask) {
    const Parsed parsed = parse_masked(R"([2, "3-7,9", "Wheel"])");
    EXPECT_EQ(parsed.faults, "");
    const std::vector<TableKey> keys = {{2, 2, ""}, {3, 7, ""}, {9, 9, ""}, {0, 0, "Wheel"}};
    EXPECT_EQ(parsed.look->steps.at(0).mask->objects, keys);
    EXPECT_EQ(parse_masked(R"("1-8")").look->steps.at(0).mask->objects, (std::vector<TableKey>{{1, 8, ""}}));
}

TEST(Look, SaysWhatIsWrongWithTheObjectsOfAMask) {
    EXPECT_EQ(
        parse_masked(R"([2, "7-3", -1, true])").faults,
        "look:1:72: error: the mask: '7-3' is not a range of ids; write \"3-7,9\", each from 0 to 4294967295 "
        "and rising\n"
        "look:1:79: error: the mask: -1 is not an object's id, a number from 0 to 4294967295\n"
        "look:1:83: error: the mask: expected an object's id, a range of ids such as \"3-7\" or a name\n");
    EXPECT_EQ(parse_masked("[]").faults, "look:1:68: error: the mask's 'object' names no object\n");
}

TEST(Look, RefusesAMaskOfMoreObjectsThanItHolds) {
    const auto ids = [](std::size_t count) {
        std::string list;
        for (std::size_t i = 0; i < count; ++i) list += (list.empty() ? "" : ", ") + std::to_string(2 * i);
        return "[" + list + "]";
    };
    EXPECT_EQ(parse_masked(ids(kMaxMaskObjects)).faults, "");
    EXPECT_EQ(
        parse_masked(ids(kMaxMaskObjects + 1)).faults,
        "look:1:68: error: the mask names 1001 ids, ranges and names; the limit is 1000 (write ids that "
        "follow one another as a range, \"3-7\", or give the mask as a picture: 'role' or 'file')\n");
}

TEST(Look, ReportsAFieldOfTheWrongType) {
    EXPECT_EQ(
        parse("{ \"aftershade\": 1, \"steps\": [\n"
              "{ \"effect\": \"a\", \"enabled\": 1, \"preset\": 2, \"params\": [], \"in\": \"x\" },\n7 ] }")
            .faults,
        "look:2:29: error: 'enabled' must be true or false, not an integer\n"
        "look:2:42: error: 'preset' must be a string, not an integer\n"
        "look:2:55: error: 'params' must be an object, not an array\n"
        "look:2:65: error: 'in' must be an object, not a string\n"
        "look:3:1: error: the step must be an object, not an integer\n");
}

}  // namespace
}  // namespace aftershade
