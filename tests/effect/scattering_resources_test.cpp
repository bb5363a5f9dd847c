#include <algorithm>
#include <cmath>
#include <numbers>

#include "framework/effect/param_resources.h"
#include "framework/effect/param_types.h"
#include "framework/scattering/param_scattering.h"
#include "tests/document/param_specs.h"
#include "tests/effect/param_resources_on.h"
#include "tests/reference/burley.h"

namespace aftershade {
namespace {

using test::ids_of;
using test::spec_of;
using test::value_of;
using test::Vec4;

class ObjectsOn : public test::ParamResourcesOn {};
ON_EACH_BACKEND(ObjectsOn);

TEST_P(ObjectsOn, SayWhetherAListHasAnObject) {
    const ParamSpec spec = spec_of(R"({"type": "objects", "default": [], "doc": "."})", "object_ids");
    const std::string glsl = param_table_glsl(spec, 3);
    std::vector<Vec4> inputs;
    for (int id = 0; id < 64; ++id) inputs.push_back({float(id), 0, 0, 0});
    inputs.push_back({65535, 65535, 0, 0});
    const auto listed = [&](const std::string& list) {
        const gpu::Buffer buffer =
            uploaded(table_buffer(spec, std::get<TableValue>(value_of(spec, list)), ids_of({{"Ear", 40}})));
        std::vector<int> ids;
        const auto outputs = computed(glsl, "vec4(object_ids(uint(v.x) + (uint(v.y) << 16)) ? 1.0 : 0.0)",
                                      inputs, nullptr, &buffer);
        for (std::size_t i = 0; i < inputs.size(); ++i)
            if (outputs[i][0] == 1) ids.push_back(int(i));
        return ids;
    };
    EXPECT_EQ(listed(R"([7, "Ear", "20-22", 4294967295, 0, "Nose"])"),
              (std::vector<int>{0, 7, 20, 21, 22, 40, 64}));
    EXPECT_EQ(listed(R"(["Nose"])"), std::vector<int>{}) << "a name that is not there is not an empty list";
    EXPECT_EQ(listed("[]").size(), 65u);
}

const std::string kProfiles = R"({"default": {"type": "burley", "d_mm": [3, 0.7, 0.2]}, "rows": [
    {"objects": "1-2", "profile": "skin"}, {"object": 3, "profile": {"type": "artist", "width_mm": 2}},
    {"name": "Marble", "profile": {"type": "dipole", "absorption_per_mm": [0.0021, 0.0041, 0.0071],
                                   "reduced_scattering_per_mm": [2.19, 2.62, 3.00], "ior": 1.5}}]})";

/// The GLSL of a scattering_profile "glow" and what it reads, with the objects 0, 1, 3 and 4 for its four
/// profiles.
class ScatteringResourcesOn : public test::ParamResourcesOn {
protected:
    std::vector<Vec4> evaluated(const std::string& expression, const std::vector<Vec4>& inputs) {
        const std::string glsl = param_sampler_glsl(spec_, {}, 5) + param_table_glsl(spec_, 3);
        const gpu::Texture texture = uploaded(param_texture(spec_, given_));
        const gpu::Buffer buffer =
            uploaded(table_buffer(spec_, scattering_table(value_), ids_of({{"Marble", 4}})));
        return computed(glsl, expression, inputs, &texture, &buffer);
    }

    /// Of object v.x at v.y of the profile's reach, for the four objects and places on and between samples.
    std::vector<Vec4> places(float end) {
        std::vector<Vec4> inputs;
        for (const float object : {0.0f, 1.0f, 3.0f, 4.0f})
            for (int i = 0; i <= 200; ++i) inputs.push_back({object, end * float(i * i) / 40000, 0, 0});
        return inputs;
    }

    const ScatteringProfile& profile(float object) {
        if (object == 0) return value_.usual;
        return value_.rows[object < 3 ? 0 : std::size_t(object) - 2].second;
    }

    ParamSpec spec_ =
        spec_of(R"({"type": "scattering_profile", "default": "skin", "doc": "."})", "glow", param_types());
    ParamValue given_ = value_of(spec_, kProfiles);
    const ScatteringValue& value_ = *scattering_of(given_);
};
ON_EACH_BACKEND(ScatteringResourcesOn);

TEST_P(ScatteringResourcesOn, FindTheProfileOfAnObject) {
    const std::vector<Vec4> objects = {{0, 0, 0, 0}, {1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}, {4, 0, 0, 0}};
    const auto d = evaluated("vec4(glow(uint(v.x)).d, glow(uint(v.x)).reach)", objects);
    const auto direct = evaluated("vec4(glow(uint(v.x)).direct, float(glow(uint(v.x)).index))", objects);
    const auto falloff = evaluated("vec4(glow(uint(v.x)).falloff, 0.0)", objects);
    const std::array<float, 5> indices = {0, 1, 1, 2, 3};
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const ScatteringProfile& expected = profile(objects[i][0]);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(d[i][c], float(expected.fitted_d_mm()[c])) << i;
            EXPECT_EQ(direct[i][c], float(expected.direct[c])) << i;
            EXPECT_EQ(falloff[i][c], float(expected.fitted_falloff_mm()[c])) << i;
        }
        EXPECT_EQ(d[i][3], float(expected.reach_mm())) << i;
        EXPECT_EQ(direct[i][3], indices[i]) << "objects 1 and 2 share a profile";
    }
}

TEST_P(ScatteringResourcesOn, ReadAProfilesDensityAndShareByRadius) {
    const auto inputs = places(1.25);
    const std::string row = "glow(uint(v.x))", radius = row + ".reach * v.y";
    const auto radial = evaluated("vec4(glow_radial(" + row + ", " + radius + "), 0.0)", inputs);
    const auto within = evaluated("vec4(glow_within(" + row + ", " + radius + "), 0.0)", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const ScatteringProfile& expected = profile(inputs[i][0]);
        const double r = std::max(expected.reach_mm() * inputs[i][1], 1e-7);
        for (std::size_t c = 0; c < 3; ++c) {
            const double density = 2 * std::numbers::pi * r * expected.density(int(c), r);
            // The shares of the widest width that a profile's narrowest channel has are drawn by fewer
            // samples.
            EXPECT_NEAR(radial[i][c], inputs[i][1] > 1 ? 0 : density, 1e-3 / expected.fitted_d_mm()[c])
                << i << " " << r;
            EXPECT_NEAR(within[i][c], expected.within(int(c), r), inputs[i][1] > 1 ? 1.01e-4 : 5e-5)
                << i << " " << r;
        }
    }
}

TEST_P(ScatteringResourcesOn, ReadWhatAnEdgeLetsThrough) {
    const auto inputs = places(1.25);
    const auto line = evaluated("vec4(glow_line(glow(uint(v.x)), glow(uint(v.x)).reach * v.y), 0.0)", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const ScatteringProfile& expected = profile(inputs[i][0]);
        const double x = expected.reach_mm() * inputs[i][1];
        for (std::size_t c = 0; c < 3; ++c) {
            if (expected.type == ScatteringProfile::Type::dipole) continue;  // has no closed form
            double sum = expected.direct[c];
            if (expected.type == ScatteringProfile::Type::burley)
                sum = reference::burley_edge_response(x, expected.d_mm[c]);
            for (const ScatteringGaussian& gaussian : expected.gaussians)
                sum +=
                    gaussian.weight[c] * (0.5 + 0.5 * std::erf(x / std::sqrt(2 * gaussian.variance_mm2[c])));
            EXPECT_NEAR(line[i][c], sum, 1e-4) << i << " " << x;
        }
    }
}

TEST_P(ScatteringResourcesOn, ReadItsGaussians) {
    std::vector<Vec4> inputs;
    for (const float object : {0.0f, 1.0f, 3.0f, 4.0f})
        for (int k = 0; k < int(ScatteringProfile::kMaxGaussians); ++k)
            inputs.push_back({object, float(k), 0, 0});
    const auto variance = evaluated("vec4(glow_variance(glow(uint(v.x)), int(v.y)), GLOW_GAUSSIANS)", inputs);
    const auto weight = evaluated("vec4(glow_weight(glow(uint(v.x)), int(v.y)), 0.0)", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto gaussians = profile(inputs[i][0]).as_gaussians();
        const auto k = std::size_t(inputs[i][1]);
        EXPECT_EQ(variance[i][3], 8);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(weight[i][c], k < gaussians.size() ? float(gaussians[k].weight[c]) : 0) << i;
            EXPECT_EQ(variance[i][c], k < gaussians.size() ? float(gaussians[k].variance_mm2[c]) : 1) << i;
        }
    }
}

}  // namespace
}  // namespace aftershade
