// What survives a frame: against a recurrence on the CPU.
#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

/// Half of what was, half of what is; the first frame of a shot is what is.
constexpr const char* kBlendManifest = R"(
    "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
    "textures": { "kept": { "format": "rgba32f", "history": true, "doc": "Accumulated light." } },
    "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "kept.prev"],
                  "writes": ["kept"] },
                { "name": "show", "shader": "show.frag", "reads": ["kept"], "writes": ["color"] } ])";
constexpr const char* kBlendShader = R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 now = texelFetch(color, p, 0), before = texelFetch(kept_prev, p, 0);
    out_kept = frame.history_valid ? 0.5 * now + 0.5 * before : now;
})";

class History : public testing::Test {
protected:
    History() {
        effects_.add("blend", kBlendManifest, kBlendShader);
        write_text(effects_.path() / "blend" / "show.frag",
                   std::string(kShaderHead) +
                       "void main() { out_color = texelFetch(kept, ivec2(gl_FragCoord.xy), 0); }\n");
    }

    static Capture grey(int frame, float value, int width = 8) {
        SyntheticScene scene;
        scene.width = width;
        scene.height = 4;
        scene.background = {value, 2 * value, 0};
        return make_capture(scene, frame);
    }

    /// The first channel, and why history restarted.
    static std::pair<float, std::string> step(Bench& bench, const Capture& capture, bool cut = false) {
        FrameInputs frame;
        frame.capture = &capture;
        frame.begins_shot = cut;
        const FrameResult result = bench.run(frame);
        return {result.images.at("color").at(3, 2, 0), result.history_reset};
    }

    EffectFolder effects_;
    const std::string look_ = look_of(R"({ "effect": "blend" })");
};

TEST_F(History, IsWhatTheFrameBeforeLeft) {
    Bench bench(effects_, look_);
    float expected = 0;
    for (int frame = 1; frame <= 5; ++frame) {
        const float value = float(frame * frame);
        expected = frame == 1 ? value : 0.5f * value + 0.5f * expected;
        const auto [seen, reset] = step(bench, grey(frame, value));
        EXPECT_EQ(seen, expected) << frame;
        EXPECT_EQ(reset, frame == 1 ? "the first frame" : "") << frame;
    }
}

TEST_F(History, RestartsAtACutAGapAndAnotherSize) {
    Bench bench(effects_, look_);
    step(bench, grey(1, 8));
    EXPECT_EQ(step(bench, grey(2, 4)), std::pair(6.0f, std::string()));
    EXPECT_EQ(step(bench, grey(3, 4), true), std::pair(4.0f, std::string("a cut")));
    EXPECT_EQ(step(bench, grey(5, 1)), std::pair(1.0f, std::string("it follows frame 3, not 4")));
    EXPECT_EQ(step(bench, grey(6, 3)), std::pair(2.0f, std::string()));
    EXPECT_EQ(step(bench, grey(7, 9, 12)), std::pair(9.0f, std::string("another data window")));
    EXPECT_EQ(step(bench, grey(8, 1, 12)), std::pair(5.0f, std::string()));
}

TEST_F(History, OfAnInputIsItsImageOfTheFrameBefore) {
    effects_.add("lag", R"(
        "inputs": { "color": { "role": "color", "history": true } }, "outputs": { "color": { "role": "color" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "color.prev"],
                      "writes": ["color"] } ])",
                 R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_color = frame.history_valid ? texelFetch(color_prev, p, 0) : texelFetch(color, p, 0);
})");
    Bench bench(effects_, look_of(R"({ "effect": "lag" })"));
    EXPECT_EQ(step(bench, grey(1, 3)).first, 3);
    EXPECT_EQ(step(bench, grey(2, 5)).first, 3);
    EXPECT_EQ(step(bench, grey(3, 7)).first, 5);
}

TEST_F(History, LivesOnWhereTheGraphIsBuiltAnew) {
    effects_.add("blend_either", R"(
        "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "params": { "size": { "type": "int", "default": 2, "min": 1, "max": 8, "doc": "." } },
        "textures": { "kept": { "format": "rgba32f", "history": true, "doc": "." },
                      "small": { "format": "r32f", "tile": "size", "doc": "." } },
        "passes": [ { "name": "shrink", "shader": "show.frag", "reads": ["color"], "writes": ["small"] },
                    { "name": "main", "shader": "main.frag", "reads": ["color", "kept.prev", "small"],
                      "writes": ["kept"] },
                    { "name": "show", "shader": "out.frag", "reads": ["kept"], "writes": ["color"] } ])",
                 R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 now = texelFetch(color, p, 0), before = texelFetch(kept_prev, p, 0);
    out_kept = (frame.history_valid ? 0.5 * now + 0.5 * before : now) + 0.0 * texelFetch(small, ivec2(0), 0).r;
})");
    const std::string head = kShaderHead;
    write_text(effects_.path() / "blend_either" / "show.frag",
               head + "void main() { out_small = texelFetch(color, ivec2(0), 0).r; }\n");
    write_text(effects_.path() / "blend_either" / "out.frag",
               head + "void main() { out_color = texelFetch(kept, ivec2(gl_FragCoord.xy), 0); }\n");
    // The key at frame 2 gives a texture another size.
    Bench bench(effects_, look_of(R"({ "effect": "blend_either",
        "params": { "size": { "keys": { "1": 2, "2": 4 }, "interpolation": "step" } } })"));
    step(bench, grey(1, 8));
    EXPECT_EQ(step(bench, grey(2, 4)), std::pair(6.0f, std::string()));
}

class SavedHistories : public History {
protected:
    std::string refusal(Bench& bench, const Capture& capture) {
        try {
            bench.renderer().load_history(file_);
            step(bench, capture);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            return error.what();
        }
        return "";
    }
    void save_after(int frame) {
        Bench bench(effects_, look_);
        step(bench, grey(frame, 8));
        bench.renderer().save_history(file_);
    }
    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "chunk.history";
};

TEST_F(SavedHistories, GoOnBitForBitInThreeChunks) {
    std::vector<Image> whole, chunked;
    const auto capture = [](int frame) { return grey(frame, 0.1f * float(frame) + 1.0f / float(frame)); };
    Bench one(effects_, look_);
    for (int frame = 1; frame <= 12; ++frame) whole.push_back(one.color(capture(frame)));
    for (int chunk = 0; chunk < 3; ++chunk) {
        Bench bench(effects_, look_);
        if (chunk > 0) bench.renderer().load_history(file_);
        for (int frame = chunk * 4 + 1; frame <= chunk * 4 + 4; ++frame)
            chunked.push_back(bench.color(capture(frame)));
        bench.renderer().save_history(file_);
    }
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_TRUE(
            std::equal(whole[i].floats().begin(), whole[i].floats().end(), chunked[i].floats().begin()))
            << "frame " << i + 1;
}

TEST_F(SavedHistories, AreRefusedForAnotherFrameSizeLookOrVersion) {
    save_after(4);
    {
        Bench bench(effects_, look_);
        EXPECT_NE(refusal(bench, grey(7, 1))
                      .find("this history is of frame 4; it continues with frame 5, not "
                            "with 7"),
                  std::string::npos);
    }
    {
        Bench bench(effects_, look_);
        EXPECT_NE(refusal(bench, grey(5, 1, 16)).find("its window is 8x4 at (0, 0), that of frame 5 is 16x4"),
                  std::string::npos);
    }
    {
        Bench bench(effects_, look_of(R"({ "effect": "blend", "name": "other" })"));
        EXPECT_NE(refusal(bench, grey(5, 1)).find("saved: step blend: effect blend 1.0.0; now: step other"),
                  std::string::npos);
    }
    std::string manifest = kBlendManifest;
    std::filesystem::remove_all(effects_.path() / "blend" / "effect.json");
    write_text(
        effects_.path() / "blend" / "effect.json",
        R"({ "aftershade": 1, "version": "2.0.0", "summary": "A test.", "id": "blend",)" + manifest + "}");
    Bench newer(effects_, look_);
    EXPECT_NE(refusal(newer, grey(5, 1)).find("effect blend 1.0.0; now: step blend: effect blend 2.0.0"),
              std::string::npos);
}

TEST_F(SavedHistories, ThatAreDamagedOrNoneAreRefused) {
    save_after(4);
    const std::string bytes = read_text(file_);
    const auto refused = [&](const std::string& content) {
        write_text(file_, content);
        Bench bench(effects_, look_);
        return refusal(bench, grey(5, 1));
    };
    EXPECT_NE(refused(bytes.substr(0, bytes.size() - 9)).find("is damaged"), std::string::npos);
    std::string flipped = bytes;
    flipped[bytes.size() - 40] = char(flipped[bytes.size() - 40] ^ 1);
    EXPECT_NE(refused(flipped).find("is damaged"), std::string::npos);
    EXPECT_NE(refused("EXR").find("not a history file of save_history()"), std::string::npos);
    EXPECT_EQ(refused(bytes), "") << "the whole file is taken";
}

TEST(Subframes, AreAccumulatedByTheStepsBeforeAndSeenOnceByThoseAfter) {
    EffectFolder effects;
    effects.add("average", R"(
        "accumulates": "subframes",
        "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "textures": { "total": { "format": "rgba32f", "history": true, "doc": "Sum of the sub-frames." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "total.prev"],
                      "writes": ["total"] },
                    { "name": "show", "shader": "show.frag", "reads": ["total"], "writes": ["color"] } ])",
                R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_total = texelFetch(color, p, 0) + (frame.subframe > 0 ? texelFetch(total_prev, p, 0) : vec4(0.0));
})");
    write_text(effects.path() / "average" / "show.frag",
               std::string(kShaderHead) +
                   "void main() { out_color = texelFetch(total, ivec2(gl_FragCoord.xy), 0) "
                   "/ float(frame.subframe_count); }\n");
    // Counts the frames that it has seen, in alpha; the depth is the centre's.
    effects.add("count", R"(
        "inputs": { "color": { "role": "color" }, "depth": { "role": "depth" } },
        "outputs": { "color": { "role": "color" } },
        "textures": { "seen": { "format": "r32f", "history": true, "doc": "Frames so far." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["seen.prev"], "writes": ["seen"] },
                    { "name": "show", "shader": "show.frag", "reads": ["color", "depth", "seen"],
                      "writes": ["color"] } ])",
                R"(
void main() { out_seen = (frame.history_valid ? texelFetch(seen_prev, ivec2(gl_FragCoord.xy), 0).r : 0.0) + 1.0; })");
    write_text(effects.path() / "count" / "show.frag", std::string(kShaderHead) + R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_color = vec4(texelFetch(color, p, 0).r, texelFetch(depth, p, 0).r, 0.0, texelFetch(seen, p, 0).r);
})");
    Bench bench(effects, look_of(R"({ "effect": "average" }, { "effect": "count" })"));
    for (int number = 1; number <= 3; ++number) {
        std::vector<Capture> captures;
        float sum = 0;
        for (int s = 0; s < 4; ++s) {
            SyntheticScene scene;
            scene.width = 6;
            scene.height = 4;
            const float value = float(number * 10 + s);
            scene.background = {value, 0, 0};
            scene.background_depth_m = value;
            captures.push_back(make_capture(scene, number));
            sum += value;
        }
        FrameResult result;
        for (int s = 0; s < 4; ++s) {
            FrameInputs frame;
            frame.capture = &captures[std::size_t(s)];
            frame.centre = &captures[std::size_t(std::min(s, 2))];
            frame.subframe = s;
            frame.subframe_count = 4;
            result = bench.run(frame);
            EXPECT_EQ(result.images.empty(), s < 3);
        }
        const Image& color = result.images.at("color");
        EXPECT_EQ(color.at(2, 2, 0), sum / 4) << number;
        EXPECT_EQ(color.at(2, 2, 1), float(number * 10 + 2)) << "the middle of the exposure";
        EXPECT_EQ(color.at(2, 2, 3), float(number)) << "once a frame";
    }
}

}  // namespace
}  // namespace aftershade::test
