#include "framework/serve/look_edits.h"

#include <barrier>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/effect/registry.h"
#include "framework/serve/look_model.h"
#include "tests/temporary_folder.h"

namespace aftershade::serve {
namespace {

using Json = nlohmann::ordered_json;
using test::TemporaryFolder;

const std::string kLook = R"(// made by hand
{ "aftershade": 1,
  /* the lens first */
  "steps": [
    { "effect": "dof",   // as the camera focuses
      "params": { "f_number": 2.80,   // wide open
                  "focus_distance": "3 m" } },
    // then to a screen
    { "effect": "view_transform", "params": {"exposure":0.5} }
  ]
}
)";

Json read(const std::string& text) {
    return Json::parse(text, nullptr, true, true);
}

TEST(LookEdits, ChangeTheBytesOfTheValueAlone) {
    const std::string text = edited(kLook, {{"op", "set"}, {"step", 0}, {"param", "f_number"}, {"value", 4}});
    std::string expected = kLook;
    expected.replace(expected.find("2.80"), 4, "4");
    EXPECT_EQ(text, expected);
}

TEST(LookEdits, LeaveAnEqualValueInItsAuthorsSpelling) {
    EXPECT_EQ(edited(kLook, {{"op", "set"}, {"step", 0}, {"param", "f_number"}, {"value", 2.8}}), kLook);
}

TEST(LookEdits, ChangeAnObjectOfSeveralLinesMemberByMember) {
    const std::string text = R"({ "aftershade": 1, "steps": [
  { "effect": "dof", "params": { "focus_distance": {
      "keys": {
        "1": "2 m", // Ball
        "24": "5.0 m" // Suzanne
      },
      "interpolation": "smooth" // gently
  } } } ] }
)";
    const auto with = [&](const char* value) {
        return edited(
            text, {{"op", "set"}, {"step", 0}, {"param", "focus_distance"}, {"value", Json::parse(value)}});
    };
    const auto replaced = [&](const std::string& before, const std::string& after) {
        std::string expected = text;
        return expected.replace(expected.find(before), before.size(), after);
    };
    EXPECT_EQ(with(R"({"keys": {"1": "3 m", "24": "5.0 m"}, "interpolation": "smooth"})"),
              replaced("\"2 m\"", "\"3 m\""));
    EXPECT_EQ(with(R"({"keys": {"1": "2 m", "12": 4, "24": "5.0 m"}, "interpolation": "smooth"})"),
              replaced("\"24\":", "\"12\": 4,\n        \"24\":"))
        << "in the order of the frames";
    EXPECT_EQ(with(R"({"keys": {"1": "2 m"}, "interpolation": "smooth"})"),
              replaced("\"2 m\", // Ball\n        \"24\": \"5.0 m\" // Suzanne\n", "\"2 m\" // Ball\n"));
    const std::string eased = with(
        R"({"keys": {"1": {"value": "2 m", "interpolation": "step"}, "24": "5.0 m"}, "interpolation": "smooth"})");
    EXPECT_EQ(eased, replaced("\"2 m\"", R"({ "value": "2 m", "interpolation": "step" })"));
    const std::string moved = with(R"({"keys": {"30": "5.0 m"}})");
    EXPECT_EQ(read(moved)["steps"][0]["params"]["focus_distance"],
              Json::parse(R"({"keys": {"30": "5.0 m"}})"));
}

TEST(LookEdits, GiveAValueThatIsTooLongForALineALineForEachPart) {
    const std::string text = "{ \"aftershade\": 1,\n  \"steps\": [\n    { \"effect\": \"dof\" }\n  ]\n}\n";
    const Json keys = Json::parse(R"({ "keys": {
        "1": { "value": { "from": "depth", "object": "Suzanne" }, "interpolation": [0.4, 0, 0.6, 1] },
        "24": { "from": "depth", "object": "Ball" } }, "interpolation": "smooth" })");
    const std::string set =
        edited(text, {{"op", "set"}, {"step", 0}, {"param", "focus_distance"}, {"value", keys}});
    EXPECT_EQ(read(set)["steps"][0]["params"]["focus_distance"], keys);
    EXPECT_NE(set.find("\n          \"24\": { \"from\": \"depth\", \"object\": \"Ball\" }\n"),
              std::string::npos)
        << set;
    std::istringstream lines(set);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120) << line;
}

TEST(LookEdits, PutANewKeyAfterTheLastOneInItsOwnForm) {
    const std::string text =
        edited(kLook, {{"op", "set"}, {"step", 0}, {"param", "quality"}, {"value", "high"}});
    EXPECT_NE(text.find("\"focus_distance\": \"3 m\",\n                  \"quality\": \"high\" } },"),
              std::string::npos)
        << text;
    EXPECT_NE(edited(kLook, {{"op", "set"}, {"step", 1}, {"param", "curve"}, {"value", "aces"}})
                  .find("{\"exposure\":0.5, \"curve\": \"aces\"}"),
              std::string::npos);
}

TEST(LookEdits, TakeAKeyOutWithItsLineAndItsComment) {
    const std::string text =
        edited(kLook, {{"op", "set"}, {"step", 0}, {"param", "focus_distance"}, {"value", nullptr}});
    EXPECT_EQ(read(text)["steps"][0]["params"], (Json{{"f_number", 2.8}}));
    EXPECT_NE(text.find("// wide open"), std::string::npos) << text;
}

TEST(LookEdits, KeepEveryCommentWhenStepsChangePlaces) {
    const std::string text = edited(kLook, {{"op", "move"}, {"step", 0}, {"to", 1}});
    EXPECT_EQ(read(text)["steps"][0]["effect"], "view_transform");
    for (const char* comment : {"// made by hand", "/* the lens first */", "// as the camera focuses",
                                "// wide open", "// then to a screen"})
        EXPECT_NE(text.find(comment), std::string::npos) << comment;
    EXPECT_EQ(edited(text, {{"op", "move"}, {"step", 0}, {"to", 1}}), kLook);
}

TEST(LookEdits, RefuseWhatIsNoEdit) {
    for (const Json& edit :
         {Json{{"op", "set"}, {"step", 2}, {"param", "a"}, {"value", 1}}, Json{{"op", "erase"}, {"step", 0}},
          Json{{"op", "move"}, {"step", 0}, {"to", -1}}, Json{{"op", "set"}, {"step", 0}, {"value", 1}},
          Json(7)})
        EXPECT_THROW(edited(kLook, edit), Error) << edit;
}

TEST(LookEdits, OfATextThatIsNotJsonAreRefused) {
    // A control character in a key, as the Text tab may leave one.
    const std::string text = "{ \"\x01key\": 5, \"steps\": [ { \"effect\": \"dof\" } ] }";
    EXPECT_THROW(edited(text, {{"op", "remove"}, {"step", 0}}), Error);
}

TEST(LookEdits, AddAStepBesideOneThatIsNotAnObject) {
    const std::string text =
        edited(R"({ "aftershade": 1, "steps": [7] })", {{"op", "add"}, {"at", 0}, {"effect", "dof"}});
    EXPECT_EQ(Json::parse(text)["steps"], Json::parse(R"([{"effect": "dof"}, 7])"));
}

TEST(LookEdits, AddChangeAndRemoveVariablesBesideTheSteps) {
    const auto var = [](const char* name, Json value) {
        return Json{{"op", "var"}, {"name", name}, {"value", std::move(value)}};
    };
    const std::string one = edited(kLook, var("far", "6 m"));
    std::string expected = kLook;
    const std::string first = R"("vars": { "far": "6 m" },)"
                              "\n  ";
    const std::size_t steps = expected.find("\"steps\"");
    expected.insert(steps, first);
    EXPECT_EQ(one, expected);
    const std::string two = edited(one, var("warm", 0.25));
    EXPECT_EQ(read(two)["vars"], Json::parse(R"({"far": "6 m", "warm": 0.25})"));
    EXPECT_EQ(edited(two, var("far", "7 m")).size(), two.size());
    EXPECT_EQ(edited(two, var("warm", nullptr)), one);
    EXPECT_EQ(edited(one, var("far", nullptr)), kLook) << "the list that the page made goes again";
    EXPECT_EQ(edited(kLook, var("none", nullptr)), kLook);
    EXPECT_THROW(edited(kLook, Json::parse(R"({"op": "var", "name": 3, "value": 1})")), Error);
    EXPECT_THROW(edited(kLook, Json::parse(R"({"op": "var", "name": "a"})")), Error);
}

/// Makes edits, and makes the same change to a document that has no text.
class RandomEdits {
public:
    explicit RandomEdits(unsigned seed) : random_(seed) {}

    Json next(Json& document) {
        Json& steps = document["steps"];
        const int count = int(steps.size());
        const int kind = count < 2 ? 6 : pick(9);
        const int step = count > 0 ? pick(count) : 0;
        if (kind == 6 && count < 12) return add(steps);
        if (kind == 7 && count > 2) return remove(steps, step);
        if (kind == 8) return move(steps, step, pick(count));
        if (kind == 5) return enable(steps[std::size_t(step)], step);
        if (kind == 4) return mix(steps[std::size_t(step)], step);
        return set(steps[std::size_t(step)], step);
    }

private:
    int pick(int count) { return int(random_() % unsigned(count)); }

    Json add(Json& steps) {
        const int at = pick(int(steps.size()) + 1);
        Json step = {{"effect", "view_transform"}};
        const auto has = [&](const std::string& name) {
            for (const Json& one : steps)
                if (one.value("name", one["effect"].get<std::string>()) == name) return true;
            return false;
        };
        if (has("view_transform"))
            for (int n = 2; !step.contains("name"); ++n)
                if (const std::string name = "view_transform_" + std::to_string(n); !has(name))
                    step["name"] = name;
        steps.insert(steps.begin() + at, step);
        return {{"op", "add"}, {"at", at}, {"effect", "view_transform"}};
    }
    Json remove(Json& steps, int step) {
        steps.erase(std::size_t(step));
        return {{"op", "remove"}, {"step", step}};
    }
    Json move(Json& steps, int from, int to) {
        const Json step = steps[std::size_t(from)];
        steps.erase(std::size_t(from));
        steps.insert(steps.begin() + to, step);
        return {{"op", "move"}, {"step", from}, {"to", to}};
    }
    Json enable(Json& step, int index) {
        const bool is_on = pick(2) == 0;
        if (!is_on || step.contains("enabled")) step["enabled"] = is_on;
        return {{"op", "enable"}, {"step", index}, {"value", is_on}};
    }
    Json mix(Json& step, int index) {
        const Json value = pick(3) == 0 ? Json() : Json(pick(101) / 100.0);
        if (value.is_null()) step.erase("mix");
        else step["mix"] = value;
        return {{"op", "mix"}, {"step", index}, {"value", value}};
    }
    Json set(Json& step, int index) {
        const bool is_lens = step["effect"] == "dof";
        const std::string name = is_lens ? (pick(2) == 0 ? "f_number" : "focus_distance") : "exposure";
        const Json value = pick(4) == 0 ? Json() : Json(0.5 + pick(800) / 100.0);
        if (!value.is_null()) step["params"][name] = value;
        else if (step.contains("params")) step["params"].erase(name);
        return {{"op", "set"}, {"step", index}, {"param", name}, {"value", value}};
    }

    std::mt19937 random_;
};

/// An empty list of values says what none says, and where one comes back it may stand behind other keys.
nlohmann::json content_of(const Json& document) {
    nlohmann::json content = document;
    for (auto& step : content["steps"])
        if (step.contains("params") && step["params"].empty()) step.erase("params");
    return content;
}

std::shared_ptr<EffectRegistry> shipped_effects() {
    return std::make_shared<EffectRegistry>(
        std::vector<std::filesystem::path>{std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "effects"});
}

TEST(LookModel, HoldsTwoHundredRandomEditsAndUndoesThemToTheFirstByte) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        const TemporaryFolder folder;
        const std::filesystem::path path = folder / "look.json";
        write_text_file(path, kLook);
        LookModel model(path, shipped_effects, false);
        Json document = read(kLook);
        RandomEdits edits(seed);
        int changes = 0;
        for (int i = 0; i < 200; ++i) {
            const Json before = model.state({});
            const Json edit = edits.next(document);
            ASSERT_NO_THROW(model.edit(before["revision"], Json::array({edit}))) << edit;
            if (model.state({})["revision"] != before["revision"]) ++changes;
            const std::string text = model.text();
            ASSERT_EQ(content_of(read(text)), content_of(document))
                << "seed " << seed << ", edit " << i << " " << edit << "\n"
                << before["text"] << "\n"
                << text;
            ASSERT_EQ(model.state({})["text"], text);
        }
        EXPECT_GT(changes, 100);
        model.save();
        EXPECT_EQ(read_text_file(path, ErrorKind::usage), model.text());
        for (int i = 0; i < changes; ++i) model.undo();
        EXPECT_EQ(model.text(), kLook);
        EXPECT_THROW(model.undo(), Refusal);
        for (int i = 0; i < changes; ++i) model.redo();
        EXPECT_EQ(read_text_file(path, ErrorKind::usage), model.text());
    }
}

TEST(LookModel, NeverWritesWhereItOnlyReadsNorOverAnotherProgramsChange) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "look.json";
    write_text_file(path, kLook);
    const Json edits = Json::parse(R"([{"op": "set", "step": 0, "param": "f_number", "value": 4}])");
    LookModel reader(path, shipped_effects, true);
    reader.edit(1, edits);
    EXPECT_THROW(reader.save(), Refusal);
    LookModel writer(path, shipped_effects, false);
    writer.edit(1, edits);
    EXPECT_THROW(writer.edit(1, edits), Refusal) << "the revision is old";
    write_text_file(path, "{}");
    EXPECT_THROW(writer.save(), Refusal);
    EXPECT_EQ(read_text_file(path, ErrorKind::usage), "{}");
}

TEST(LookModel, NamesFilesOfItsFolderOnlyOnceItHasAName) {
    const TemporaryFolder folder;
    write_text_file(folder / "mask.png", "");
    LookModel model(folder / "untitled.json", shipped_effects, false, {}, LookModel::File::unnamed);
    const Json add = Json::parse(R"([{"op": "add", "at": 0, "effect": "vignette"}])");
    const Json mask = Json::parse(R"([{"op": "mask", "step": 0, "value": {"file": "mask.png"}}])");
    model.edit(1, add);
    EXPECT_THROW(model.edit(model.revision(), mask), Refusal);
    EXPECT_THROW(model.save(), Refusal);
    model.save("mine");
    EXPECT_NO_THROW(model.edit(model.revision(), mask));
    EXPECT_EQ(model.saved_path(), folder / "mine.json");
}

TEST(LookModel, LosesNoEditWhereTwoSaveAtOnce) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "look.json";
    for (int round = 0; round < 50; ++round) {
        write_text_file(path, kLook);
        LookModel first(path, shipped_effects, false), second(path, shipped_effects, false);
        std::barrier both(2);
        int saved = 0, refused = 0;
        std::string text;
        std::mutex mutex;
        const auto edit_and_save = [&](LookModel& model, int f_number) {
            model.edit(
                1, Json::array({{{"op", "set"}, {"step", 0}, {"param", "f_number"}, {"value", f_number}}}));
            both.arrive_and_wait();
            std::string why;
            try {
                model.save();
            } catch (const Refusal& refusal) {
                why = refusal.message;
            }
            const std::lock_guard lock(mutex);
            if (why.empty()) ++saved, text = model.text();
            else if (why.find("was changed by another program") != std::string::npos) ++refused;
        };
        {
            const std::jthread one([&] { edit_and_save(first, 4); });
            edit_and_save(second, 8);
        }
        ASSERT_EQ(std::pair(saved, refused), std::pair(1, 1)) << "round " << round;
        ASSERT_EQ(read_text_file(path, ErrorKind::usage), text);
    }
}

TEST(LookModel, TakesTheLastDrawnTextInThePlaceOfOneThatCannotBeDrawn) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "look.json";
    write_text_file(path, kLook);
    LookModel model(path, shipped_effects, false);
    const auto set = [&](int value) {
        model.edit(model.revision(),
                   Json::array({{{"op", "set"}, {"step", 0}, {"param", "f_number"}, {"value", value}}}));
        return model.text();
    };
    model.drawn(kLook, 1);
    set(4);  // replaced before a picture of it came
    const std::string last = set(8);
    const auto revision = model.revision();
    model.give_up(last, 1, {"it crashes", "view_transform"});
    EXPECT_GT(model.revision(), revision) << "pages read the fault";
    EXPECT_EQ(model.text(), last);
    const Json faults = model.state({})["faults"];
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0]["message"], "it crashes");
    EXPECT_EQ(faults[0]["line"], 9) << "of the step";
    ASSERT_TRUE(model.bound());
    EXPECT_EQ(model.bound()->text, kLook);
    model.undo();
    EXPECT_TRUE(model.state({})["faults"].empty());
    model.redo();
    EXPECT_EQ(model.state({})["faults"].size(), 1u);
    model.reload_effects();
    EXPECT_TRUE(model.state({})["faults"].empty()) << "another shader may be drawn";
}

TEST(LookModel, HasNoTextToDrawWhereTheOnlyOneCannotBeDrawn) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "look.json";
    write_text_file(path, kLook);
    LookModel model(path, shipped_effects, false);
    model.drawn(kLook, 1);
    model.reload_effects();
    model.give_up(kLook, 1, {"late"});
    EXPECT_TRUE(model.bound()) << "the effects were read again meanwhile";
    model.give_up(kLook, model.effects_revision(), {"it crashes"});
    EXPECT_FALSE(model.bound()) << "the shader that drew it before is no longer there";
    EXPECT_EQ(model.state({})["faults"].size(), 1u);
}

TEST(LookModel, KeepsTheLastLookWithoutFaultsAndSaysWhereTheFaultIs) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "look.json";
    write_text_file(path, kLook);
    LookModel model(path, shipped_effects, false);
    const auto good = model.bound();
    ASSERT_TRUE(good);
    model.edit(1, Json::parse(R"([{"op": "text", "value": "{\n  \"aftershade\": 1,\n  \"steps\": [ }"}])"));
    const Json faults = model.state({})["faults"];
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0]["line"], 3);
    EXPECT_EQ(model.bound(), good);
    model.undo();
    EXPECT_TRUE(model.state({})["faults"].empty());
}

}  // namespace
}  // namespace aftershade::serve
