// The schemas against a real validator: what is shipped is valid, and what is broken is refused by the schema
// and by the program alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kRoot = AFTERSHADE_SOURCE_DIR;

// Draft202012Validator of python3-jsonschema. Reads {"schemas": {...}, "documents": [{"schema", "document"}]}
// and prints one line for each: "valid", or the fault.
constexpr const char* kValidator = R"py(
import json, sys
from jsonschema import Draft202012Validator
task = json.load(open(sys.argv[1]))
validators = {}
for name, schema in task["schemas"].items():
    Draft202012Validator.check_schema(schema)
    validators[name] = Draft202012Validator(schema)
for entry in task["documents"]:
    fault = next(iter(validators[entry["schema"]].iter_errors(entry["document"])), None)
    print("valid" if fault is None else "refused: " + fault.message.replace("\n", " ")[:300])
)py";

struct Document {
    std::string schema;
    std::string name;
    json content;
};

class Schemas : public testing::Test {
protected:
    void SetUp() override {
        Command probe({"/usr/bin/python3", "-c", "import jsonschema; jsonschema.Draft202012Validator"},
                      folder_.path());
        if (probe.wait().exit_code != 0)
            GTEST_SKIP() << "SKIPPED: /usr/bin/python3 has no jsonschema (python3-jsonschema)";
    }

    json schema(const std::string& name) {
        const CommandResult result = run_aftershade({"schema", name}, folder_.path());
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out);
    }

    std::vector<std::string> verdicts(const std::vector<Document>& documents) {
        json task = {{"schemas", json::object()}, {"documents", json::array()}};
        for (const char* name : {"look", "capture", "effect", "module", "scene", "scattering_profile",
                                 "profile", "golden", "case"})
            task["schemas"][name] = schema(name);
        for (const Document& document : documents)
            task["documents"].push_back({{"schema", document.schema}, {"document", document.content}});
        write_text(folder_ / "task.json", task.dump());
        Command validator({"/usr/bin/python3", "-c", kValidator, (folder_ / "task.json").string()},
                          folder_.path());
        const CommandResult result = validator.wait();
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return lines_of_text(result.out);
    }

    static json parsed(const std::string& text) { return json::parse(text, nullptr, true, true); }
    TemporaryFolder folder_;
};

/// effects/<id>/cases/<case>.json; <case>.<output>.<frame>.json is a golden's sidecar.
bool is_case(const fs::path& path) {
    return path.parent_path().filename() == "cases" && path.stem().string().find('.') == std::string::npos;
}

TEST_F(Schemas, TakeEveryShippedDocument) {
    std::vector<Document> documents;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot)) {
        const fs::path path = entry.path();
        const std::string text = path.lexically_relative(kRoot).string();
        if (path.extension() != ".json" || text.starts_with("build") || text.starts_with(".")) continue;
        const std::string kind = path.filename() == "effect.json"           ? "effect"
                                 : path.filename() == "module.json"         ? "module"
                                 : path.filename() == "capture.json"        ? "capture"
                                 : path.filename() == "scene.json"          ? "scene"
                                 : path.filename() == "golden.json"         ? "golden"
                                 : is_case(path)                            ? "case"
                                 : path.parent_path().filename() == "looks" ? "look"
                                 : path.filename() == "profile.schema.json" ? ""
                                 : text.starts_with("profiles/scattering/") ? "scattering_profile"
                                 : text.starts_with("profiles/")            ? "profile"
                                                                            : "";
        if (!kind.empty()) documents.push_back({kind, text, parsed(read_text(path))});
    }
    ASSERT_GE(documents.size(), 28U);
    const std::vector<std::string> seen = verdicts(documents);
    ASSERT_EQ(seen.size(), documents.size());
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], "valid") << documents[i].name;
}

TEST_F(Schemas, OfEffectsModulesAndProfilesAreThoseThatArePublished) {
    const CommandResult result = run_aftershade({"schema", "effect"}, folder_.path());
    EXPECT_EQ(result.out, read_text(kRoot / "effects/effect.schema.json"))
        << "run: aftershade schema effect > effects/effect.schema.json";
    EXPECT_EQ(run_aftershade({"schema", "module"}, folder_.path()).out,
              read_text(kRoot / "glsl/module.schema.json"))
        << "run: aftershade schema module > glsl/module.schema.json";
    EXPECT_EQ(run_aftershade({"schema", "profile"}, folder_.path()).out,
              read_text(kRoot / "profiles/profile.schema.json"))
        << "run: aftershade schema profile > profiles/profile.schema.json";
    EXPECT_EQ(run_aftershade({"schema", "scattering_profile"}, folder_.path()).out,
              read_text(kRoot / "profiles/scattering/profile.schema.json"))
        << "run: aftershade schema scattering_profile > profiles/scattering/profile.schema.json";
}

TEST_F(Schemas, TakeEveryFormOfAValue) {
    std::vector<Document> documents;
    for (const char* value :
         {"2", "\"2.4 m\"", "\"240cm\"", R"({"keys": {"1": 2, "24": "3 m"}, "interpolation": "step"})",
          R"({"keys": {"1": {"value": 2, "interpolation": [0.4, 0, 0.6, 1]}, "24": {"value": "3 m"}}})",
          R"({"var": "focus"})", R"({"from": "camera.far"})", R"({"from": "depth", "uv": [0.5, 0.5]})",
          R"({"from": "depth", "object": "Wheel"})"})
        documents.push_back({"look", value,
                             parsed(R"({"aftershade": 1, "vars": {"focus": 2}, "steps": [
            {"effect": "bokeh", "preset": "fast", "mix": {"keys": {"1": 0, "9": 1}}, "mask": {"object": [2, "Wheel", "3-7,9"]},
             "in": {"depth": "capture.depth"}, "params": {"focus_distance": )" +
                                    std::string(value) + "}}]}")});
    const std::vector<std::string> seen = verdicts(documents);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], "valid") << documents[i].name;
}

const std::string kLook = R"({"aftershade": 1, "steps": [)";
std::string step(const std::string& members) {
    return kLook + R"({"effect": "bokeh", )" + members + "}]}";
}
std::string capture(const std::string& members) {
    return R"({"aftershade": 1, "frames": "in_####.exr", "range": "1", )" + members + "}";
}
std::string effect(const std::string& before, const std::string& after) {
    std::string text = R"({"aftershade": 1, "id": "odd", "version": "1.0.0", "summary": "Odd.",
        "inputs": {"color": {"role": "color"}}, "outputs": {"color": {"role": "color"}},
        "params": {"gain": {"type": "float", "unit": "m", "default": 1, "min": 0, "doc": "Gain."}},
        "textures": {"tiles": {"format": "r32f", "tile": 8, "doc": "Tiles."}},
        "passes": [{"name": "a", "shader": "main.frag", "reads": ["color"], "writes": ["tiles"]},
                   {"name": "b", "shader": "main.frag", "reads": [{"color": "linear"}, "tiles"], "writes": ["color"]}]})";
    const std::size_t at = text.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return text.replace(at, before.size(), after);
}

std::vector<std::pair<std::string, std::string>> broken_documents() {
    const auto look = [](const std::string& text) {
        return std::pair<std::string, std::string>("look", text);
    };
    const auto cap = [](const std::string& members) {
        return std::pair<std::string, std::string>("capture", capture(members));
    };
    // A key that stands twice would be another fault.
    const auto scene = [](const std::string& members) {
        std::string text = R"({"aftershade": 1, )" + members;
        for (const char* rest : {R"("camera": {})", R"("objects": [])"})
            if (members.find(std::string(rest).substr(0, std::string(rest).find(':'))) == std::string::npos)
                text += ", " + std::string(rest);
        return std::pair<std::string, std::string>("scene", text + "}");
    };
    const auto eff = [](const std::string& before, const std::string& after) {
        return std::pair<std::string, std::string>("effect", effect(before, after));
    };
    return {
        look(R"({"steps": []})"),
        look(R"({"aftershade": 2, "steps": []})"),
        look(R"({"aftershade": 1})"),
        look(R"({"aftershade": 1, "steps": [], "step": []})"),
        look(kLook + R"({"effect": "bokehh"}]})"),
        look(kLook + R"({"params": {}}]})"),
        look(step(R"("parms": {})")),
        look(step(R"("enabled": "yes")")),
        look(step(R"("preset": "slow")")),
        look(step(R"("params": {"focus_dist": 2})")),
        look(step(R"("params": {"f_number": 0.02})")),
        look(step(R"("params": {"f_number": "2 m"})")),
        look(step(R"("params": {"focus_distance": "2 kg"})")),
        look(step(R"("params": {"focus_distance": "two"})")),
        look(step(R"("params": {"shape": "heptagon"})")),
        look(step(R"("params": {"taps": 2.5})")),
        look(step(R"("params": {"focus_distance": {"keys": {}}})")),
        look(step(R"("params": {"focus_distance": {"keys": {"one": 2}}})")),
        look(step(R"("params": {"focus_distance": {"keys": {"1": 2}, "interpolation": "cubic"}})")),
        look(step(
            R"("params": {"focus_distance": {"keys": {"1": {"value": 2, "interpolation": [0, 0, 2, 1]}}}})")),
        look(step(R"("params": {"focus_distance": {"keys": {"1": {"interpolation": "step"}}}})")),
        look(step(R"("params": {"shape": {"keys": {"1": "square"}}})")),
        look(step(R"("params": {"focus_distance": {"from": "camera.f_number"}})")),
        look(step(R"("params": {"f_number": {"from": "depth", "uv": [0.5, 0.5]}})")),
        look(step(R"("params": {"focus_distance": {"from": "depth", "uv": [0.5, 2]}})")),
        look(step(R"("in": {"light": "capture.color"})")),
        look(step(R"("in": {"depth": "depth"})")),
        look(step(R"("mix": 2)")),
        look(step(R"("mask": {"role": "mask", "object": 2})")),
        look(step(R"("mask": {"object": []})")),
        look(step(R"("name": "Big")")),
        look(step(R"("name": "capture")")),
        look(kLook + R"({"use": "a.json", "effect": "bokeh"}]})"),
        cap(R"("fps": 0)"),
        cap(R"("fsp": 24)"),
        cap(R"("cuts": ["3"])"),
        cap(R"("subframes": 0)"),
        cap(R"("color_space": "srgb")"),
        cap(R"("files": {"colour": "a.exr"})"),
        cap(R"("camera": {"focal_length": "50 kg"})"),
        cap(R"("camera": {"focal": 50})"),
        cap(R"("channels": {"velocity": {"x": "u", "y": "v", "delta": "next-cur"}})"),
        cap(R"("channels": {"depth": {"channels": ["Z"], "kind": "round"}})"),
        scene(R"("objcets": [])"),
        scene(R"("size": [0, 20])"),
        scene(R"("cuts": [2, 2])"),
        scene(R"("camera": {"blades": 2})"),
        scene(R"("camera": {"f_number": {"keys": {"1": 2}}})"),
        scene(R"("camera": {"roll": {"keys": {"one": 2}}})"),
        scene(R"("camera": {"focal_length": "50 kg"})"),
        scene(R"("materials": {"a": {"albedo": 2}})"),
        scene(R"("materials": {"a": {"albedo": {"checker": [0, 1]}}})"),
        scene(R"("materials": {"a": {}}, "objects": [{"shape": "disk", "radius": 1}])"),
        scene(R"("meshes": {"a": {"file": "a.glb", "height_field": {"size": [1, 1]}}})"),
        scene(R"("objects": [{"shape": "plane", "size": [1, 1], "radius": 1}])"),
        scene(R"("lights": [{"type": "point", "position": [0, 1, 0], "pattern": {"type": "edge"}}])"),
        eff(R"("version": "1.0.0")", R"("version": "1")"),
        eff(R"("summary": "Odd.",)", ""),
        eff(R"("unit": "m")", R"("unit": "yards")"),
        eff(R"("type": "float")", R"("type": "double")"),
        eff(R"("default": 1, )", ""),
        eff(R"("format": "r32f")", R"("format": "rgb32f")"),
        eff(R"("tile": 8)", R"("tile": 1)"),
        eff(R"({"color": "linear"})", R"({"color": "cubic"})"),
        eff(R"("name": "b")", R"("name": "b", "blend": "over")"),
        eff(R"("name": "b")", R"("name": "b", "kind": "mesh")"),
        eff(R"({"role": "color"})", R"({"role": "colour"})"),
    };
}

TEST_F(Schemas, RefuseWhatTheProgramRefuses) {
    write_capture(make_capture({.width = 8, .height = 4}), folder_ / "in_0001.exr");
    fs::create_directories(folder_ / "odd");
    write_text(folder_ / "odd/main.frag", "#version 450 core\n#include <pass>\nvoid main() {}\n");
    const auto broken = broken_documents();
    ASSERT_GE(broken.size(), 30U);
    std::vector<Document> documents;
    for (const auto& [kind, text] : broken) documents.push_back({kind, text, parsed(text)});
    const std::vector<std::string> seen = verdicts(documents);
    ASSERT_EQ(seen.size(), broken.size());
    for (std::size_t i = 0; i < broken.size(); ++i) {
        const auto& [kind, text] = broken[i];
        EXPECT_TRUE(seen[i].starts_with("refused")) << "the schema takes " << text;
        CommandResult result;
        if (kind == "look") {
            write_text(folder_ / "broken.json", text);
            result = run_aftershade({"check", "broken.json"}, folder_.path());
            EXPECT_EQ(result.exit_code, 1) << "the program takes " << text << result.err;
        } else if (kind == "scene") {
            write_text(folder_ / "scene.json", text);
            result = run_aftershade({"render", "scene.json", "-o", "out"}, folder_.path());
            EXPECT_EQ(result.exit_code, 2) << "the program takes " << text << result.err;
        } else if (kind == "capture") {
            write_text(folder_ / "capture.json", text);
            result = run_aftershade({"inspect", "capture.json"}, folder_.path());
            EXPECT_EQ(result.exit_code, 2) << "the program takes " << text << result.err;
        } else {
            write_text(folder_ / "odd/effect.json", text);
            result = run_aftershade({"check", "odd", "--no-gl"}, folder_.path());
            EXPECT_EQ(result.exit_code, 1) << "the program takes " << text << result.err;
        }
        EXPECT_NE(result.err.find("error"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace aftershade::test
