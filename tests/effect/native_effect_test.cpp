#include "framework/effect/native/native_effect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "framework/base/error.h"
#include "framework/effect/native/native_library.h"

namespace aftershade {

std::span<const StaticNativeLibrary> test_native_libraries();

namespace {

/// A frame with one float parameter.
struct Frame {
    explicit Frame(const std::string& name, double value) {
        specs.resize(1);
        specs[0].name = name;
        values.set(name, value);
        frame.specs = &specs;
        frame.params = &values;
        frame.number = 12;
    }
    std::vector<ParamSpec> specs;
    ParamSet values;
    NativeFrame frame;
};

std::string failure(NativeEffect& effect, const NativeFrame& frame) {
    try {
        effect.prepare(frame);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::effect);
        return error.what();
    }
    return "no failure";
}

NativeRegistry& cases() {
    static NativeRegistry registry({AFTERSHADE_CASES}, test_native_libraries());
    return registry;
}

NativeRegistry& examples() {
    static NativeRegistry registry({AFTERSHADE_EXAMPLES}, {});
    return registry;
}

double gain_of(const NativeResult& result) {
    return std::get<std::vector<float>>(result.uniforms.at("gain")).at(0);
}

TEST(NativeEffect, FillsUniformsThroughLibrariesOfEveryMinorAndLinkedOnes) {
    Frame frame("gain", 0.5);
    for (const auto& [id, gain] :
         {std::pair{"older", 6.0}, std::pair{"newer", 6.0}, std::pair{"linked_demo", 12.0}}) {
        NativeEffect effect(cases(), {id, "1.0.0", {{"gain", {}}}, {}, {}}, "grade");
        EXPECT_EQ(gain_of(effect.prepare(frame.frame)), gain) << id;
        effect.reset();
    }
}

TEST(NativeEffect, HoldsUniformsAgainstTheDeclaration) {
    Frame frame("gain", 0.5);
    NativeEffect misspelt(cases(), {"older", "1.0.0", {{"gian", {}}}, {}, {}}, "grade");
    const std::string text = failure(misspelt, frame.frame);
    for (const char* part :
         {"step 'grade'", "older.so", "frame 12", "uniform 'gain' is not declared", "did you mean 'gian'?"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    NativeEffect wider(cases(), {"older", "1.0.0", {{"gain", {NativeScalar::float_, 3}}}, {}, {}}, "grade");
    EXPECT_NE(failure(wider, frame.frame).find("is set as float, effect.json declares vec3"),
              std::string::npos);
    NativeEffect more(cases(), {"linked_demo", "1.0.0", {{"gain", {}}, {"bias", {}}}, {}, {}}, "grade");
    EXPECT_NE(failure(more, frame.frame).find("uniform 'bias' is declared in effect.json and was not set"),
              std::string::npos);
    Frame other("gian", 0.5);
    NativeEffect effect(cases(), {"older", "1.0.0", {{"gain", {}}}, {}, {}}, "grade");
    EXPECT_NE(failure(effect, other.frame).find("asked for the parameter 'gain'"), std::string::npos);
    Frame nan("gain", std::nan(""));
    EXPECT_NE(failure(effect, nan.frame).find("'gain' is NaN"), std::string::npos);
    EXPECT_EQ(gain_of(effect.prepare(frame.frame)), 6.0) << "a failed frame does not spoil the next";
}

TEST(NativeEffect, ReportsAnExceptionThatCrossesTheBoundary) {
    Frame frame("gain", 0.5);
    NativeEffect effect(cases(), {"throws", "1.0.0", {{"gain", {}}}, {}, {}}, "grade");
    const std::string text = failure(effect, frame.frame);
    EXPECT_NE(text.find("threw an exception: no luck today"), std::string::npos) << text;
    EXPECT_NE(text.find("throws.so"), std::string::npos) << text;
}

NativeDeclaration gauss(int width) {
    return {"gauss_table",
            "1.0.0",
            {{"radius", {NativeScalar::int_, 1}}},
            {{"kernel", {NativeElement::float_, width, 1}}},
            {}};
}

TEST(ExamplePlugins, TheGaussianTableIsTheGaussian) {
    const double sigma = 2.5;
    Frame frame("sigma", sigma);
    NativeEffect effect(examples(), gauss(65), "blur");
    const NativeResult result = effect.prepare(frame.frame);
    const NativeTable& table = result.tables.at("kernel");
    ASSERT_EQ(table.width, 17);  // 2 * ceil(3 * 2.5) + 1
    EXPECT_EQ(result.overscan_px, 8);
    std::vector<float> kernel(17);
    std::memcpy(kernel.data(), table.bytes.data(), table.bytes.size());
    double sum = 0;
    for (const float weight : kernel) sum += weight;
    EXPECT_NEAR(sum, 1, 1e-6);
    // A Gaussian cut at 3.2 sigma keeps all but 0.14 % of its integral, which is known in closed form.
    const double inside = std::erf(8.5 / (sigma * std::sqrt(2)));
    EXPECT_NEAR(kernel[8], 1 / (sigma * std::sqrt(2 * std::acos(-1)) * inside), 1e-4);
    EXPECT_NEAR(kernel[8 + 5] / kernel[8], std::exp(-2), 1e-6);  // two sigma away
}

TEST(ExamplePlugins, ATableAboveItsDeclaredSizeIsRefusedWithTheLimit) {
    Frame frame("sigma", 2.5);
    NativeEffect effect(examples(), gauss(9), "blur");
    const std::string text = failure(effect, frame.frame);
    EXPECT_NE(text.find("table 'kernel' is 17 x 1, the limit of effect.json is 9 x 1"), std::string::npos)
        << text;
}

TEST(ExamplePlugins, TheGainFollowsTheCamerasApertureOrSaysThatThereIsNone) {
    Frame frame("reference_f_number", 2.8);
    NativeEffect effect(examples(), {"adapt", "1.0.0", {{"gain", {}}}, {}, {}}, "lens");
    NativeResult result = effect.prepare(frame.frame);
    EXPECT_EQ(gain_of(result), 1);
    ASSERT_EQ(result.log.size(), 1U);
    EXPECT_EQ(result.log[0].level, NativeLogLevel::warning);
    Camera camera;
    camera.set("f_number", 5.6);
    frame.frame.camera = &camera;
    result = effect.prepare(frame.frame);
    EXPECT_NEAR(gain_of(result), 0.25, 1e-7);
    EXPECT_TRUE(result.log.empty());
}

}  // namespace
}  // namespace aftershade
