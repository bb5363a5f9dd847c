// Fingerprints change with everything that pixels depend on, and with nothing else.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "framework/capture/profile.h"
#include "framework/run/fingerprint.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTint = R"("inputs": { "color": { "role": "color" } },
    "outputs": { "color": { "role": "color" } },
    "params": { "gain": { "type": "float", "default": 2, "min": 0, "max": 9, "doc": "." } },
    "presets": { "strong": { "gain": 5 } },
    "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])";
constexpr const char* kTintShader =
    "#include \"gain.glsl\"\nvoid main() {\n    out_color = gained(texelFetch(color, ivec2(gl_FragCoord.xy), "
    "0), param.gain);\n}\n";
constexpr const char* kTrail = R"("inputs": { "color": { "role": "color" } },
    "outputs": { "color": { "role": "color" } },
    "textures": { "kept": { "format": "rgba16f", "history": true, "doc": "." } },
    "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "kept.prev"],
                  "writes": ["kept", "color"] } ])";

/// Three frames on disk, with all that a fingerprint is made of; what it is now.
class Fingerprints : public testing::Test {
protected:
    Fingerprints() {
        effects_.add("tint", kTint, kTintShader);
        write_text(effects_.path() / "tint/gain.glsl",
                   "vec4 gained(vec4 light, float gain) { return light * gain; }\n");
        effects_.add(
            "trail", kTrail,
            "void main() { out_kept = out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0); }\n");
        effects_.add_color("unused", "source");
        look(R"({ "effect": "tint" })");
        for (int frame = 1; frame <= 3; ++frame) write_input(frame, 0.5f);
        write_text(folder_ / "profile.json", read_text(source() / "profiles/native.json"));
        capture(R"("range": "1-3")");
        outputs_.patterns = {"out_####.exr"};
    }

    static fs::path source() { return AFTERSHADE_SOURCE_DIR; }
    void look(const std::string& steps) const { write_text(folder_ / "look.json", look_of(steps)); }
    void capture(const std::string& more) const {
        write_text(folder_ / "capture.json",
                   R"({ "aftershade": 1, "frames": "in_####.exr", "profile": "native", )" + more + "}");
    }
    void write_input(int frame, float value) const {
        SyntheticScene scene{.width = 8, .height = 4, .background = {value, 0.2f, 0.4f}};
        write_capture(make_capture(scene, frame), folder_ / ("in_000" + std::to_string(frame) + ".exr"));
    }

    struct Now {
        FingerprintParts setup;
        std::vector<FrameFingerprint> frames;
    };
    Now now() {
        Diagnostics faults;
        EffectRegistry registry({effects_.path(), source() / "effects"});
        const auto read = read_look(folder_ / "look.json", faults, variables_);
        const Pipeline pipeline = bind_pipeline(*read, registry, {sets_, {}}, faults);
        Sequence sequence = *open_sequence((folder_ / "capture.json").string(), faults);
        for (const auto& [role, file] : role_files_)
            add_role_file(sequence, role + "=" + (folder_ / file).string(), faults);
        if (!color_space_.empty()) sequence.color_space = color_space_;
        RunOptions run = run_;
        run.frames = frames_.empty() ? sequence.frames : frames_;
        const CaptureReader reader(sequence, read_profiles(source() / "profiles", faults), ReadLimits{});
        std::ostringstream text;
        faults.print(text);
        EXPECT_FALSE(faults.has_errors()) << text.str();
        Now result{setup_parts({*read,
                                pipeline,
                                sequence,
                                run,
                                outputs_,
                                folder_ / "capture.json",
                                {folder_ / "profile.json"},
                                renderer_,
                                source() / "glsl"},
                               reader),
                   {}};
        FrameFingerprints fingerprints(hash_of_parts(result.setup), sequence, reader, pipeline, run);
        for (std::size_t i = 0; i < run.frames.size(); ++i) result.frames.push_back(fingerprints.of(i));
        return result;
    }

    /// Every frame has another fingerprint after `change`, and the part of that name is why.
    void expect_changes_all(const std::string& part, const std::function<void()>& change) {
        const Now before = now();
        change();
        const Now after = now();
        EXPECT_NE(difference_of_parts(before.setup, after.setup).find(part), std::string::npos)
            << part << ": " << difference_of_parts(before.setup, after.setup);
        for (std::size_t i = 0; i < after.frames.size(); ++i)
            EXPECT_NE(before.frames[i].hash, after.frames[i].hash) << part << " " << i;
    }
    /// The frames, counted from 1, that have another fingerprint after `change`.
    std::vector<int> changed_by(const std::function<void()>& change) {
        const Now before = now();
        change();
        const Now after = now();
        std::vector<int> changed;
        for (std::size_t i = 0; i < std::min(before.frames.size(), after.frames.size()); ++i)
            if (before.frames[i].hash != after.frames[i].hash) changed.push_back(int(i) + 1);
        return changed;
    }

    TemporaryFolder folder_;
    EffectFolder effects_;
    OutputOptions outputs_;
    RunOptions run_;
    std::vector<int> frames_;
    std::vector<std::string> sets_;
    LookVariables variables_;
    std::map<std::string, std::string> role_files_;
    std::string color_space_;
    std::string renderer_ = "llvmpipe, 4.5 Mesa";
};

const std::vector<int> kNone;

TEST_F(Fingerprints, AreTheSameTwice) {
    EXPECT_EQ(changed_by([] {}), kNone);
    const Now made = now();
    EXPECT_NE(made.frames[0].hash, made.frames[1].hash);
    EXPECT_EQ(made.frames[0].hash.size(), 32u);
}

TEST_F(Fingerprints, ChangeWithTheLookAndItsValues) {
    expect_changes_all("values of tint", [&] { sets_ = {"tint.gain=3"}; });
    expect_changes_all("values of tint", [&] { sets_ = {"tint.gain=3.0000001"}; });
    sets_.clear();
    expect_changes_all("look", [&] { look(R"({ "effect": "tint", "params": { "gain": 4 } })"); });
    expect_changes_all("values of tint", [&] { look(R"({ "effect": "tint", "preset": "strong" })"); });
    expect_changes_all("values of tint", [&] { look(R"({ "effect": "tint", "mix": 0.5 })"); });
    expect_changes_all("values of tint", [&] {
        look(R"({ "effect": "tint", "mix": 0.5, "mask": { "object": 2, "invert": true } })");
    });
    write_text(folder_ / "look.json", R"({ "aftershade": 1, "vars": { "g": 1 }, "steps": [
        { "effect": "tint", "params": { "gain": { "var": "g" } } } ] })");
    expect_changes_all("values of tint", [&] { variables_["g"] = parse_command_value("2", {"--var g=2"}); });
}

TEST_F(Fingerprints, ChangeWithEffectsShadersIncludesAndFilesThatValuesName) {
    expect_changes_all("effect tint", [&] {
        write_text(effects_.path() / "tint/gain.glsl",
                   "vec4 gained(vec4 light, float gain) { return light + gain; }\n");
    });
    expect_changes_all("effect tint", [&] { effects_.add("tint", kTint, std::string(kTintShader) + "\n"); });
    std::string other = kTint;
    other.replace(other.find("\"max\": 9"), 8, "\"max\": 8");
    expect_changes_all("effect tint", [&] { effects_.add("tint", other, kTintShader); });
    write_capture(make_capture(SyntheticScene{.width = 8, .height = 4}), folder_ / "mask.exr");
    look(R"({ "effect": "tint", "mask": { "file": "mask.exr" } })");
    expect_changes_all("files of tint", [&] {
        write_capture(make_capture(SyntheticScene{.width = 8, .height = 4, .background = {1, 1, 1}}),
                      folder_ / "mask.exr");
    });
}

TEST_F(Fingerprints, ChangeWithTheRendererTheCaptureItsProfileAndTheOptionsOfOutputs) {
    expect_changes_all("renderer", [&] { renderer_ = "llvmpipe, 4.5 Mesa 25"; });
    expect_changes_all("capture",
                       [&] { capture(R"("range": "1-3", "camera": { "focal_length": "35 mm" })"); });
    expect_changes_all("capture", [&] { color_space_ = "acescg"; });
    expect_changes_all("profile", [&] {
        std::string text = read_text(folder_ / "profile.json");
        text.replace(text.find("\"roles\""), 7, "\"rolls\"");
        write_text(folder_ / "profile.json", text);
    });
    expect_changes_all("output options", [&] { outputs_.roles = {"color", "depth"}; });
    expect_changes_all("output options", [&] { outputs_.color_type = PixelType::float32; });
    expect_changes_all("output options", [&] { outputs_.crop_to_display = true; });
    expect_changes_all("output options", [&] { outputs_.png_bits = 16; });
    expect_changes_all("output options", [&] { outputs_.keep_channels = true; });
    expect_changes_all("output options", [&] { outputs_.compression = "dwaa"; });
    expect_changes_all("output options", [&] { run_.scale_divisor = 2; });
    expect_changes_all("output options", [&] { run_.region = Window{0, 0, 3, 3}; });
    expect_changes_all("output options", [&] { run_.region_margin_px = 3; });
}

TEST_F(Fingerprints, ChangeWithTheFramesOwnFilesAlone) {
    EXPECT_EQ(changed_by([&] { write_input(2, 0.6f); }), (std::vector{2}));
    EXPECT_EQ(now().frames[1].inputs.count("input in_0002.exr"), 1u);
    for (int frame = 1; frame <= 3; ++frame)
        fs::copy(folder_ / "in_0001.exr", folder_ / ("z_000" + std::to_string(frame) + ".exr"));
    EXPECT_EQ(changed_by([&] { role_files_["depth"] = "z_####.exr"; }), (std::vector{1, 2, 3}));
    EXPECT_EQ(changed_by([&] {
                  fs::copy(folder_ / "in_0002.exr", folder_ / "z_0003.exr",
                           fs::copy_options::overwrite_existing);
              }),
              (std::vector{3}));
    EXPECT_EQ(changed_by([&] { fs::remove(folder_ / "in_0001.exr"); }), (std::vector{1}));
}

TEST_F(Fingerprints, ChangeWithNothingElse) {
    EXPECT_EQ(changed_by([&] { effects_.add_color("unused", "2.0 * source"); }), kNone);
    EXPECT_EQ(changed_by([&] { write_text(effects_.path() / "tint/notes.txt", "words"); }), kNone);
    EXPECT_EQ(changed_by([&] { outputs_.patterns = {"elsewhere_####.exr", "b_####.png"}; }), kNone);
    EXPECT_EQ(changed_by([&] { outputs_.telemetry = "told_####.json"; }), kNone);
    EXPECT_EQ(changed_by([&] { run_.region_margin_px = 3; }), kNone) << "there is no region";
    EXPECT_EQ(changed_by([&] { write_input(4, 0.1f); }), kNone);
    EXPECT_EQ(changed_by([&] { capture("\"range\":   \"1-4\""); }), kNone) << "a frame more";
    EXPECT_EQ(
        changed_by([&] { fs::last_write_time(folder_ / "in_0001.exr", fs::file_time_type::clock::now()); }),
        kNone);
    frames_ = {3, 2, 1};
    const std::string first = now().frames[2].hash;
    frames_ = {1};
    EXPECT_EQ(now().frames[0].hash, first) << "without history other frames do not matter";
}

TEST_F(Fingerprints, OfALookWithHistoryAreAChain) {
    look(R"({ "effect": "trail" })");
    capture(R"("range": "1-3")");
    EXPECT_EQ(changed_by([&] { write_input(2, 0.7f); }), (std::vector{2, 3}));
    const Now chain = now();
    EXPECT_EQ(chain.frames[0].before, FrameFingerprint::kBegin);
    EXPECT_EQ(chain.frames[1].before, chain.frames[0].hash);
    EXPECT_EQ(chain.frames[2].before, chain.frames[1].hash);
    EXPECT_EQ(changed_by([&] { capture(R"("range": "1-3", "cuts": [3])"); }), (std::vector{3}));
    EXPECT_EQ(changed_by([&] { write_input(2, 0.3f); }), (std::vector{2})) << "frame 3 begins a shot";
    frames_ = {1, 3};
    EXPECT_EQ(now().frames[1].before, FrameFingerprint::kBegin) << "a gap";
}

TEST_F(Fingerprints, OfAHeldFrameAreThoseOfTheFrameThatItHolds) {
    run_.missing = MissingFrame::hold;
    fs::remove(folder_ / "in_0002.exr");
    EXPECT_EQ(now().frames[1].inputs, now().frames[0].inputs);
    EXPECT_EQ(changed_by([&] { write_input(1, 0.9f); }), (std::vector{1, 2}));
}

TEST(DifferenceOfParts, NamesThreeAtMost) {
    const FingerprintParts before{{"a", "1"}, {"b", "1"}, {"c", "1"}, {"d", "1"}};
    EXPECT_EQ(difference_of_parts(before, before), "");
    EXPECT_EQ(difference_of_parts(before, {{"a", "1"}, {"b", "2"}, {"c", "1"}, {"d", "1"}}), "b changed");
    EXPECT_EQ(difference_of_parts(before, {{"a", "2"}, {"b", "1"}, {"c", "1"}}), "a and d changed");
    EXPECT_EQ(difference_of_parts(before, {{"a", "2"}, {"b", "2"}, {"c", "2"}, {"d", "2"}}),
              "a, b and 2 more changed");
}

}  // namespace
}  // namespace aftershade::test
