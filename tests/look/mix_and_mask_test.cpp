// Mix and mask of a step, and the files, tables and frames that reach its shader.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "framework/capture/cryptomatte.h"
#include "framework/file/png_file.h"
#include "tests/file/png_chunks.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

/// Mix and mask of a step that paints everything white.
class MixAndMask : public testing::Test {
protected:
    MixAndMask() { effects_.add_color("white", "vec4(1.0)"); }
    static Capture scene() {
        SyntheticScene scene;
        scene.width = 20;
        scene.height = 10;
        scene.background = {0.25f, 0.5f, 0};
        scene.box = SyntheticBox{12, 2, 4, 4, 0, 0, 2.5f, {0.75f, 0.2f, 0.1f}};
        return make_capture(scene, 0);
    }
    Image run(const std::string& step) {
        Bench bench(effects_, look_of(step));
        return bench.color(scene());
    }
    EffectFolder effects_;
};

TEST_F(MixAndMask, MixGoesFromTheImageBeforeToTheImageMade) {
    EXPECT_EQ(run(R"({ "effect": "white", "mix": 0 })").at(1, 1, 0), 0.25f);
    EXPECT_EQ(run(R"({ "effect": "white", "mix": 1 })").at(1, 1, 0), 1.0f);
    EXPECT_FLOAT_EQ(run(R"({ "effect": "white", "mix": 0.5 })").at(1, 1, 0), 0.625f);
    EXPECT_FLOAT_EQ(run(R"({ "effect": "white", "mix": { "keys": { "-10": 0, "10": 1 } } })").at(1, 1, 0),
                    0.625f);
    Bench set(effects_, look_of(R"({ "effect": "white" })"), {{"white.mix=0.25"}, {}});
    EXPECT_FLOAT_EQ(set.color(scene()).at(1, 1, 0), 0.4375f);
}

/// No capture has an image of such a role, so there is none before the first step that makes one.
TEST_F(MixAndMask, MixesWhatStepsAloneOutputWithNothing) {
    for (const auto& [role, nothing] : {std::pair("foreground", 0.0f), {"light_change", 1.0f}}) {
        const auto image = [role = role](const char* name) {
            return fmt::format(R"("{}": {{ "role": "{}" }})", name, role);
        };
        effects_.add("makes",
                     fmt::format(R"("inputs": {{ "color": {{ "role": "color" }} }}, "outputs": {{ {} }},
                                    "passes": ["main"])",
                                 image("made")),
                     "void main() { out_made = vec4(3.0) + 0.0 * texelFetch(color, ivec2(0), 0); }\n");
        effects_.add("shows",
                     fmt::format(R"("inputs": {{ {} }}, "outputs": {{ "color": {{ "role": "color" }} }},
                                    "passes": ["main"])",
                                 image("made")),
                     "void main() { out_color = texelFetch(made, ivec2(gl_FragCoord.xy), 0); }\n");
        const Image half = run(R"({ "effect": "makes", "mix": 0.5 }, { "effect": "shows" })");
        EXPECT_FLOAT_EQ(half.at(1, 1, 0), 0.5f * (nothing + 3)) << role;
        EXPECT_FLOAT_EQ(half.at(1, 1, 3), 1.5f) << role;
    }
}

TEST_F(MixAndMask, AMaskIsARoleAnObjectOrAFile) {
    for (const char* mask : {R"({ "role": "mask" })", R"({ "object": 2 })", R"({ "object": [7, 2] })",
                             R"({ "object": 0, "invert": true })"}) {
        const Image image = run(std::string(R"({ "effect": "white", "mask": )") + mask + " }");
        EXPECT_EQ(image.at(1, 1, 0), 0.25f) << mask;
        EXPECT_EQ(image.at(13, 3, 0), 1.0f) << mask;
    }
    const TemporaryFolder folder;
    Image half(20, 10, 3);
    for (int y = 0; y < 10; ++y)
        for (int x = 10; x < 20; ++x)
            for (int c = 0; c < 3; ++c) half.at(x, y, c) = 1;
    write_png(folder / "right.png", half);
    const Image image =
        run(R"({ "effect": "white", "mask": { "file": ")" + (folder / "right.png").string() + "\" } }");
    EXPECT_EQ(image.at(1, 1, 0), 0.25f);
    EXPECT_EQ(image.at(18, 8, 0), 1.0f);
}

TEST_F(MixAndMask, ThatComeAsAPngOfAnotherSpaceSayThatItIsNotApplied) {
    const TemporaryFolder folder;
    Image half(20, 10, 1);
    std::ranges::fill(half.floats(), 0.5f);
    const std::string file = (folder / "half.png").string(), png = encode_png("", half);
    const std::string step = R"({ "effect": "white", "mask": { "file": ")" + file + "\" } }";
    write_text(file, png);
    EXPECT_EQ(Bound(effects_, look_of(step)).faults(), "");
    write_text(file, png_with_chunk(png, "gAMA", png_number(100000)));
    const std::string faults = Bound(effects_, look_of(step)).faults();
    EXPECT_NE(faults.find("warning: '" + file + "': its gAMA 1 is not applied"), std::string::npos) << faults;
    const Capture grey = make_capture({.width = 20, .height = 10, .background = {0.25f, 0.25f, 0.25f}});
    EXPECT_NEAR(Bench(effects_, look_of(step)).color(grey).at(1, 1, 0), 0.25f + 0.75f * 128 / 255, 1e-6f);
}

/// One row of a pixel for each id.
Capture capture_of_ids(const std::vector<std::uint32_t>& ids) {
    Capture capture =
        make_capture({.width = int(ids.size()), .height = 1, .background = {0.25f, 0.25f, 0.25f}});
    for (std::size_t x = 0; x < ids.size(); ++x)
        capture.images.at("object_id").uint_at(int(x), 0, 0) = ids[x];
    return capture;
}

TEST_F(MixAndMask, AMaskTakesRangesListsAndNames) {
    const std::vector<std::uint32_t> ids = {0, 1, 5, 8, 9, 11, 12, cryptomatte_hash("Wheel"), 4294967295u};
    const Capture capture = capture_of_ids(ids);
    const auto painted = [&](const std::string& objects) {
        Bench bench(effects_, look_of(R"({ "effect": "white", "mask": { "object": )" + objects + " } }"));
        const Image image = bench.color(capture);
        std::vector<std::uint32_t> found;
        for (std::size_t x = 0; x < ids.size(); ++x)
            if (image.at(int(x), 0, 0) == 1) found.push_back(ids[x]);
            else EXPECT_EQ(image.at(int(x), 0, 0), 0.25f);
        return found;
    };
    using Ids = std::vector<std::uint32_t>;
    EXPECT_EQ(painted(R"(["1-8"])"), (Ids{1, 5, 8}));
    EXPECT_EQ(painted(R"("8-9,12")"), (Ids{8, 9, 12}));
    EXPECT_EQ(painted(R"(["11-12", 0, "Wheel"])"), (Ids{0, 11, 12, cryptomatte_hash("Wheel")}));
    EXPECT_EQ(painted(R"(["0-4294967295"])"), Ids(ids));
    EXPECT_EQ(painted(R"([4294967295, "2-4"])"), Ids{4294967295u});
}

TEST_F(MixAndMask, AMaskHasEveryObjectOfALongList) {
    std::vector<std::uint32_t> ids;
    std::string even;
    for (std::uint32_t id = 0; id < 2000; ++id) {
        ids.push_back(id);
        if (id % 2 == 0) even += (even.empty() ? "" : ", ") + std::to_string(1998 - id);
    }
    Bench bench(effects_, look_of(R"({ "effect": "white", "mask": { "object": [)" + even + "] } }"));
    const Image image = bench.color(capture_of_ids(ids));
    for (int x = 0; x < int(ids.size()); ++x) ASSERT_EQ(image.at(x, 0, 0), x % 2 == 0 ? 1.0f : 0.25f) << x;
}

TEST_F(MixAndMask, ThatHaveNothingToWorkOnAreErrors) {
    const auto faults = [&](const std::string& step) { return Bound(effects_, look_of(step)).faults(); };
    EXPECT_NE(faults(R"({ "effect": "view_transform", "mix": 0.5 })").find("no earlier step has made one"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mix": 2 })").find("white.mix: 2 is above the maximum 1"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mask": { "role": "velocity" } })").find("one channel"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mask": {} })").find("one of 'role', 'object' and 'file'"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mask": { "file": "no.png" } })").find("no file 'no.png'"),
              std::string::npos);
}

TEST_F(MixAndMask, TablesCurvesAndFilesReachTheShader) {
    const TemporaryFolder folder;
    write_text(folder / "swap.cube",
               "LUT_3D_SIZE 2\n0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n");
    effects_.add("rich", R"(
        "inputs": { "color": { "role": "color" }, "object_id": { "role": "object_id" } },
        "outputs": { "color": { "role": "color" } },
        "params": {
          "gains": { "type": "table", "doc": ".", "columns": {
              "gain": { "type": "float", "default": 1, "doc": "." } } },
          "tone": { "type": "curve", "default": [[0, 0], [1, 1]], "doc": "." },
          "grade": { "type": "file", "kind": "lut", "default": "", "doc": "." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "object_id"],
                      "writes": ["color"] } ])",
                 R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 rgb = texelFetch(color, p, 0).rgb * gains(texelFetch(object_id, p, 0).r).gain;
    rgb.g = tone(rgb.g);
#ifdef HAS_GRADE
    rgb = grade(rgb);
#endif
    out_color = vec4(rgb, 1.0);
})");
    const Image image = run(R"({ "effect": "rich", "params": {
        "gains": { "rows": [ { "object": 2, "gain": 0.5 } ] },
        "tone": [[0, 0], [0.5, 1], [1, 1]],
        "grade": ")" + (folder / "swap.cube").string() +
                            R"(" } })");
    // Red and blue change places; green goes through the curve; object 2 is halved first.
    EXPECT_NEAR(image.at(1, 1, 2), 0.25f, 1e-6);
    EXPECT_NEAR(image.at(1, 1, 1), 1.0f, 1e-3);
    EXPECT_NEAR(image.at(13, 3, 2), 0.375f, 1e-6);
    EXPECT_NEAR(image.at(13, 3, 1), 0.2f, 1e-3);
    EXPECT_NEAR(image.at(13, 3, 0), 0.05f, 1e-6);
}

TEST_F(MixAndMask, AManifestsOwnFilesLieInItsFolderAndThoseOfKeysInTheLooks) {
    effects_.add("tabled", R"(
        "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "params": { "grade": { "type": "file", "kind": "lut", "default": "own.cube", "doc": "." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
                 R"(
void main() {
    out_color = vec4(grade(texelFetch(color, ivec2(gl_FragCoord.xy), 0).rgb), 1.0);
})");
    write_text(effects_.path() / "tabled/own.cube", "LUT_1D_SIZE 2\n0.75 0.75 0.75\n0.75 0.75 0.75\n");
    EXPECT_NEAR(run(R"({ "effect": "tabled" })").at(1, 1, 0), 0.75f, 1e-6);
    const TemporaryFolder folder;
    for (const char* level : {"0.25", "0.5"})
        write_text(folder / (std::string(level) + ".cube"),
                   std::string("LUT_1D_SIZE 2\n") + level + " 0 0\n" + level + " 0 0\n");
    const auto keyed = [&](const std::string& second) {
        write_text(folder / "look.json", look_of(R"({ "effect": "tabled", "params": { "grade":
            { "keys": { "1": "0.25.cube", "2": ")" +
                                                 second + "\" } } } }"));
        Diagnostics diagnostics;
        EffectRegistry registry({effects_.path()});
        const auto look = read_look(folder / "look.json", diagnostics);
        const Pipeline pipeline = bind_pipeline(look.value(), registry, {}, diagnostics);
        std::ostringstream faults;
        diagnostics.print(faults);
        std::string text = faults.str();
        for (const ParamValue& value :
             pipeline.steps.at(0).known_values(pipeline.steps[0].manifest->params.at(0)))
            text += std::get<std::string>(value) + "\n";
        return text;
    };
    EXPECT_EQ(keyed("0.5.cube"),
              (folder / "0.25.cube").string() + "\n" + (folder / "0.5.cube").string() + "\n");
    EXPECT_NE(keyed("none.cube").find("tabled.grade: no file '" + (folder / "none.cube").string()),
              std::string::npos);
}

TEST_F(MixAndMask, NeighbourFramesAreSeenWhereTheyAreThere) {
    effects_.add("ahead", R"(
        "inputs": { "color": { "role": "color" },
                    "later": { "role": "color", "frame": 1, "optional": true } },
        "outputs": { "color": { "role": "color" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "later"],
                      "writes": ["color"] } ])",
                 R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef HAS_LATER
    out_color = texelFetch(later, p, 0);
#else
    out_color = texelFetch(color, p, 0) * 2.0;
#endif
})");
    Bench bench(effects_, look_of(R"({ "effect": "ahead" })"));
    const Capture now = scene();
    Capture then = scene();
    for (float& value : then.images.at("color").floats()) value += 3;
    FrameInputs frame;
    frame.capture = &now;
    frame.neighbours[1] = &then;
    EXPECT_EQ(bench.run(frame).images.at("color").at(1, 1, 0), 3.25f);
    frame.neighbours.clear();
    EXPECT_EQ(bench.run(frame).images.at("color").at(1, 1, 0), 0.5f);
}

TEST_F(MixAndMask, AnInputIsReadOnlyWhereItsConditionsMayHold) {
    effects_.add("ahead", R"(
        "inputs": { "color": { "role": "color" },
                    "later": { "role": "color", "frame": 1, "optional": true, "when": { "look": "ahead" } },
                    "depth": { "role": "depth", "optional": true, "when": { "look": ["ahead", "down"] } } },
        "outputs": { "color": { "role": "color" } },
        "params": { "look": { "type": "enum", "values": ["here", "ahead", "down"], "default": "here", "doc": "." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "later", "depth"],
                      "writes": ["color"] } ])",
                 R"(
void main() {
    out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
#ifdef HAS_LATER
    out_color.r += 10.0 + 0.0 * texelFetch(later, ivec2(0), 0).r;
#endif
#ifdef HAS_DEPTH
    out_color.r += texelFetch(depth, ivec2(0), 0).r > 0.0 ? 100.0 : 0.0;
#endif
})");
    const Capture capture = scene();
    FrameInputs frame;
    frame.capture = frame.neighbours[1] = &capture;
    const std::vector<std::string> none{}, color{"color"}, both{"color", "depth"};
    const auto with = [&](const std::string& value) {
        return look_of(R"({ "effect": "ahead", "params": { "look": )" + value + " } }");
    };
    const auto red = [&](const std::string& value) {
        Bench bench(effects_, with(value));
        return bench.run(frame).images.at("color").at(1, 1, 0);
    };
    EXPECT_EQ(red(R"("here")"), 0.25f);
    EXPECT_EQ(red(R"("down")"), 100.25f);
    EXPECT_EQ(red(R"("ahead")"), 110.25f);
    EXPECT_EQ(red(R"({ "keys": { "1": "here", "9": "ahead" } })"), 110.25f) << "may hold in some frame";
}

}  // namespace
}  // namespace aftershade::test
