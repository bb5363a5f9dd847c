// Sessions keep what effects remember; looks by themselves do not.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "aftershade/host.h"
#include "framework/file/exr_file.h"
#include "tests/host/host_setup.h"
#include "tests/temporary_folder.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;

constexpr const char* kTemporal = R"({"aftershade": 1, "steps": [{"effect": "taa"}]})";

Capture still(int frame, float brightness) {
    Capture capture = small_capture(32, 24, brightness);
    const std::vector<float> velocity(32 * 24 * 2);
    capture.set_image("velocity", view_of(velocity, 32, 24, 2));
    capture.set_frame(frame);
    return capture;
}

TEST(HostSession, RemembersFramesThatFollowOneAnother) {
    Host host(on_software());
    Look look = host.parse_look(kTemporal);
    ASSERT_TRUE(look.has_history());
    Session session = look.session();
    const Result first = session.render(still(1, 1));
    EXPECT_EQ(first.history_reset(), "the first frame");
    const Result second = session.render(still(2, 1.2f));
    EXPECT_EQ(second.history_reset(), "");
    const Image alone = look.render(still(2, 1.2f)).image("color");
    EXPECT_FALSE(same_bits(second.image("color"), alone));
    EXPECT_NE(session.render(still(9, 1.2f)).history_reset(), "");
    session.reset();
    EXPECT_TRUE(same_bits(session.render(still(2, 1.2f)).image("color"), alone));
}

TEST(HostSession, ContinuesFromAFile) {
    const TemporaryFolder folder;
    Host host(on_software());
    Look look = host.parse_look(kTemporal);
    Session session = look.session();
    session.render(still(1, 1));
    session.save_history(folder / "history");
    const Image second = session.render(still(2, 1.3f)).image("color");
    Session later = look.session();
    later.load_history(folder / "history");
    EXPECT_TRUE(same_bits(later.render(still(2, 1.3f)).image("color"), second));
}

TEST(HostSession, PlaysASequenceAsTheProgramRunsIt) {
    const TemporaryFolder folder;
    const std::string look_file = folder / "look.json", pattern = folder / "f_####.exr";
    write_file(look_file, kTemporal);
    Host host(on_software());
    Look copy = host.parse_look(R"({"aftershade": 1, "steps": []})");
    for (int frame = 1; frame <= 3; ++frame)
        copy.render(still(frame, 1 + 0.2f * float(frame)))
            .write(pattern, {.roles = {"color", "depth", "velocity"}, .half = false});
    ASSERT_EQ(std::system(("\"" AFTERSHADE_EXECUTABLE "\" run " + look_file + " " + pattern + " -o " +
                           (folder / "out_####.exr").string() +
                           " --backend software --pixel-type float --progress none")
                              .c_str()),
              0);
    Look look = host.load_look(look_file);
    Session session = look.session();
    const Sequence sequence = Sequence::open(host, pattern);
    EXPECT_EQ(sequence.frames(), (std::vector<int>{1, 2, 3}));
    for (const int frame : sequence.frames()) {
        const Image image = session.render(sequence, frame).image("color");
        const std::vector<std::string> channels = {"R", "G", "B", "A"};
        const auto expected = aftershade::ExrFile(folder / ("out_000" + std::to_string(frame) + ".exr"))
                                  .read_floats(0, channels);
        EXPECT_TRUE(std::ranges::equal(image.floats(), expected.floats())) << frame;
    }
}

/// With a cache, threads compile what the first frame draws with.
TEST(HostLook, DrawsTheSameBitsWithAnEmptyCacheAFilledOneAndNone) {
    const TemporaryFolder folder;
    const auto color = [](const HostOptions& options) {
        Host host(options);
        return host.parse_look(kBlurLook).render(small_capture()).image("color");
    };
    HostOptions cached = on_software();
    cached.cache = folder.path() / "cache";
    const Image alone = color(on_software()), first = color(cached), second = color(cached);
    EXPECT_TRUE(same_bits(alone, first));
    EXPECT_TRUE(same_bits(alone, second));
    EXPECT_FALSE(std::filesystem::is_empty(cached.cache));
}

TEST(HostLook, GivesItsParametersAndTakesNewValues) {
    Host host(on_software());
    Look look = host.parse_look(kBlurLook);
    EXPECT_EQ(look.steps(), (std::vector<std::string>{"bokeh", "vignette"}));
    const Image before = look.render(small_capture()).image("color");
    look.set("bokeh.f_number", 8.0);
    EXPECT_EQ(look.get("bokeh.f_number"), Value(8.0));
    EXPECT_FALSE(same_bits(look.render(small_capture()).image("color"), before));
    EXPECT_THROW(look.set({{"bokeh.f_number", 4.0}, {"bokeh.nothing", 1.0}}), Error);
    EXPECT_EQ(look.get("bokeh.f_number"), Value(8.0));
    look.set("vignette.mix", 0.5);  // adds a pass
    EXPECT_NO_THROW(look.render(small_capture()));
    look.reset("bokeh.f_number");
    look.reset("vignette.mix");
    EXPECT_TRUE(same_bits(look.render(small_capture()).image("color"), before));
    for (const LookParam& param : look.params())
        if (param.name == "bokeh.f_number") {
            EXPECT_EQ(param.value, Value(0.5));
            EXPECT_EQ(param.origin, "the look");
            EXPECT_TRUE(param.info.min && !param.info.doc.empty());
        }
}

TEST(HostLook, GivesTimesStatisticsAndTaps) {
    Host host(on_software());
    Look look = host.parse_look(kBlurLook, {.taps = {"bokeh.coc"}});
    const Result result = look.render(small_capture(), {.timed = true, .telemetry = true});
    EXPECT_EQ(result.times().front().pass, "upload");
    EXPECT_EQ(result.times().back().pass, "readback");
    EXPECT_EQ(result.tap("bokeh.coc").width(), 48);
    EXPECT_GT(result.gpu_bytes(), 48u * 32 * 16);
    EXPECT_TRUE(look.render(small_capture()).times().empty());
}

TEST(HostEffects, AreWhatTheProgramLists) {
    Host host(on_software());
    const std::vector<EffectInfo> effects = host.effects();
    ASSERT_GT(effects.size(), 10u);
    for (const EffectInfo& effect : effects) {
        EXPECT_FALSE(effect.summary.empty()) << effect.id;
        EXPECT_FALSE(effect.outputs.empty()) << effect.id;
        for (const ParamInfo& param : effect.params) EXPECT_FALSE(param.doc.empty()) << effect.id;
    }
    EXPECT_EQ(host.effect("bokeh").params.size(),
              std::ranges::find(effects, "bokeh", &EffectInfo::id)->params.size());
}

TEST(HostCompare, GivesFiguresAndMapsOfArrays) {
    const Capture reference = small_capture(), test = small_capture(48, 32, 1.1f);
    const Comparison same = compare(reference.image("color"), reference.image("color"));
    EXPECT_EQ(same.verdict, Verdict::same);
    const Comparison other = compare(reference.image("color"), test.image("color"), "color", {.maps = true});
    EXPECT_EQ(other.verdict, Verdict::failure);
    ASSERT_EQ(other.layers.size(), 2u);
    EXPECT_EQ(other.layers[0].flip_map.width(), 48);
    EXPECT_GT(*other.layers[0].hdr_flip, 0);
    EXPECT_EQ(other.layers[1].verdict, Verdict::same);
    // The largest difference is that of the brightest dots: a tenth of 20.
    EXPECT_NEAR(other.layers[0].largest.value, 2, 1e-5);
}

TEST(HostCompare, NamesWhatNoLimitHolds) {
    const TemporaryFolder folder;
    Host host(on_software());
    Capture one = small_capture(), other = small_capture();
    std::vector<float> depth(48 * 32, 1);
    other.set_image("depth", view_of(depth, 48, 32, 1));
    Look look = host.parse_look(R"({"aftershade": 1, "steps": []})");
    for (const auto& [capture, name] : {std::pair(&one, "a.exr"), {&other, "b.exr"}})
        look.render(*capture).write(folder / name, {.roles = {"color", "depth"}});
    CompareOptions by_flip{.fail = {.limit = std::numeric_limits<double>::infinity()}, .fail_flip = 0.01};
    const Comparison files = compare(folder / "a.exr", folder / "b.exr", by_flip);
    EXPECT_EQ(files.verdict, Verdict::same);
    EXPECT_EQ(files.not_judged, (std::vector<std::string>{"A", "Z"}));
    for (const LayerFigures& layer : files.layers)
        EXPECT_EQ(layer.is_judged, layer.label == "RGB") << layer.label;
    const Comparison arrays = compare(one.image("color"), other.image("color"), "color", by_flip);
    EXPECT_EQ(arrays.not_judged, std::vector<std::string>{"A"});
    EXPECT_TRUE(compare(folder / "a.exr", folder / "b.exr").not_judged.empty());
    EXPECT_EQ(compare(folder / "a.exr", folder / "b.exr", {.roles = {{"Z", "ignore"}}}).not_judged,
              std::vector<std::string>{"Z"});
}

TEST(HostCompare, SaysWhyEqualNumbersAreAWarning) {
    const TemporaryFolder folder;
    Host host(on_software());
    Capture rec709 = small_capture(), acescg = small_capture();
    acescg.set_color_space("acescg");
    Look look = host.parse_look(R"({"aftershade": 1, "steps": []})");
    look.render(rec709).write(folder / "a.exr");
    look.render(acescg).write(folder / "b.exr");
    const Comparison comparison = compare(folder / "a.exr", folder / "b.exr");
    EXPECT_EQ(comparison.verdict, Verdict::warning);
    ASSERT_EQ(comparison.warnings.size(), 1u);
    EXPECT_EQ(comparison.warnings[0].find("the same numbers are other colours"), 0u)
        << comparison.warnings[0];
}

}  // namespace
