// Scattered light in the picture: against the formulas in double, bit for bit where nothing scattered, and
// against the renderer's scattering.
#include <cmath>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "framework/scene/scene_renderer.h"
#include "tests/backends.h"
#include "tests/render/effect_fixture.h"
#include "tests/scene/scene_text.h"

namespace aftershade::test::sss_combine {
namespace {

/// Light, albedo and the rest all differ from pixel to pixel and channel to channel; black and white too.
Capture varied() {
    Capture capture = make_capture({.width = 32, .height = 20});
    auto& images = capture.images;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 32; ++x)
            for (int c = 0; c < 3; ++c) {
                const float albedo =
                    x < 2 ? float(x) : 0.5f + 0.45f * std::sin(float(x * (c + 2)) + float(y));
                const float light = y == 0 ? 0 : std::exp(2 * std::cos(float(x) * 0.7f + float(y * (3 - c))));
                images.at("albedo").at(x, y, c) = albedo;
                images.at("irradiance").at(x, y, c) = light;
                images.at("color").at(x, y, c) = albedo * light + 0.3f * float(c);
            }
    // What only a comparison of bits sees.
    images.at("color").at(5, 5, 0) = -0.0f;
    return capture;
}

std::string with(const std::string& effect, const std::string& texturing, const std::string& more = "") {
    return R"({ "effect": ")" + effect + R"(", "params": { "texturing": ")" + texturing + "\" }" + more +
           " }";
}

/// "scatter" stands for an effect that scatters: half the light, and half the next pixel's. From column 16 on
/// it leaves the light as it is.
class SssCombine : public gpu::OnEachBackend {
protected:
    SssCombine() {
        effects_.add("scatter",
                     R"("inputs": { "irradiance": { "role": "irradiance" } },
                        "outputs": { "irradiance": { "role": "irradiance" } },
                        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["irradiance"],
                                      "writes": ["irradiance"] } ])",
                     "void main() {\n    ivec2 p = ivec2(gl_FragCoord.xy);\n"
                     "    vec4 here = texelFetch(irradiance, p, 0);\n"
                     "    vec4 next = texelFetch(irradiance, p + ivec2(1, 0), 0);\n"
                     "    out_irradiance = p.x < 16 ? 0.5 * here + 0.5 * next : here;\n}\n");
        effects_.add(
            "brighten",
            R"("inputs": { "irradiance": { "role": "irradiance" } },
                        "outputs": { "irradiance": { "role": "irradiance" } },
                        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["irradiance"],
                                      "writes": ["irradiance"] } ])",
            "void main() { out_irradiance = 2.0 * texelFetch(irradiance, ivec2(gl_FragCoord.xy), 0); }\n");
    }
    Image color(const std::string& steps, const Capture& capture) const {
        return Bench(effects_, look_of(steps), {}, GetParam()).color(capture);
    }
    EffectFolder effects_;
};

constexpr const char* kTexturings[] = {"post", "pre_and_post", "pre"};
constexpr const char* kScatter = R"(, { "effect": "scatter" }, )";

TEST_P(SssCombine, IsTheFormulaOfEachTexturing) {
    const Capture capture = varied();
    const auto& images = capture.images;
    const double before_power[] = {0, 0.5, 1};
    for (int k = 0; k < 3; ++k) {
        const Image got = color(
            with("sss_prepare", kTexturings[k]) + kScatter + with("sss_combine", kTexturings[k]), capture);
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 16; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto albedo = [&](int at) { return double(images.at("albedo").at(at, y, c)); };
                    const auto prepared = [&](int at) {
                        return std::pow(albedo(at), before_power[k]) * images.at("irradiance").at(at, y, c);
                    };
                    const double scattered = 0.5 * prepared(x) + 0.5 * prepared(x + 1);
                    const double expected = images.at("color").at(x, y, c) +
                                            std::pow(albedo(x), 1 - before_power[k]) * scattered -
                                            albedo(x) * images.at("irradiance").at(x, y, c);
                    // Light is below 8: some roundings of 8 * 2^-24.
                    ASSERT_NEAR(got.at(x, y, c), expected, 3e-6) << kTexturings[k] << " " << x << " " << y;
                }
    }
}

TEST_P(SssCombine, LeavesWhatDidNotScatterBitForBit) {
    const Capture capture = varied();
    const Image& before = capture.images.at("color");
    for (const char* texturing : kTexturings) {
        const Image got =
            color(with("sss_prepare", texturing) + kScatter + with("sss_combine", texturing), capture);
        int changed = 0;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 32; ++x)
                for (int c = 0; c < 4; ++c) {
                    const float a = before.at(x, y, c), b = got.at(x, y, c);
                    const bool same = std::memcmp(&a, &b, sizeof a) == 0;
                    if (x >= 16 || c == 3) ASSERT_TRUE(same) << texturing << " " << x << " " << y << " " << c;
                    else changed += !same;
                }
        EXPECT_GT(changed, 16 * 19 * 2) << texturing;
        const Image alone =
            color(with("sss_prepare", texturing) + ", " + with("sss_combine", texturing), capture);
        EXPECT_EQ(std::memcmp(alone.floats().data(), before.floats().data(), before.floats().size_bytes()), 0)
            << texturing;
    }
}

TEST_P(SssCombine, TakesItsTexturingFromTheVariableThatPrepareHas) {
    const Capture capture = varied();
    const std::string texturing = R"("params": { "texturing": { "var": "texturing" } })";
    const std::string look = R"({ "aftershade": 1, "vars": { "texturing": "pre" }, "steps": [
        { "effect": "sss_prepare", )" +
                             texturing + " }" + kScatter + R"({ "effect": "sss_combine", )" + texturing +
                             " } ] }";
    const Image got = Bench(effects_, look, {}, GetParam()).color(capture);
    const Image same = color(with("sss_prepare", "pre") + kScatter + with("sss_combine", "pre"), capture);
    EXPECT_EQ(std::memcmp(got.floats().data(), same.floats().data(), got.floats().size_bytes()), 0);
}

TEST_P(SssCombine, LeavesLightAsItIsInAPictureWithoutAScatteringStep) {
    const Capture capture = varied();
    const Image got = color(R"({ "effect": "sss_combine" })", capture);
    EXPECT_EQ(std::memcmp(got.floats().data(), capture.images.at("color").floats().data(),
                          got.floats().size_bytes()),
              0);
}

/// The capture's irradiance is what its colour has, whichever steps made irradiance since.
TEST_P(SssCombine, TakesOutTheCapturesOwnLightUnlessTheLookSaysOtherwise) {
    const Capture capture = varied();
    const std::string brighten = R"({ "effect": "brighten" }, )";
    const Image added = color(brighten + R"({ "effect": "sss_combine" })", capture);
    const Image wired = color(
        brighten + R"({ "effect": "sss_combine", "in": { "unscattered": "brighten.irradiance" } })", capture);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 32; ++x)
            for (int c = 0; c < 3; ++c) {
                const float own = capture.images.at("color").at(x, y, c);
                const float diffuse =
                    capture.images.at("albedo").at(x, y, c) * capture.images.at("irradiance").at(x, y, c);
                ASSERT_NEAR(added.at(x, y, c), own + diffuse, 2e-6) << x << " " << y;
                ASSERT_EQ(wired.at(x, y, c), own) << x << " " << y;
            }
}

/// With the renderer's scattered light it makes the renderer's scattered colour.
TEST_P(SssCombine, MakesTheRenderersPictureOfItsScatteredLight) {
    const scene::Scene scene = scene::shipped_scene("plane_edge");
    const scene::SceneRenderer renderer(scene, 96, 8, 2);
    Capture capture = renderer.render_capture(1);
    const scene::ScatteringTruth truth = renderer.render_scattering(1, {512});
    // Handed over as another role of three channels, which a step then names irradiance.
    capture.images.at("emission") = truth.irradiance;
    EffectFolder effects;
    effects.add("hand_over",
                R"("inputs": { "emission": { "role": "emission" } },
                   "outputs": { "irradiance": { "role": "irradiance" } },
                   "passes": [ { "name": "main", "shader": "main.frag", "reads": ["emission"],
                                 "writes": ["irradiance"] } ])",
                "void main() { out_irradiance = texelFetch(emission, ivec2(gl_FragCoord.xy), 0); }\n");
    const Image got =
        Bench(effects, look_of(R"({ "effect": "hand_over" }, { "effect": "sss_combine" })"), {}, GetParam())
            .color(capture);
    double farthest = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 96; ++x)
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(got.at(x, y, c), truth.color.at(x, y, c), 1e-6) << x << " " << y;
                farthest = std::max(farthest, std::abs(double(truth.color.at(x, y, c)) -
                                                       capture.images.at("color").at(x, y, c)));
            }
    EXPECT_GT(farthest, 0.1) << "the scene scatters";
}

ON_EACH_BACKEND(SssCombine);

}  // namespace
}  // namespace aftershade::test::sss_combine
