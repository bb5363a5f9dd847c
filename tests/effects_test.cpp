// What holds for every effect, found by its folder: it compiles in every variant, its output is finite over
// the range of every parameter, its identity is one, both software backends agree, and its cases give their
// goldens.
//
// AFTERSHADE_MAKE_GOLDENS=1 (scripts/make-case-goldens) writes the goldens of the cases instead of comparing.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "framework/compare/metrics.h"
#include "framework/core/units.h"
#include "framework/effect/usage_check.h"
#include "framework/image/capture.h"
#include "framework/image/png_file.h"
#include "framework/image/profile.h"
#include "framework/image/role.h"
#include "tests/camera_pose.h"
#include "tests/effect_case.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = AFTERSHADE_SOURCE_DIR;

// ---- the effects ----

EffectRegistry& registry() {
    static EffectRegistry effects({kRoot / "effects"});
    return effects;
}

std::string faults_of(const Diagnostics& diagnostics) {
    std::ostringstream text;
    diagnostics.print(text);
    return text.str();
}

/// The software backends of this machine. None at all is a failure of every test here.
const std::vector<gpu::Backend>& backends() {
    static const std::vector<gpu::Backend> present = [] {
        std::vector<gpu::Backend> usable;
        for (const gpu::BackendReport& report : gpu::probe_backends())
            if (report.usable && report.info.software) usable.push_back(report.info.backend);
        return usable;
    }();
    return present;
}

// ---- looks ----

std::string json_of(const ParamValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return '"' + *text + '"';
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
    if (const auto* number = std::get_if<double>(&value)) return format_number(*number);
    std::string items;
    for (const double item : std::get<std::vector<double>>(value))
        items += (items.empty() ? "" : ", ") + format_number(item);
    return "[" + items + "]";
}

using Values = std::map<std::string, ParamValue>;

std::string look_of(const std::string& effect, const Values& values) {
    std::string params;
    for (const auto& [name, value] : values)
        params += (params.empty() ? "\"" : ", \"") + name + "\": " + json_of(value);
    return R"({"aftershade": 1, "steps": [{"effect": ")" + effect + R"(", "params": {)" + params + "}}]}";
}

/// A limit of a parameter as a value of its type; a vector has it in every component.
ParamValue limit_of(const ParamSpec& spec, double limit) {
    if (spec.type == ParamType::int_) return std::int64_t(limit);
    if (const int count = component_count(spec.type); count > 1)
        return std::vector<double>(std::size_t(count), limit);
    return limit;
}

/// Every value of an enum or a bool; the limits of a number.
std::vector<ParamValue> extremes_of(const ParamSpec& spec) {
    std::vector<ParamValue> values;
    if (spec.type == ParamType::bool_) return {false, true};
    for (const std::string& name : spec.values) values.emplace_back(name);
    if (spec.min) values.push_back(limit_of(spec, *spec.min));
    if (spec.max) values.push_back(limit_of(spec, *spec.max));
    return values;
}

// ---- captures ----

/// A sphere and a moving box before nothing, lights brighter than white, and coverage that ends.
Capture small_capture() {
    const SyntheticSphere sphere{.x = 20, .y = 18, .radius_px = 12, .depth_m = 2.5f};
    const SyntheticBox box{
        .x = 34, .y = 8, .width = 16, .height = 20, .velocity_x = 3, .velocity_y = -2, .depth_m = 4};
    Capture capture = make_capture({.background = {0.02f, 0.05f, 0.2f},
                                    .alpha = 0.5f,
                                    .sphere = sphere,
                                    .box = box,
                                    .points = {{5, 4, 1e4f}, {20, 18, 30}, {57, 30, 500}}});
    // Soft shading too: where all edges are hard, what sharpens within its neighbours' range has nothing to
    // do.
    Image& color = capture.images.at("color");
    for (int y = 0; y < color.height(); ++y)
        for (int x = 0; x < color.width(); ++x)
            for (int c = 0; c < 3; ++c)
                color.at(x, y, c) *= 1 + 0.3f * std::sin(0.6f * float(x) + 0.4f * float(y));
    // Something in every role that a formula leaves black.
    for (const char* role : {"specular", "emission"})
        for (float& value : capture.images.at(role).floats()) value = 0.1f;
    set_pose(capture.header.camera, {}, color.width(), color.height());
    return capture;
}

/// The frame before small_capture's, in which the camera stood and looked elsewhere.
Capture capture_before() {
    Capture capture = small_capture();
    capture.header.frame -= 1;
    const CameraPose pose{.position_m = {-0.1, 0.05, 0.2}, .angles_deg = {1, -3, 2}};
    set_pose(capture.header.camera, pose, capture.images.at("color").width(),
             capture.images.at("color").height());
    return capture;
}

void remove_role(Capture& capture, const std::string& role) {
    capture.images.erase(role);
    std::erase(capture.header.roles, role);
}

/// The first value of the images that is no number.
std::string non_finite(const FrameResult& result) {
    for (const auto& [role, image] : result.images)
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < image.channels(); ++c)
                    if (!std::isfinite(image.at(x, y, c)))
                        return role + " at (" + std::to_string(x) + ", " + std::to_string(y) + "), channel " +
                               std::to_string(c) + ": " + std::to_string(image.at(x, y, c));
    return "";
}

bool same_bits(const Image& a, const Image& b) {
    return a.floats().size() == b.floats().size() &&
           std::memcmp(a.floats().data(), b.floats().data(), a.floats().size_bytes()) == 0;
}

// ---- one test for every folder ----

class EveryEffect : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        Diagnostics diagnostics;
        manifest_ = registry().find(GetParam(), diagnostics);
        ASSERT_TRUE(manifest_) << faults_of(diagnostics);
        ASSERT_FALSE(backends().empty()) << "neither osmesa nor egl-software works on this machine";
    }
    const EffectManifest& manifest() const { return *manifest_; }

    FrameResult run(const Values& values, gpu::Backend backend, const Capture& capture) const {
        const Capture before = with_aovs(capture_before()), whole = with_aovs(capture);
        FrameInputs frame;
        frame.capture = &whole;
        frame.previous = &before;
        return LookRunner(look_of(GetParam(), values), backend).run(frame);
    }

    /// With what no capture has by itself but the effect cannot do without: small numbers.
    Capture with_aovs(Capture capture) const {
        // Any of them: the test may have taken any role away.
        const Image& other = capture.images.begin()->second;
        for (const InputSpec& input : manifest().inputs) {
            if (!input.role.starts_with("aov:") || input.optional) continue;
            Image image(other.width(), other.height(), 4);
            for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = 0.001f * float(i % 5);
            capture.images[input.role] = std::move(image);
            capture.header.roles.push_back(input.role);
        }
        return capture;
    }

private:
    const EffectManifest* manifest_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Effects, EveryEffect, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

TEST_P(EveryEffect, SaysWhatItAndItsParametersDo) {
    EXPECT_FALSE(manifest().summary.empty());
    EXPECT_FALSE(manifest().version.empty());
    for (const ParamSpec& spec : manifest().params) {
        EXPECT_TRUE(spec.doc.ends_with('.')) << spec.name << ": the doc is a sentence";
        const bool number = is_block_type(spec.type) && spec.type != aftershade::ParamType::bool_ &&
                            spec.type != aftershade::ParamType::enum_;
        EXPECT_EQ(number, spec.ui_range.has_value()) << spec.name << ": a number has a slider's ends";
        EXPECT_EQ(number, spec.min.has_value()) << spec.name << ": a number has a least value";
    }
    for (const TextureSpec& texture : manifest().textures) EXPECT_FALSE(texture.doc.empty()) << texture.name;
}

TEST_P(EveryEffect, CompilesInEveryVariantOnEachBackend) {
    for (const gpu::Backend backend : backends()) {
        const Capture capture = small_capture();
        EXPECT_NO_THROW(run({}, backend, capture));
        for (const ParamSpec& spec : manifest().params) {
            if (spec.bind != ParamBind::define) continue;
            for (const ParamValue& value : extremes_of(spec)) {
                if (value == spec.default_value) continue;
                EXPECT_NO_THROW(run({{spec.name, value}}, backend, capture))
                    << gpu::backend_name(backend) << ", " << spec.name << " = " << json_of(value);
            }
        }
        for (const InputSpec& input : manifest().inputs) {
            const auto is_required = [&](const InputSpec& other) {
                return !other.optional && other.role == input.role;
            };
            // A neighbouring frame's image may be absent where this frame's is needed.
            if (!input.optional || std::ranges::any_of(manifest().inputs, is_required)) continue;
            Capture without = small_capture();
            remove_role(without, input.role);
            EXPECT_NO_THROW(run({}, backend, without))
                << gpu::backend_name(backend) << ", without " << input.role;
        }
    }
}

TEST_P(EveryEffect, GivesNumbersOverTheRangeOfEveryParameter) {
    const Capture capture = small_capture();
    EXPECT_EQ(non_finite(run({}, backends().front(), capture)), "") << "at the defaults";
    for (const ParamSpec& spec : manifest().params)
        for (const ParamValue& value : extremes_of(spec)) {
            if (value == spec.default_value) continue;
            const FrameResult result = run({{spec.name, value}}, backends().front(), capture);
            ASSERT_FALSE(result.images.empty());
            EXPECT_EQ(non_finite(result), "") << spec.name << " = " << json_of(value);
        }
}

TEST_P(EveryEffect, LeavesColorAloneBitForBitWhereItsParametersSaySo) {
    const OutputSpec* output = manifest().find_output("color");
    const InputSpec* input = manifest().find_input("color");
    Values identity;
    for (const ParamSpec& spec : manifest().params)
        if (spec.identity) identity[spec.name] = *spec.identity;
    if (!output || !input || identity.empty())
        GTEST_SKIP() << "SKIPPED: " << GetParam() << " has no identity from color to color";
    const Capture capture = small_capture();
    const FrameResult result = run(identity, backends().front(), capture);
    EXPECT_TRUE(same_bits(result.images.at("color"), capture.images.at("color")));
    // And only there: some other value of them changes the picture.
    bool changes = false;
    for (const ParamSpec& spec : manifest().params) {
        if (!spec.identity || changes) continue;
        for (const ParamValue& value : extremes_of(spec)) {
            Values other = identity;
            other[spec.name] = value;
            const Image image = run(other, backends().front(), capture).images.at("color");
            changes |= !same_bits(image, capture.images.at("color"));
        }
    }
    EXPECT_TRUE(changes);
}

TEST_P(EveryEffect, DeclaresWhatItsShadersUseAndUsesWhatItDeclares) {
    Diagnostics faults;
    check_declared_used(manifest(), std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "glsl", faults);
    std::ostringstream text;
    faults.print(text);
    EXPECT_EQ(text.str(), "");
}

/// What came before a cut, a gap or another size must leave no trace.
TEST_P(EveryEffect, BeginsAnewAtACutAGapAndAnotherSize) {
    const auto frame_of = [&](int number, int width) {
        return with_aovs(make_capture({.width = width,
                                       .height = 20,
                                       .background = {0.1f * float(number), 0.5f, 0.2f},
                                       .background_depth_m = 5,
                                       .box = SyntheticBox{4, 4, 8, 6, 2, 0, 2}},
                                      number));
    };
    const auto run_one = [](LookRunner& runner, const Capture& capture, bool cut) {
        FrameInputs frame;
        frame.capture = &capture;
        frame.begins_shot = cut;
        return runner.run(frame);
    };
    struct After {
        int number;
        int width;
        bool cut;
    };
    for (const After after : {After{3, 32, true}, After{9, 32, false}, After{3, 40, false}}) {
        LookRunner used(look_of(GetParam(), {}), backends().front());
        for (const int number : {1, 2}) run_one(used, frame_of(number, 32), false);
        LookRunner fresh(look_of(GetParam(), {}), backends().front());
        const Capture capture = frame_of(after.number, after.width);
        const FrameResult a = run_one(used, capture, after.cut), b = run_one(fresh, capture, false);
        for (const auto& [role, image] : a.images) EXPECT_TRUE(same_bits(image, b.images.at(role))) << role;
    }
}

TEST_P(EveryEffect, GivesTheSameBitsOnBothSoftwareBackends) {
    if (backends().size() < 2) GTEST_SKIP() << "SKIPPED: only one software backend works here";
    const Capture capture = small_capture();
    std::vector<Values> variants{{}};
    for (const ParamSpec& spec : manifest().params)
        if (spec.bind == ParamBind::define)
            for (const ParamValue& value : extremes_of(spec)) variants.push_back({{spec.name, value}});
    for (const Values& values : variants) {
        const FrameResult first = run(values, backends()[0], capture);
        const FrameResult second = run(values, backends()[1], capture);
        ASSERT_EQ(first.images.size(), second.images.size());
        for (const auto& [role, image] : first.images)
            EXPECT_TRUE(same_bits(image, second.images.at(role)))
                << role << " of " << look_of(GetParam(), values);
    }
}

// ---- cases ----

bool making_goldens() {
    const char* set = std::getenv("AFTERSHADE_MAKE_GOLDENS");
    return set && std::string(set) == "1";
}

std::string cpu_name() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

/// The image, a sidecar that tells what made it, and a PNG in build/ to look at.
void write_golden(const fs::path& path, const std::string& role, const Image& image, gpu::Backend backend) {
    const ChannelRole contract = *find_role(role);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < image.channels(); ++c)
        channels.push_back({contract.native_channels[std::size_t(c)], PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, image.width() - 1, image.height() - 1};
    write_exr(path, channels, options);
    gpu::Context context(backend);
    const gpu::ContextInfo& info = context.info();
    std::ofstream(fs::path(path).replace_extension(".json"))
        << "{ \"backend\": \"" << gpu::backend_name(info.backend) << "\", \"renderer\": \"" << info.renderer
        << "\",\n  \"version\": \"" << info.version << "\", \"cpu\": \"" << cpu_name() << "\" }\n";

    Image display(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < std::min(image.channels(), 3); ++c)
                display.at(x, y, c) =
                    role == "display" ? image.at(x, y, c) : float(srgb_of_clamped(image.at(x, y, c)));
    const fs::path folder = kRoot / "build/case-goldens" / path.parent_path().parent_path().filename();
    fs::create_directories(folder);
    write_png(folder / path.filename().replace_extension(".png"), display);
}

void compare_golden(const EffectCase& test, const std::string& role, int frame, const Image& image) {
    constexpr int kMaxWidthPx = 256;
    constexpr std::uintmax_t kMaxBytes = 200'000;
    const fs::path path = test.golden(role, frame);
    ASSERT_TRUE(fs::exists(path)) << "no golden " << path << "; scripts/make-case-goldens makes it";
    EXPECT_TRUE(fs::exists(fs::path(path).replace_extension(".json"))) << "no sidecar beside " << path;
    EXPECT_LE(fs::file_size(path), kMaxBytes) << path;
    const Image golden = ExrFile(path).read_floats(0, find_role(role)->native_channels);
    EXPECT_LE(golden.width(), kMaxWidthPx) << path;
    EXPECT_EQ(difference(golden, rounded_to_half(image), test.tolerance), "") << path;
}

/// A frame of a case's capture, from its first sub-frame to its last.
FrameResult run_frame(LookRunner& runner, const CaptureReader& reader, const Sequence& sequence, int number) {
    std::vector<Capture> captures;
    for (int subframe = 0; subframe < sequence.subframes; ++subframe) {
        captures.push_back(reader.read(sequence.file_number(number, subframe), role_names()));
        captures.back().header.frame = number;
    }
    FrameInputs frame;
    frame.subframe_count = sequence.subframes;
    frame.centre = &captures[captures.size() / 2];
    FrameResult result;
    for (const Capture& capture : captures) {
        frame.capture = &capture;
        result = runner.run(frame);
        ++frame.subframe;
    }
    return result;
}

void run_case(const EffectCase& test, gpu::Backend backend) {
    Diagnostics diagnostics;
    const auto sequence = open_sequence(test.capture.string(), diagnostics);
    ASSERT_TRUE(sequence) << faults_of(diagnostics);
    const CaptureReader reader(*sequence, read_profiles(kRoot / "profiles", diagnostics), {});
    LookRunner runner(test.look, backend);
    for (const int frame : test.frames) {
        const FrameResult result = run_frame(runner, reader, *sequence, frame);
        for (const std::string& role : test.outputs) {
            ASSERT_TRUE(result.images.contains(role)) << test.file << ": no step makes '" << role << "'";
            if (making_goldens())
                write_golden(test.golden(role, frame), role, result.images.at(role), backend);
            else compare_golden(test, role, frame, result.images.at(role));
        }
    }
}

TEST_P(EveryEffect, GivesTheGoldensOfItsCases) {
    Diagnostics diagnostics;
    const auto cases = read_cases(manifest().folder, kRoot, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << faults_of(diagnostics);
    EXPECT_FALSE(cases.empty()) << "no case in " << manifest().folder / "cases";
    for (const EffectCase& test : cases) EXPECT_NO_THROW(run_case(test, backends().front())) << test.file;
}

// ---- the reader and the measure of cases ----

TEST(EffectCase, TellsEveryFaultOfADocument) {
    Diagnostics diagnostics;
    const auto node =
        parse_document(R"({"aftershade": 1, "capture": "nowhere.json", "frames": "a-b", "steps": [],
        "outputs": ["color"], "tolerance": {"fail": 0.1, "fail_percent": 101, "hard_fail": 0.01}, "tgas": []})",
                       "case.json", diagnostics);
    ASSERT_TRUE(node);
    EXPECT_FALSE(parse_case(*node, "case.json", kRoot, diagnostics));
    const std::string faults = faults_of(diagnostics);
    for (const char* part :
         {"nowhere.json", "'a-b' is no range", "fail_percent", "'hard_fail' at least", "tgas"})
        EXPECT_NE(faults.find(part), std::string::npos) << part << " in\n" << faults;
    EXPECT_EQ(diagnostics.error_count(), 5) << faults;
}

TEST(EffectCase, GivesTheStepsOnAsTheyStand) {
    Diagnostics diagnostics;
    const std::string text = R"([{"effect": "a\"b", "x": [1, -0.25, true, null], "y": {}}])";
    EXPECT_EQ(to_json(*parse_document(text, "steps", diagnostics)), text);
}

TEST(EffectCase, CountsPixelsAboveFailAndStopsAtHardFail) {
    Image golden(10, 10, 1), image(10, 10, 1);
    const CaseTolerance tolerance{.fail = 0.1, .fail_percent = 2, .hard_fail = 0.5};
    image.at(1, 1, 0) = 0.3f;
    image.at(2, 2, 0) = 0.3f;
    image.at(3, 3, 0) = 0.05f;
    EXPECT_EQ(difference(golden, image, tolerance), "");
    image.at(4, 4, 0) = 0.2f;
    EXPECT_NE(difference(golden, image, tolerance).find("3 % of the pixels"), std::string::npos);
    image.at(4, 4, 0) = 0;
    image.at(2, 2, 0) = 0.6f;
    EXPECT_NE(difference(golden, image, tolerance).find("at (2, 2)"), std::string::npos);
    image.at(2, 2, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(difference(golden, image, tolerance), "");
    golden.at(2, 2, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(difference(golden, image, tolerance), "");
    EXPECT_NE(difference(Image(10, 9, 1), image, tolerance), "");
}

}  // namespace
}  // namespace aftershade::test
