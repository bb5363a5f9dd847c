#include "framework/effect/param_resources.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "framework/document/param_types/curve.h"
#include "framework/file/png_file.h"
#include "tests/document/param_specs.h"
#include "tests/effect/param_resources_on.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

using test::ids_of;
using test::spec_of;
using test::value_of;
using test::Vec4;

constexpr std::size_t kCount = 1000;

/// kCount random inputs between `low` and `high`, some of them on the lattice of eighths.
std::vector<Vec4> random_inputs(float low, float high) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> value(low, high);
    std::vector<Vec4> inputs(kCount);
    for (std::size_t i = 0; i < kCount; ++i)
        for (float& x : inputs[i]) x = i % 8 == 0 ? std::round(value(random) * 8) / 8 : value(random);
    return inputs;
}

class ParamResourcesOn : public test::ParamResourcesOn {};
ON_EACH_BACKEND(ParamResourcesOn);

ParamSpec curve_spec() {
    return spec_of(R"({"type": "curve", "domain": [-2, 3], "default": [[0, 0]], "doc": "."})", "falloff");
}

TEST_P(ParamResourcesOn, ReadACurveWithinTheBoundThatTheHeaderGives) {
    const ParamSpec spec = curve_spec();
    const std::string points = R"("points": [[-1.5, 1], [-0.5, 4], [0.75, 0], [2.5, 0.5]])";
    const double h = 5.0 / (kCurveSamples - 1);
    const double rounding = 4e-6;
    for (const std::string form : {"linear", "smooth"}) {
        const bool is_smooth = form == "smooth";
        const auto curve =
            std::get<CurveValue>(value_of(spec, "{" + points + R"(, "interpolation": ")" + form + "\"}"));
        // Corners: at -0.5 the slope turns from 3 to -3.2, of the smooth curve at -1.5 from 0 to 3. Its
        // largest second derivative is that of the fall from 4 to 0 over 1.25, 6 * 4 / 1.25^2.
        const double corner = h / 4 * (is_smooth ? 3 : 6.2) + rounding;
        const double smooth = (is_smooth ? h * h / 8 * 6 * 4 / 1.25 / 1.25 : h / 4 * 6.2) + rounding;
        const gpu::Texture texture = uploaded(param_texture(spec, curve));
        const auto inputs = random_inputs(-3, 4);
        const auto outputs =
            computed(param_sampler_glsl(spec, {}, 5), "vec4(falloff(v.x))", inputs, &texture);
        for (std::size_t i = 0; i < kCount; ++i) {
            const double x = std::clamp(double(inputs[i][0]), -2.0, 3.0);
            const bool is_inside = x > -1.5 + h && x < 2.5 - h;
            ASSERT_NEAR(outputs[i][0], curve.at(x), is_inside ? smooth : corner) << form << " at " << x;
        }
    }
}

Lut random_lut(int dimensions, int size) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> value(-1, 2);
    Lut lut;
    lut.dimensions = dimensions;
    lut.size = size;
    lut.domain_min = {-0.5, 0, 0.25};
    lut.domain_max = {1, 2, 0.75};
    lut.values.resize(3 * std::size_t(dimensions == 1 ? size : size * size * size));
    for (float& v : lut.values) v = value(random);
    return lut;
}

/// Where channel `c` of `rgb` lies in the table, in samples.
double position(const Lut& lut, const Vec4& rgb, std::size_t c) {
    const double t = (double(rgb[c]) - lut.domain_min[c]) / (lut.domain_max[c] - lut.domain_min[c]);
    return std::clamp(t, 0.0, 1.0) * (lut.size - 1);
}

/// Walks from the cell's low corner along its axes, the largest fraction first.
std::array<double, 3> tetrahedral(const Lut& lut, const Vec4& rgb) {
    std::array<int, 3> corner{};
    std::vector<std::pair<double, std::size_t>> axes;
    for (std::size_t c = 0; c < 3; ++c) {
        const double at = position(lut, rgb, c);
        corner[c] = std::min(int(at), lut.size - 2);
        axes.emplace_back(at - corner[c], c);
    }
    std::sort(axes.rbegin(), axes.rend());
    const auto sample = [&](std::size_t channel) {
        const int index = (corner[2] * lut.size + corner[1]) * lut.size + corner[0];
        return double(lut.values[std::size_t(index) * 3 + channel]);
    };
    std::array<double, 3> result{sample(0), sample(1), sample(2)};
    for (const auto& [fraction, axis] : axes) {
        const std::array<double, 3> before{sample(0), sample(1), sample(2)};
        ++corner[axis];
        for (std::size_t c = 0; c < 3; ++c) result[c] += fraction * (sample(c) - before[c]);
    }
    return result;
}

std::array<double, 3> per_channel(const Lut& lut, const Vec4& rgb) {
    std::array<double, 3> result{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double at = position(lut, rgb, c);
        const std::size_t i = std::size_t(std::min(int(at), lut.size - 2));
        result[c] =
            std::lerp(double(lut.values[i * 3 + c]), double(lut.values[i * 3 + 3 + c]), at - double(i));
    }
    return result;
}

ParamSpec lut_spec() {
    return spec_of(R"({"type": "file", "kind": "lut", "default": "", "doc": "."})", "grade");
}

TEST_P(ParamResourcesOn, InterpolateInACubeByTetrahedra) {
    for (const int size : {2, 7, 33}) {
        const Lut lut = random_lut(3, size);
        const gpu::Texture texture = uploaded(file_texture(lut));
        const auto inputs = random_inputs(-0.75f, 2.25f);
        const auto outputs =
            computed(param_sampler_glsl(lut_spec(), lut, 5), "vec4(grade(v.rgb), 0.0)", inputs, &texture);
        for (std::size_t i = 0; i < kCount; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(outputs[i][c], tetrahedral(lut, inputs[i])[c], 3e-6 * size) << size << " " << i;
    }
}

TEST_P(ParamResourcesOn, InterpolateEachChannelOfAOneDimensionalLut) {
    for (const int size : {2, 4096, 4097, 65536}) {
        const Lut lut = random_lut(1, size);
        const gpu::Texture texture = uploaded(file_texture(lut));
        const auto inputs = random_inputs(-0.75f, 2.25f);
        const auto outputs =
            computed(param_sampler_glsl(lut_spec(), lut, 5), "vec4(grade(v.rgb), 0.0)", inputs, &texture);
        // A position is known to a float's rounding, and neighbours of this table differ by up to 3.
        const double bound = 1e-6 + 3 * 3e-7 * size;
        for (std::size_t i = 0; i < kCount; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(outputs[i][c], per_channel(lut, inputs[i])[c], bound) << size << " " << i;
    }
}

TEST_P(ParamResourcesOn, ReadAnImageByItsNameAndSize) {
    const test::TemporaryFolder folder;
    Image image(3, 2, 1);
    for (int i = 0; i < 6; ++i) image.floats()[std::size_t(i)] = float(i) / 255.0f;
    write_png(folder / "a.png", image);
    const ParamSpec spec =
        spec_of(R"({"type": "file", "kind": "image", "space": "data", "default": "", "doc": "."})", "stain");
    Diagnostics diagnostics;
    const auto file = load_param_file(spec, folder / "a.png", diagnostics);
    ASSERT_TRUE(file.has_value());
    const gpu::Texture texture = uploaded(file_texture(*file));
    const std::string glsl = param_sampler_glsl(spec, *file, 5);
    const std::vector<Vec4> inputs = {{2, 1, 0, 0}, {0, 1, 0, 0}};
    const auto texels = computed(glsl, "texelFetch(stain, ivec2(v.xy), HAS_STAIN - 1)", inputs, &texture);
    EXPECT_EQ(texels[0], (Vec4{5 / 255.0f, 5 / 255.0f, 5 / 255.0f, 1}));
    EXPECT_EQ(texels[1][0], 3 / 255.0f);
    const auto sizes = computed(glsl, "stain_size", inputs, &texture);
    EXPECT_EQ(sizes[0], (Vec4{3, 2, 1 / 3.0f, 0.5f}));
}

const std::string kWide = R"({"type": "table", "columns": {
    "scale": {"type": "float", "default": 1, "doc": "."},
    "tint": {"type": "color", "default": [1, 0.5, 0.25], "doc": "."},
    "mode": {"type": "enum", "values": ["soft", "hard"], "default": "hard", "doc": "."},
    "on": {"type": "bool", "default": true, "doc": "."},
    "offset": {"type": "vec2", "default": [8, 9], "doc": "."}}, "doc": "."})";

template <typename T>
T word(const std::vector<std::byte>& bytes, std::size_t at) {
    T value{};
    std::memcpy(&value, &bytes.at(at), sizeof(T));
    return value;
}

// Counted by hand from section 7.6.2.2: a row is float at 0, vec3 at 16, int at 28, bool at 32, vec2 at 40
// and 48 bytes long; an entry has it at 16 and is 64 bytes long; the block has the default row at 16, entries
// at 64.
TEST(ParamResources, LayATableOutAsStd430Does) {
    const ParamSpec spec = spec_of(kWide, "scales");
    const auto table = std::get<TableValue>(
        value_of(spec, R"({"rows": [{"objects": "7-9", "scale": 3, "on": false, "offset": [4, 5]},
                           {"object": 2, "mode": "soft", "tint": [6, 7, 8]}]})"));
    const auto bytes = table_buffer(spec, table, ids_of({}));
    ASSERT_EQ(bytes.size(), 64u + 2 * 64u);
    EXPECT_EQ(word<std::uint32_t>(bytes, 0), 2u);
    EXPECT_EQ(word<float>(bytes, 16), 1);
    EXPECT_EQ(word<float>(bytes, 32), 1);
    EXPECT_EQ(word<float>(bytes, 40), 0.25f);
    EXPECT_EQ(word<std::int32_t>(bytes, 44), 1);
    EXPECT_EQ(word<std::int32_t>(bytes, 48), 1);
    EXPECT_EQ(word<float>(bytes, 60), 9);
    EXPECT_EQ(word<std::uint32_t>(bytes, 64), 2u);
    EXPECT_EQ(word<std::uint32_t>(bytes, 68), 2u);
    EXPECT_EQ(word<float>(bytes, 80 + 20), 7);
    EXPECT_EQ(word<std::int32_t>(bytes, 80 + 28), 0);
    EXPECT_EQ(word<std::uint32_t>(bytes, 128), 7u);
    EXPECT_EQ(word<std::uint32_t>(bytes, 132), 9u);
    EXPECT_EQ(word<float>(bytes, 144), 3);
    EXPECT_EQ(word<std::int32_t>(bytes, 144 + 32), 0);
    EXPECT_EQ(word<float>(bytes, 144 + 40), 4);
    EXPECT_EQ(word<float>(bytes, 144 + 44), 5);
}

TEST(ParamResources, LayATableOfScalarsOutWithoutGaps) {
    const ParamSpec spec = spec_of(R"({"type": "table", "columns": {
        "a": {"type": "float", "default": 1, "doc": "."},
        "b": {"type": "int", "default": -5, "doc": "."}}, "doc": "."})",
                                   "t");
    const auto bytes = table_buffer(
        spec, std::get<TableValue>(value_of(spec, R"({"rows": [{"object": 3, "b": 6}]})")), ids_of({}));
    ASSERT_EQ(bytes.size(), 12u + 16u);
    EXPECT_EQ(word<std::int32_t>(bytes, 8), -5);
    EXPECT_EQ(word<std::uint32_t>(bytes, 12), 3u);
    EXPECT_EQ(word<float>(bytes, 20), 1);
    EXPECT_EQ(word<std::int32_t>(bytes, 24), 6);
    EXPECT_EQ(table_buffer(spec, std::get<TableValue>(spec.default_value), ids_of({})).size(), 12u + 16u)
        << "one entry at least";
}

TEST(ParamResources, LeaveOutRowsOfNamesThatAreNotThereAfterAsking) {
    const ParamSpec spec = spec_of(kWide, "scales");
    std::vector<std::string> asked;
    const auto ids = [&](const std::string& name) -> std::optional<std::uint32_t> {
        asked.push_back(name);
        return std::nullopt;
    };
    const auto bytes = table_buffer(
        spec, std::get<TableValue>(value_of(spec, R"({"rows": [{"name": "Wheel"}, {"object": 1}]})")), ids);
    EXPECT_EQ(word<std::uint32_t>(bytes, 0), 1u);
    EXPECT_EQ(asked, std::vector<std::string>{"Wheel"});
}

TEST_P(ParamResourcesOn, FindATablesRowByObject) {
    const ParamSpec spec = spec_of(kWide, "object_scales");
    const auto table = std::get<TableValue>(value_of(spec, R"({"default": {"scale": -1}, "rows": [
        {"objects": "100-200,300,400-499", "scale": 1, "offset": [1, 2]},
        {"name": "b", "scale": 2, "on": false},
        {"name": "a", "scale": 3, "mode": "soft"}, {"name": "c", "scale": 4},
        {"name": "same as a", "scale": 5},
        {"name": "low end", "scale": 6}, {"name": "high end", "scale": 7},
        {"objects": "4294967000-4294967295", "scale": 8}, {"object": 0, "scale": 9}]})"));
    const std::map<std::string, std::uint32_t> names = {
        {"b", 150}, {"a", 151}, {"c", 7}, {"same as a", 151}, {"low end", 400}, {"high end", 4294967295u}};
    std::vector<Vec4> inputs;
    std::vector<std::uint32_t> ids;
    std::mt19937 random(3);
    for (std::size_t i = 0; i < kCount; ++i)
        ids.push_back(i < 600   ? std::uint32_t(i)
                      : i < 900 ? UINT32_MAX - std::uint32_t(i - 600)
                                : std::uint32_t(random()));
    for (const std::uint32_t id : ids) {
        inputs.push_back({float(id >> 16), float(id & 0xffff), 0, 0});
    }
    const gpu::Buffer buffer = uploaded(table_buffer(spec, table, ids_of(names)));
    const std::string id = "(uint(v.x) << 16 | uint(v.y))";
    const std::string glsl = param_table_glsl(spec, 3) +
                             "vec4 packed_row(ObjectScalesRow row) {\n"
                             "    bool soft = row.mode == OBJECT_SCALES_MODE_SOFT;\n"
                             "    return vec4(row.scale, row.on ? 1.0 : 0.0, soft ? 1.0 : 0.0,\n"
                             "                row.offset.y + row.tint.b);\n}\n";
    const auto outputs = computed(glsl, "packed_row(object_scales(" + id + "))", inputs, nullptr, &buffer);
    for (std::size_t i = 0; i < kCount; ++i) {
        // Names before ids, and the first of two.
        const TableValue::Row* row = &table.default_row;
        for (const auto& [key, candidate] : table.rows)
            if (key.name.empty() && key.first <= ids[i] && ids[i] <= key.last) row = &candidate;
        for (auto r = table.rows.rbegin(); r != table.rows.rend(); ++r)
            if (!r->first.name.empty() && names.at(r->first.name) == ids[i]) row = &r->second;
        const Vec4 expected = {float((*row)[0][0]), float((*row)[3][0]), (*row)[2][0] == 0 ? 1.0f : 0.0f,
                               float((*row)[4][1] + (*row)[1][2])};
        ASSERT_EQ(outputs[i], expected) << ids[i];
    }
}

TEST(ParamResources, DeclareNothingForAFileThatIsNotThere) {
    Diagnostics diagnostics;
    const auto none = load_param_file(lut_spec(), "", diagnostics);
    ASSERT_TRUE(none.has_value());
    EXPECT_EQ(param_sampler_glsl(lut_spec(), *none, 0), "");
    EXPECT_FALSE(diagnostics.has_errors());
}

TEST(ParamResources, SayWhichFileIsWrong) {
    const test::TemporaryFolder folder;
    const std::string name = (folder / "a.cube").string();
    test::write_text(name, "LUT_1D_SIZE 2\n0 0 0\n1 1\n");
    Diagnostics diagnostics;
    EXPECT_FALSE(load_param_file(lut_spec(), name, diagnostics).has_value());
    const ParamSpec image =
        spec_of(R"({"type": "file", "kind": "image", "default": "", "doc": "."})", "stain");
    EXPECT_FALSE(load_param_file(image, folder / "none.png", diagnostics).has_value());
    EXPECT_EQ(test::lines_of(diagnostics),
              (test::Lines{name + ":3:1: error: expected three numbers, not '1 1'",
                           (folder / "none.png").string() + ": error: no such file"}));
}

}  // namespace
}  // namespace aftershade
