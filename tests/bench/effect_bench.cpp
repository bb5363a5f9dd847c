// Times effects on pictures of known CoC or surface, or on a capture's frame, or counts their texel fetches.
// scripts/bench dof, isf, sss and roofline say which, as JSON on stdin, and read JSON from stdout; the
// figures are of their making, the measuring is here.
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/effect/registry.h"
#include "framework/gpu/buffer.h"
#include "framework/gpu/context.h"
#include "framework/look/look.h"
#include "framework/render/renderer.h"
#include "tests/backends.h"

#include <glad/gl.h>

namespace aftershade {
namespace {

using nlohmann::json;

/// Where the counting shaders of scripts/measure/effect_bench.py add up, in as many words as pixels would
/// crowd.
constexpr unsigned kCountBinding = 15;
constexpr std::size_t kCountWords = 4096;

/// `blurred` of the width from the left is at `depth_m`, the rest at `focus_m`; null is nothing hit.
Capture make_capture(const json& job, const json& test) {
    const int width = job.at("size").at(0), height = job.at("size").at(1);
    const json& depth = test.at("depth_m");
    const float blurred_m = depth.is_null() ? std::numeric_limits<float>::infinity() : depth.get<float>();
    const float focus_m = test.at("params").at("focus_distance");
    const int edge = int(double(width) * test.at("blurred").get<double>() + 0.5);
    Capture capture;
    CaptureHeader& header = capture.header;
    header.frame = 1;
    header.path = "bench";
    header.profile = "native";
    header.roles = {"color", "depth"};
    header.data_window = header.display_window = {0, 0, width - 1, height - 1};
    Image& color = capture.images["color"] = Image(width, height, 4);
    Image& z = capture.images["depth"] = Image(width, height, 1);
    std::uint32_t state = 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) {
                state = state * 1664525U + 1013904223U;
                color.at(x, y, c) = float(state >> 8) / float(1 << 24);
            }
            color.at(x, y, 3) = 1;
            z.at(x, y, 0) = x < edge ? blurred_m : focus_m;
        }
    return capture;
}

/// Object 1, at `depth_m` all over, under light that no filter could leave as it is: the job's "role" is
/// "irradiance".
Capture make_surface(const json& job, const json& test) {
    const int width = job.at("size").at(0), height = job.at("size").at(1);
    Capture capture;
    CaptureHeader& header = capture.header;
    header.frame = 1;
    header.path = "bench";
    header.profile = "native";
    header.roles = {"irradiance", "depth", "object_id", "normal"};
    CaptureLight sun;
    sun.kind = CaptureLight::Kind::directional;
    sun.direction = {0, 0, -1};
    sun.intensity = {3.14159, 3.14159, 3.14159};
    header.lights = {sun};
    header.data_window = header.display_window = {0, 0, width - 1, height - 1};
    Image& light = capture.images["irradiance"] = Image(width, height, 3);
    Image& z = capture.images["depth"] = Image(width, height, 1);
    Image& normal = capture.images["normal"] = Image(width, height, 3);
    Image& id = capture.images["object_id"] = Image(width, height, 1, ComponentType::uint32);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) light.at(x, y, c) = (x / 40 + y / 30) % 2 ? 1.0f : 0.1f * float(c);
            z.at(x, y, 0) = test.at("depth_m");
            id.uint_at(x, y, 0) = 1;
            normal.at(x, y, 2) = 1;
        }
    return capture;
}

/// Encoded, opaque: bars over a gradient. The job's "role" is "display".
Capture make_display(const json& job) {
    const int width = job.at("size").at(0), height = job.at("size").at(1);
    Capture capture;
    CaptureHeader& header = capture.header;
    header.frame = 1;
    header.path = "bench";
    header.profile = "native";
    header.roles = {"display"};
    header.data_window = header.display_window = {0, 0, width - 1, height - 1};
    Image& display = capture.images["display"] = Image(width, height, 4);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            display.at(x, y, 0) = float(x) / float(width);
            display.at(x, y, 1) = float(y) / float(height);
            display.at(x, y, 2) = float((x / 40 + y / 30) % 2);
            display.at(x, y, 3) = 1;
        }
    return capture;
}

Capture read_capture(const json& job) {
    Sequence sequence;
    sequence.files = FramePattern(job.at("capture").get<std::string>());
    sequence.profile = job.at("profile");
    Diagnostics diagnostics;
    const std::filesystem::path data = job.at("data").get<std::string>();
    const CaptureReader reader(sequence, read_profiles(data / "profiles", diagnostics), {});
    return reader.read(job.at("frame"), job.at("roles").get<std::vector<std::string>>());
}

Pipeline bind(const json& test, EffectRegistry& effects) {
    const json text = {{"aftershade", 1},
                       {"steps", {{{"effect", test.at("effect")}, {"params", test.at("params")}}}}};
    Diagnostics diagnostics;
    Pipeline pipeline;
    if (const auto node = parse_document(text.dump(), test.at("name"), diagnostics))
        if (const auto look = parse_look(*node, diagnostics))
            pipeline = bind_pipeline(*look, effects, {}, diagnostics);
    std::ostringstream faults;
    diagnostics.print(faults);
    if (diagnostics.has_errors()) throw std::runtime_error(faults.str());
    return pipeline;
}

std::uint64_t sum(const gpu::Buffer& counts) {
    const std::vector<std::byte> bytes = counts.read();
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < kCountWords; ++i) {
        std::uint32_t word = 0;
        std::memcpy(&word, &bytes[i * sizeof word], sizeof word);
        total += word;
    }
    return total;
}

/// Two frames to compile and touch everything, then one that counts.
/// `read`: the capture of all cases, where the job has one.
json measure(gpu::Context& context, gpu::Buffer& counts, const json& job, const json& test,
             EffectRegistry& effects, const std::optional<Capture>& read) {
    const Pipeline pipeline = bind(test, effects);
    const std::string role = test.value("role", job.value("role", "color"));
    const Capture capture = read                   ? *read
                            : role == "irradiance" ? make_surface(job, test)
                            : role == "display"    ? make_display(job)
                                                   : make_capture(job, test);
    PipelineRenderer renderer(context, pipeline, job.at("data").get<std::string>());
    FrameInputs frame;
    frame.capture = &capture;
    for (int i = 0; i < 2; ++i) renderer.render(frame, {role}, false);
    counts.clear(0);
    context.gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, kCountBinding, counts.handle());
    const FrameResult result = renderer.render(frame, {role}, true);
    json passes = json::array();
    double ms = 0;
    for (const graph::PassTime& pass : result.times) {
        if (pass.pass == "upload" || pass.pass == "readback") continue;
        passes.push_back({{"pass", pass.pass}, {"ms", pass.milliseconds}});
        ms += pass.milliseconds;
    }
    const double pixels = double(job.at("size").at(0)) * double(job.at("size").at(1));
    return {{"name", test.at("name")},
            {"ms", ms},
            {"passes", passes},
            {"fetches_per_pixel", double(sum(counts)) / pixels}};
}

int run() {
    const json job = json::parse(std::cin);
    std::vector<std::filesystem::path> folders;
    for (const std::string folder : job.at("effects")) folders.emplace_back(folder);
    EffectRegistry effects(folders);
    gpu::Context context(gpu::test_backend());
    gpu::Buffer counts(context, kCountWords * sizeof(std::uint32_t), "counts");
    json results = json::array();
    std::optional<Capture> read;
    if (job.contains("capture")) read = read_capture(job);
    // In turns, so that the machine's noise meets all alike.
    for (int i = 0; i < job.at("repetitions"); ++i)
        for (const json& test : job.at("cases")) {
            results.push_back(measure(context, counts, job, test, effects, read));
            std::cerr << test.at("name").get<std::string>() << " " << results.back().at("ms") << " ms\n";
        }
    std::cout << json{
        {"renderer", context.info().renderer}, {"gl", context.info().version}, {"results", results}};
    return 0;
}

}  // namespace
}  // namespace aftershade

int main() {
    try {
        return aftershade::run();
    } catch (const std::exception& error) {
        std::cerr << "effect_bench: " << error.what() << "\n";
        return 1;
    }
}
