// Fused passes against the same passes drawn one by one.
#include <cstring>

#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

EffectRegistry& shipped() {
    static EffectRegistry effects({std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "effects"});
    return effects;
}

/// Colours of every kind: above 1, below 0, without coverage, half covered.
constexpr int kColourfulWidth = 53, kColourfulHeight = 31;

Capture colourful(int width = kColourfulWidth, int height = kColourfulHeight) {
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = 4});
    std::uint32_t state = 17;
    for (float& value : capture.images.at("color").floats())
        value = float(std::int32_t(state = state * 1664525u + 1013904223u)) * 2e-9f + 0.5f;
    Image& color = capture.images.at("color");
    for (int x = 0; x < width; ++x) color.at(x, 3, 3) = x % 2 ? 0.0f : 0.5f;
    return capture;
}

bool same_bits(const Image& a, const Image& b) {
    return a.floats().size() == b.floats().size() &&
           std::memcmp(a.floats().data(), b.floats().data(), a.floats().size_bytes()) == 0;
}

/// Frames of a look, fused or apart, with what ran.
struct LookRun {
    std::vector<FrameResult> frames;
    std::vector<std::string> passes;  // of the last frame
    std::pair<std::uint64_t, std::uint64_t> bytes;
};

struct RunChoices {
    bool fuses = true;
    bool audits = false;
    int frames = 1;
    std::vector<std::string> taps{};
};

class FusionOn : public gpu::OnEachBackend {
protected:
    LookRun run(const EffectFolder& effects, const std::string& steps, const RunChoices& choices = {}) {
        PipelineOptions options;
        for (const std::string& tap : choices.taps) options.taps.push_back(tap);
        Bench bench(effects, look_of(steps), options, GetParam(),
                    {.fuses_passes = choices.fuses, .audits = choices.audits});
        LookRun result;
        Capture capture = colourful();
        for (int i = 0; i < choices.frames; ++i) {
            capture.header.frame = i + 1;
            FrameInputs frame;
            frame.capture = &capture;
            result.frames.push_back(bench.renderer().render(frame, {"color", "display"}, true));
        }
        for (const graph::PassTime& time : result.frames.back().times)
            if (time.pass != "upload" && time.pass != "readback") result.passes.push_back(time.pass);
        result.bytes = bench.renderer().graph_bytes();
        return result;
    }

    /// The run that is fused, after both gave the same bits.
    LookRun run_both(const EffectFolder& effects, const std::string& steps, RunChoices choices = {}) {
        LookRun fused = run(effects, steps, choices);
        choices.fuses = false;
        const LookRun apart = run(effects, steps, choices);
        for (std::size_t i = 0; i < fused.frames.size(); ++i) {
            for (const auto& [role, image] : apart.frames[i].images)
                EXPECT_TRUE(same_bits(fused.frames[i].images.at(role), image)) << role << " of " << steps;
            for (const auto& [name, image] : apart.frames[i].taps)
                EXPECT_TRUE(same_bits(fused.frames[i].taps.at(name), image)) << name << " of " << steps;
        }
        // Apart, a result may lie in the memory of the capture's colour, which nothing reads any more; a
        // fused pass reads it while it writes them all.
        const std::uint64_t color_bytes = 16ull * kColourfulWidth * kColourfulHeight;
        EXPECT_LE(fused.bytes.first, apart.bytes.first + color_bytes);
        EXPECT_LE(fused.bytes.second, apart.bytes.second);
        return fused;
    }

    EffectFolder none_;
};
ON_EACH_BACKEND(FusionOn);

/// Shipped effects that take their colour by the pixel, and nothing else that a capture of colour lacks.
std::vector<const EffectManifest*> pointwise_effects() {
    std::vector<const EffectManifest*> found;
    Diagnostics faults;
    for (const std::string& id : shipped().ids()) {
        const EffectManifest* manifest = shipped().find(id, faults);
        if (!manifest || manifest->passes.empty()) continue;
        const auto takes_color = [](const ReadSpec& read) { return read.is_pixel && read.name == "color"; };
        const auto needs_more = [](const InputSpec& input) {
            return !input.optional && input.role != "color";
        };
        if (std::ranges::any_of(manifest->passes.back().reads, takes_color) &&
            std::ranges::none_of(manifest->inputs, needs_more))
            found.push_back(manifest);
    }
    return found;
}

std::string step_of(const EffectManifest& manifest, const std::string& name) {
    const std::string preset =
        manifest.presets.empty() ? "" : R"(, "preset": ")" + manifest.presets.front().name + '"';
    return R"({ "effect": ")" + manifest.id + R"(", "name": ")" + name + '"' + preset + "}";
}

bool makes_color(const EffectManifest& manifest) {
    return std::ranges::any_of(manifest.outputs,
                               [](const OutputSpec& output) { return output.role == "color"; });
}

TEST_P(FusionOn, EveryPairOfShippedPointwiseEffectsGivesTheBitsOfBothApart) {
    const auto effects = pointwise_effects();
    ASSERT_GE(effects.size(), 4u);
    for (const EffectManifest* first : effects) {
        if (!makes_color(*first)) continue;
        for (const EffectManifest* second : effects) {
            const LookRun fused =
                run_both(none_, step_of(*first, "first") + ", " + step_of(*second, "second"));
            EXPECT_NE(fused.passes.back().find("+second."), std::string::npos)
                << first->id << " and " << second->id << " end in " << fused.passes.back();
        }
    }
}

const std::string kTail = R"({ "effect": "chromatic_aberration" }, { "effect": "vignette" },
    { "effect": "film_grain" }, { "effect": "color_grade", "preset": "bleach" },
    { "effect": "view_transform", "params": { "transform": "agx" } })";

TEST_P(FusionOn, TheFilmLooksTailIsOnePassFromTheLensToTheView) {
    const LookRun fused = run_both(none_, kTail);
    ASSERT_FALSE(fused.passes.empty());
    EXPECT_TRUE(fused.passes.back().starts_with("chromatic_aberration.fringe+vignette.vignette+"))
        << fused.passes.back();
    EXPECT_TRUE(fused.passes.back().ends_with("+color_grade.grade+view_transform.view"))
        << fused.passes.back();
}

TEST_P(FusionOn, ATapIsWrittenBesidesAndAnAuditSeesEachPassAlone) {
    const LookRun tapped = run_both(none_, kTail, {.taps = {"film_grain.color"}});
    EXPECT_TRUE(tapped.frames[0].taps.contains("film_grain.color"));
    const LookRun audited = run(none_, kTail, {.audits = true});
    for (const std::string& pass : audited.passes) EXPECT_EQ(pass.find('+'), std::string::npos) << pass;
    EXPECT_TRUE(same_bits(audited.frames[0].images.at("display"), tapped.frames[0].images.at("display")));
}

TEST_P(FusionOn, AMixedOrMaskedStepEndsAFusedPass) {
    for (const std::string extra : {R"("mix": 0.25)", R"("mask": { "role": "depth" })"}) {
        const LookRun fused =
            run_both(none_, R"({ "effect": "vignette" }, { "effect": "color_grade", "preset": "warm", )" +
                                extra + R"( }, { "effect": "view_transform" })");
        EXPECT_GE(fused.passes.size(), 3u) << extra;
    }
}

TEST_P(FusionOn, KeyedParametersChangeFromFrameToFrame) {
    run_both(none_,
             R"({ "effect": "vignette", "params": { "strength": { "keys": { "1": 0, "3": 1 } } } },
                { "effect": "film_grain" })",
             {.frames = 3});
}

TEST_P(FusionOn, AStepTwiceKeepsItsTwoSetsOfParameters) {
    run_both(none_, R"({ "effect": "vignette", "params": { "strength": 0.9 } },
                       { "effect": "color_grade", "params": { "range": "cdl", "saturation": 0.5 } },
                       { "effect": "vignette", "name": "again", "params": { "strength": 0.1, "roundness": 1 } },
                       { "effect": "color_grade", "name": "last", "params": { "contrast": 1.5 } })");
}

/// Mixes the picture with its own last result, kept under a name of its own.
void add_trail(EffectFolder& effects) {
    effects.add("trail",
                R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "textures": { "kept": { "format": "rgba32f", "history": true, "doc": "The last result." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": [{ "color": "pixel" }, { "kept.prev": "pixel" }],
                      "writes": ["color", "kept"] } ])",
                "void main() { out_kept = 0.5 * color + 0.5 * kept_prev; out_color = out_kept; }\n");
}

TEST_P(FusionOn, AHistoryGoesOnInsideAFusedPass) {
    EffectFolder effects;
    add_trail(effects);
    const LookRun fused =
        run_both(effects, R"({ "effect": "vignette" }, { "effect": "trail" }, { "effect": "film_grain" })",
                 {.frames = 3});
    EXPECT_EQ(fused.passes.back(), "vignette.vignette+trail.main+film_grain.grain");
}

TEST_P(FusionOn, AParameterChangesWithoutACompile) {
    const EffectManifest& vignette = *[] {
        Diagnostics faults;
        return shipped().find("vignette", faults);
    }();
    ASSERT_TRUE(vignette.find_param("strength"));
    gpu::Context context(GetParam());
    const auto programs = std::make_shared<ProgramCache>(
        context, std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "glsl", ProgramStore());
    const Capture capture = colourful();
    FrameInputs frame;
    frame.capture = &capture;
    std::vector<Image> images;
    for (const char* strength : {"0.2", "0.9"}) {
        const Bound bound(none_, look_of(R"({ "effect": "vignette", "params": { "strength": )" +
                                         std::string(strength) + R"( } }, { "effect": "view_transform" })"));
        PipelineRenderer renderer(context, bound.pipeline(), programs);
        images.push_back(renderer.render(frame, {"display"}, false).images.at("display"));
        EXPECT_EQ(programs->compiled_count(), 1) << strength;
    }
    EXPECT_FALSE(same_bits(images[0], images[1]));
}

TEST_P(FusionOn, APixelOfAPointwiseEffectDependsOnNoOther) {
    for (const EffectManifest* effect : pointwise_effects()) {
        if (effect->passes.size() > 1) continue;
        Bench bench(none_, look_of(step_of(*effect, "alone")), {}, GetParam());
        Capture capture = colourful();
        const std::string role = effect->outputs[0].role;
        const Image before = bench.run(capture).images.at(role);
        const int x = 20, y = 11;
        for (int c = 0; c < 4; ++c) capture.images.at("color").at(x, y, c) = 0.125f * float(c + 1);
        const Image after = bench.run(capture).images.at(role);
        for (int row = 0; row < before.height(); ++row)
            for (int column = 0; column < before.width(); ++column) {
                if (row == y && column == x) continue;
                for (int c = 0; c < before.channels(); ++c)
                    ASSERT_EQ(std::memcmp(&before.floats()[std::size_t(
                                              (row * before.width() + column) * before.channels() + c)],
                                          &after.floats()[std::size_t(
                                              (row * before.width() + column) * before.channels() + c)],
                                          sizeof(float)),
                              0)
                        << effect->id << " at " << column << ", " << row;
            }
    }
}

TEST_P(FusionOn, AShaderThatSamplesWhatItReadsByThePixelDoesNotCompile) {
    EffectFolder effects;
    effects.add("liar",
                R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": [{ "color": "pixel" }], "writes": ["color"] } ])",
                "void main() { out_color = texelFetch(color, ivec2(gl_FragCoord.xy) + 1, 0); }\n");
    try {
        run(effects, R"({ "effect": "liar" }, { "effect": "vignette" })");
        FAIL() << "it ran";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("by the pixel: it is the texel itself, no sampler"),
                  std::string::npos)
            << error.what();
    }
}

TEST_P(FusionOn, AShaderThatMayDiscardAPixelStaysAlone) {
    EffectFolder effects;
    effects.add("holes",
                R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": [{ "color": "pixel" }], "writes": ["color"] } ])",
                "void main() { if (color.a > 2.0) discard; out_color = color; }\n");
    const LookRun fused = run_both(effects, R"({ "effect": "vignette" }, { "effect": "holes" })");
    EXPECT_EQ(fused.passes.back(), "holes.main");
}

}  // namespace
}  // namespace aftershade::test
