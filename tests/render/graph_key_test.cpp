// When a frame graph is built again: only where the build would look at something that changed.
#include "framework/render/graph_key.h"

#include <algorithm>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/capture/cryptomatte.h"
#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

const char* const kManifest = R"(
    "inputs": { "color": { "role": "color" }, "object_id": { "role": "object_id" },
                "depth": { "role": "depth", "optional": true } },
    "outputs": { "color": { "role": "color" } },
    "params": {
      "gain": { "type": "float", "default": 1, "doc": "." },
      "reach": { "type": "float", "unit": "m", "default": 1, "from": "camera.focus_distance",
                 "bind": "define", "doc": "." },
      "mode": { "type": "enum", "values": ["plain", "soft"], "default": "plain", "doc": "." },
      "really": { "type": "bool", "default": true, "doc": "." },
      "turns": { "type": "int", "default": 1, "min": 1, "max": 4, "doc": "." },
      "gains": { "type": "table", "doc": ".", "columns": {
          "gain": { "type": "float", "default": 1, "doc": "." } } },
      "lift": { "type": "float", "default": 0, "doc": "." },
      "bend": { "type": "float", "default": 1, "identity": 1, "doc": "." },
      "tone": { "type": "curve", "default": [[0, 0], [1, 1]], "doc": "." } },
    "textures": { "work": { "format": "r32f", "clear": 0, "doc": "." } },
    "passes": [
      { "name": "soften", "shader": "soften.frag", "writes": ["work"], "repeat": "turns",
        "when": { "mode": "soft", "really": true } },
      { "name": "lift", "shader": "lift.frag", "writes": ["work"], "when": { "nonzero.lift": true } },
      { "name": "bend", "shader": "bend.frag", "writes": ["work"], "when": { "changes.bend": true } },
      { "name": "main", "shader": "main.frag", "reads": ["color", "object_id", "depth", "work"],
        "writes": ["color"] } ])";
const char* const kMain = R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float value = param.gain * float(REACH) * gains(texelFetch(object_id, p, 0).r).gain;
#ifdef HAS_DEPTH
    value += texelFetch(depth, p, 0).r;
#endif
    out_color = vec4(tone(value), texelFetch(work, p, 0).r, 0.0, 1.0);
})";

/// A step's value that is `first` in frame 1 and `then` in frame 9: a gap, so that no history is between
/// them.
std::string keyed(const std::string& name, const std::string& first, const std::string& then) {
    return "\"" + name + R"(": { "keys": { "1": )" + first + R"(, "9": )" + then +
           R"( }, "interpolation": "step" })";
}

class GraphKeys : public testing::Test {
protected:
    GraphKeys() {
        effects_.add("shaped", kManifest, kMain);
        write_text(effects_.path() / "shaped/soften.frag",
                   std::string(kShaderHead) + "void main() { out_work = float(pass.count); }\n");
        write_text(effects_.path() / "shaped/lift.frag",
                   std::string(kShaderHead) + "void main() { out_work = param.lift; }\n");
        write_text(effects_.path() / "shaped/bend.frag",
                   std::string(kShaderHead) + "void main() { out_work = param.bend; }\n");
    }

    static Capture capture_of(int number) {
        Capture capture = make_capture({.width = 7, .height = 5, .background_depth_m = 4});
        capture.header.frame = number;
        return capture;
    }

    /// Graphs that the two frames take.
    int graphs_of(const std::string& params, const std::string& step = "") {
        return graphs_of(params, capture_of(1), capture_of(9), step);
    }
    int graphs_of(const std::string& params, const Capture& first, const Capture& then,
                  const std::string& step = "") {
        Bench bench(effects_, look_of(R"({ "effect": "shaped", "params": {)" + params + "}" + step + " }"));
        bench.run(first);
        bench.run(then);
        return bench.renderer().graphs_built();
    }

    EffectFolder effects_;
};

TEST_F(GraphKeys, HoldWhereContentsChange) {
    EXPECT_EQ(graphs_of(keyed("gain", "1", "2")), 1);
    EXPECT_EQ(graphs_of(keyed("tone", "[[0, 0], [1, 1]]", "[[0, 1], [0.5, 0], [1, 1]]")), 1);
    EXPECT_EQ(graphs_of(keyed("gains", R"({ "rows": [ { "object": 1, "gain": 2 } ] })",
                              R"({ "rows": [ { "object": 5, "gain": 3 } ] })")),
              1);
    EXPECT_EQ(graphs_of("", ", " + keyed("mix", "1", "0.5")), 1);
    Capture other = capture_of(9);
    other.header.camera.set("focal_length", 35);
    other.header.lights.resize(1);
    EXPECT_EQ(graphs_of("", capture_of(1), other), 1);
}

TEST_F(GraphKeys, DoNotHoldWhereTheFormChanges) {
    Capture far = capture_of(9);
    far.header.camera.set("focus_distance", 3);
    EXPECT_EQ(graphs_of("", capture_of(1), far), 2) << "a define";
    EXPECT_EQ(graphs_of(keyed("mode", "\"plain\"", "\"soft\"")), 2) << "a condition";
    EXPECT_EQ(graphs_of(R"("mode": "soft", )" + keyed("turns", "1", "3")), 2) << "a count";
    EXPECT_EQ(graphs_of(keyed("gains", R"({ "rows": [ { "object": 1, "gain": 2 } ] })",
                              R"({ "rows": [ { "object": 1, "gain": 2 }, { "object": 2, "gain": 3 } ] })")),
              2)
        << "the number of rows";
    Capture wide = make_capture({.width = 9, .height = 5, .background_depth_m = 4});
    EXPECT_EQ(graphs_of("", capture_of(1), wide), 2) << "the width";
    Capture high = make_capture({.width = 7, .height = 6, .background_depth_m = 4});
    EXPECT_EQ(graphs_of("", capture_of(1), high), 2) << "the height";
}

TEST_F(GraphKeys, KnowOnlyTheConditionsAndCountsThatWereLookedAt) {
    EXPECT_EQ(graphs_of(R"("mode": "plain", )" + keyed("turns", "1", "3")), 1)
        << "of a pass that does not run";
    EXPECT_EQ(graphs_of(R"("mode": "plain", )" + keyed("really", "true", "false")), 1)
        << "after a condition that does not hold";
    EXPECT_EQ(graphs_of(R"("mode": "soft", )" + keyed("really", "true", "false")), 2);
}

TEST_F(GraphKeys, KnowOfANumberOnlyWhetherItIs0WhereNothingElseIsAsked) {
    EXPECT_EQ(graphs_of(keyed("lift", "0", "0.5")), 2);
    EXPECT_EQ(graphs_of(keyed("lift", "-1", "0.5")), 1) << "the pass has a uniform for it";
    Bench bench(effects_,
                look_of(R"({ "effect": "shaped", "params": {)" + keyed("lift", "0", "0.5") + "} }"));
    const auto work = [&](int frame) { return bench.run(capture_of(frame)).images.at("color").floats()[1]; };
    EXPECT_EQ(work(1), 0);
    EXPECT_EQ(work(9), 0.5f);
}

TEST_F(GraphKeys, KnowOfAParameterOnlyWhetherItIsAtItsIdentityWhereNothingElseIsAsked) {
    EXPECT_EQ(graphs_of(keyed("bend", "1", "2")), 2);
    EXPECT_EQ(graphs_of(keyed("bend", "3", "2")), 1) << "the pass has a uniform for it";
}

TEST_F(GraphKeys, KnowTheImagesThatSomeStepMayTake) {
    Capture other = capture_of(9);
    other.images.erase("albedo");
    other.images.erase("normal");
    EXPECT_EQ(graphs_of("", capture_of(1), other), 1) << "images that no step takes";
    other.images.erase("depth");
    EXPECT_EQ(graphs_of("", capture_of(1), other), 2) << "an optional input";
}

TEST_F(GraphKeys, KnowTheRolesThatAreReadBack) {
    Bench bench(effects_, look_of(R"({ "effect": "shaped" })"));
    bench.run(capture_of(1), {"color"});
    bench.run(capture_of(9), {"color", "display"});
    EXPECT_EQ(bench.renderer().graphs_built(), 1) << "no step makes display";
    EXPECT_TRUE(bench.run(capture_of(17), {"display"}).images.empty());
    EXPECT_EQ(bench.renderer().graphs_built(), 2);
}

TEST_F(GraphKeys, GiveEachFrameWhatAGraphOfItsOwnGives) {
    for (const std::string& params :
         {keyed("gain", "1", "2"), keyed("mode", "\"plain\"", "\"soft\""),
          R"("mode": "soft", )" + keyed("turns", "1", "3"),
          keyed("gains", R"({ "rows": [ { "objects": "0-9", "gain": 2 } ] })",
                R"({ "rows": [ { "name": "hair", "gain": 4 }, { "objects": "0-9", "gain": 3 } ] })")}) {
        const std::string look = look_of(R"({ "effect": "shaped", "params": {)" + params + "} }");
        Bench used(effects_, look), fresh(effects_, look);
        used.run(capture_of(1));
        EXPECT_TRUE(
            std::ranges::equal(used.color(capture_of(9)).floats(), fresh.color(capture_of(9)).floats()))
            << params;
    }
}

/// A frame as far as its header says: images without pixels.
Capture outline_of(const Capture& capture) {
    Capture outline;
    outline.header = capture.header;
    for (const auto& [role, image] : capture.images) outline.images[role];
    return outline;
}

TEST_F(GraphKeys, HoldOfAGraphThatWasBuiltBeforeThePixelsWereKnown) {
    const std::string look = look_of(R"({ "effect": "shaped", "params": { "mode": "soft" } })");
    const Image expected = Bench(effects_, look).color(capture_of(1));
    for (const auto backend : {gpu::Backend::osmesa, gpu::Backend::egl_software}) {
        if (!gpu::why_not(backend).empty()) continue;
        Bench bench(effects_, look, {}, backend);
        const Capture outline = outline_of(capture_of(1));
        FrameInputs frame;
        frame.capture = &outline;
        bench.renderer().build_ahead(frame, {"color", "display"});
        EXPECT_EQ(bench.renderer().graphs_built(), 1);
        EXPECT_TRUE(std::ranges::equal(bench.color(capture_of(1)).floats(), expected.floats()));
        EXPECT_EQ(bench.renderer().graphs_built(), 1);
        EXPECT_FALSE(bench.renderer().can_build_ahead()) << "after a frame";
    }
}

TEST_F(GraphKeys, DoNotHoldWhereTheHeaderToldAnotherStory) {
    const std::string look = look_of(R"({ "effect": "shaped" })");
    Capture wide = make_capture({.width = 9, .height = 5, .background_depth_m = 4}), flat = capture_of(1);
    wide.header.frame = 1;
    flat.images.erase("depth");
    for (const Capture* told : {&wide, &flat}) {
        Bench bench(effects_, look);
        const Capture outline = outline_of(*told);
        FrameInputs frame;
        frame.capture = &outline;
        bench.renderer().build_ahead(frame, {"color", "display"});
        EXPECT_TRUE(std::ranges::equal(bench.color(capture_of(1)).floats(),
                                       Bench(effects_, look).color(capture_of(1)).floats()));
        EXPECT_EQ(bench.renderer().graphs_built(), 2);
    }
}

TEST_F(GraphKeys, LeaveTheFaultsOfAnEarlyBuildToTheFrame) {
    effects_.add_color("broken", "source * undeclared");
    Bench bench(effects_, look_of(R"({ "effect": "broken" })"));
    const Capture capture = capture_of(1);
    FrameInputs frame;
    frame.capture = &capture;
    EXPECT_NO_THROW(bench.renderer().build_ahead(frame, {"color"}));
    EXPECT_EQ(bench.renderer().graphs_built(), 0);
    EXPECT_THROW(bench.run(capture), Error);
}

TEST_F(GraphKeys, WaitForThePixelsWhereAValueIsMeasuredInThem) {
    const std::string measured = R"("reach": { "from": "depth", "uv": [0.5, 0.5] })";
    Bench bench(effects_, look_of(R"({ "effect": "shaped", "params": { )" + measured + " } }"));
    EXPECT_FALSE(bench.renderer().can_build_ahead());
    EXPECT_TRUE(Bench(effects_, look_of(R"({ "effect": "shaped" })")).renderer().can_build_ahead());
}

// Where names take their ids out of ranges, and of several names, none shares an id with another.
TEST_F(GraphKeys, LeaveRoomForEveryNameOfATable) {
    Capture capture = capture_of(1);
    Image& ids = capture.images.at("object_id");
    for (std::size_t i = 0; i < ids.uints().size(); ++i) ids.uints()[i] = std::uint32_t(i % 3);
    ids.uints()[0] = cryptomatte_hash("hair");
    ids.uints()[1] = cryptomatte_hash("skin");
    Bench bench(effects_, look_of(R"({ "effect": "shaped", "params": {
        "tone": [[0, 0], [1, 1]],
        "gains": { "rows": [ { "objects": "0-4294967295", "gain": 0.5 }, { "name": "hair", "gain": 0.25 },
                             { "name": "skin", "gain": 0.75 } ] } } })"));
    capture.images.erase("depth");
    const Image color = bench.color(capture);
    EXPECT_NEAR(color.at(0, 0, 0), 0.25f, 1e-6f);
    EXPECT_NEAR(color.at(1, 0, 0), 0.75f, 1e-6f);
    EXPECT_NEAR(color.at(2, 0, 0), 0.5f, 1e-6f);
}

TableValue table_with(const TableKey& key) {
    TableValue table;
    table.rows.emplace_back(key, TableValue::Row{});
    return table;
}

TEST(GraphFrameReader, MakesAKeyOfWhatItWasAskedAndOfNothingElse) {
    EffectManifest manifest;
    ParamSpec& rows = manifest.params.emplace_back();
    rows.name = "rows";
    rows.type = ParamType::table;
    Pipeline pipeline;
    pipeline.steps.emplace_back().manifest = &manifest;
    const NativeSteps natives({});
    Capture capture;
    capture.header.data_window = {0, 0, 15, 8};
    capture.images["depth"] = Image(16, 9, 1);
    FrameInputs inputs;
    inputs.capture = &capture;
    std::vector<ParamSet> params(1);
    params[0].set("asked", 1.0);
    params[0].set("other", 1.0);
    params[0].set("rows", table_with({1, 1, ""}));
    std::vector<std::string> roles = {"color"};
    const GraphFrame frame{pipeline, inputs, params, natives, roles};

    GraphFrameReader reader(frame);
    EXPECT_EQ(reader.width_px(), 16);
    EXPECT_TRUE(reader.has_image("depth", 0));
    EXPECT_FALSE(reader.has_image("depth", -1));
    EXPECT_TRUE(reader.wants("color"));
    const ParamReader of_step = reader.params(0);
    EXPECT_EQ(std::get<double>(of_step.get("asked")), 1.0);
    EXPECT_EQ(of_step.table_entries(rows), 1U);
    const GraphKey key = reader.key();

    using About = GraphQuestion::About;
    EXPECT_TRUE(key.asked({About::param, 0, "asked"}));
    EXPECT_TRUE(key.asked({About::param, 0, "rows", ParamAspect::table_entries}));
    EXPECT_FALSE(key.asked({About::param, 0, "rows"}));
    EXPECT_FALSE(key.asked({About::param, 0, "other"}));
    EXPECT_TRUE(key.holds(frame));
    params[0].set("other", 2.0);
    params[0].set("rows", table_with({7, 9, ""}));
    capture.header.data_window.max_y = 20;
    capture.images["albedo"] = Image(16, 9, 3);
    roles.push_back("display");
    EXPECT_TRUE(key.holds(frame));

    const auto holds_not_after = [&](const auto& change, const auto& undo) {
        change();
        EXPECT_FALSE(key.holds(frame));
        undo();
        EXPECT_TRUE(key.holds(frame));
    };
    holds_not_after([&] { params[0].set("asked", 1.5); }, [&] { params[0].set("asked", 1.0); });
    holds_not_after([&] { params[0].set("rows", TableValue{}); },
                    [&] {
                        params[0].set("rows", table_with({2, 2, ""}));
                    });
    holds_not_after([&] { capture.header.data_window.max_x = 16; },
                    [&] { capture.header.data_window.max_x = 15; });
    holds_not_after([&] { capture.images.erase("depth"); },
                    [&] { capture.images["depth"] = Image(16, 9, 1); });
    holds_not_after([&] { inputs.neighbours[-1] = &capture; }, [&] { inputs.neighbours.clear(); });
    holds_not_after([&] { roles = {"display"}; }, [&] { roles = {"color"}; });
}

}  // namespace
}  // namespace aftershade::test
