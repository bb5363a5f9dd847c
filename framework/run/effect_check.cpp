#include "framework/run/effect_check.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/effect/registry.h"
#include "framework/image/role.h"
#include "framework/render/frame_drive.h"

namespace aftershade {

namespace {

/// One way to use the effect: its name for messages, values above the defaults, inputs left out.
struct Setting {
    std::string name;
    std::map<std::string, ParamValue> values;
    std::set<std::string> absent;
};

std::vector<Setting> settings_of(const EffectManifest& manifest) {
    std::vector<Setting> settings{{"the defaults", {}, {}}};
    for (const ParamSpec& spec : manifest.params)
        for (const auto& [how, value] : sweep_values(spec))
            if (value != spec.default_value)
                settings.push_back({spec.name + " " + how, {{spec.name, value}}, {}});
    for (const PresetSpec& preset : manifest.presets)
        settings.push_back({"preset " + preset.name, preset.values, {}});
    for (const InputSpec& input : manifest.inputs)
        if (input.optional) settings.push_back({"no " + input.name, {}, {input.name}});
    return settings;
}

Pipeline pipeline_of(const EffectManifest& manifest, const Setting& setting) {
    PipelineStep step;
    step.name = manifest.id;
    step.manifest = &manifest;
    step.is_foreign = !is_shipped(manifest);
    for (const InputSpec& input : manifest.inputs)
        // A role that the test capture never has: the input is not there.
        step.inputs[input.name] = {-1,
                                   setting.absent.contains(input.name) ? "aov:absent" : input.image_role()};
    for (const auto& [name, value] : setting.values) {
        step.values[name] = value;
        step.origins[name] = "the check";
    }
    Pipeline pipeline;
    pipeline.steps.push_back(std::move(step));
    return pipeline;
}

std::string first_bad_value(const FrameResult& result) {
    for (const auto& [role, image] : result.images) {
        std::vector<AuditFinding> findings;
        audit_image(RoleId(role), image, "the step", role, findings);
        if (!findings.empty()) return describe_finding(findings.front());
    }
    return "";
}

/// One pixel of the test capture.
struct TestPoint {
    float u = 0, y = 0;
    float light = 0;
    float depth_m = 0;
    bool box = false;
    bool sky = false;
};

std::array<float, 4> values_of(const ChannelRole& role, const TestPoint& at) {
    constexpr std::array kAlbedo = {0.8f, 0.5f, 0.3f};
    switch (role.kind) {
        case RoleKind::light: {
            const float light = role.is_share ? 1 : at.light;
            if (role.channels == 3 && !role.is_share) return {light, light, light};
            return {light * kAlbedo[0], light * kAlbedo[1], light * kAlbedo[2], at.sky ? 0.5f : 1.0f};
        }
        case RoleKind::distance: return {at.depth_m};
        case RoleKind::motion: return {at.box ? 3.0f : 0.0f, 0};
        case RoleKind::direction: return {0, 0, 1};
        case RoleKind::place: return {at.u, at.y, at.sky ? 0 : -at.depth_m};
        case RoleKind::coverage: return {at.box ? 1.0f : 0.0f};
        case RoleKind::id:
        case RoleKind::display:
        case RoleKind::other: break;
    }
    return {};
}

void put(const ChannelRole& role, const TestPoint& at, Image& image, int x, int y) {
    if (role.kind == RoleKind::id) {
        image.uint_at(x, y, 0) = at.box ? 2 : at.sky ? 0 : 1;
        return;
    }
    const std::array<float, 4> values = values_of(role, at);
    for (int c = 0; c < role.channels; ++c) image.at(x, y, c) = values[std::size_t(c)];
}

/// A small capture from formulas, with every role: a plane, a box in motion, lamps far brighter than 1, and
/// sky without depth.
Capture make_test_capture(int width, int height, int frame) {
    Capture capture;
    CaptureHeader& header = capture.header;
    header.frame = header.source_frame = frame;
    header.path = "test capture";
    header.profile = "native";
    header.data_window = header.display_window = {0, 0, width - 1, height - 1};
    for (const ChannelRole& role : channel_roles()) {
        if (role.kind == RoleKind::display) continue;
        capture.images[role.name] = Image(width, height, role.channels, role.type);
        header.roles.push_back(role.name);
    }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int left = width / 4 + 3 * frame;
            const bool box = x >= left && x < left + width / 4 && y >= height / 4 && y < height * 3 / 4;
            const bool sky = !box && y < height / 3;
            const bool lamp = !box && x % 17 == 5 && y % 11 == 4;
            TestPoint point;
            point.u = float(x) / float(width);
            point.y = float(y);
            point.light = lamp ? 500.0f : 0.2f + point.u;
            point.depth_m = box ? 2.0f : sky ? std::numeric_limits<float>::infinity() : 4.0f + 8.0f * point.u;
            point.box = box;
            point.sky = sky;
            for (auto& [name, image] : capture.images) put(*find_role(name), point, image, x, y);
        }
    return capture;
}

/// Layers that the effect reads: the whole picture again, so that every value is one that the role may have.
void add_layers(const EffectManifest& manifest, Capture& capture) {
    for (const InputSpec& input : manifest.inputs)
        if (input.layer >= 0 && capture.images.contains(input.role))
            capture.images[input.image_role()] = Image(capture.images.at(input.role));
}

/// What no capture has by itself but the effect cannot do without: small numbers.
void add_required_images(const EffectManifest& manifest, Capture& capture) {
    const Image& depth = capture.images.at(kDepthRole);
    for (const InputSpec& input : manifest.inputs) {
        const ChannelRole role = *find_role(input.role);
        const bool is_missing = role.kind == RoleKind::other || role.kind == RoleKind::display;
        if (!is_missing || input.optional || capture.images.contains(input.role)) continue;
        Image image(depth.width(), depth.height(), role.channels);
        for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = 0.001f * float(i % 7);
        capture.images[input.role] = std::move(image);
        capture.header.roles.push_back(input.role);
    }
}

/// None where all is well.
std::vector<Diagnostic> faults_of(gpu::Context& context, const EffectManifest& manifest,
                                  const Setting& setting, const std::filesystem::path& data_folder,
                                  NativeSources natives) {
    const Pipeline pipeline = pipeline_of(manifest, setting);
    std::vector<std::string> roles;
    for (const OutputSpec& output : manifest.outputs) roles.push_back(output.role);
    RendererOptions drawing;
    drawing.guards_loops = true;
    PipelineRenderer renderer(context, pipeline, data_folder, natives, drawing);
    std::set<int> offsets = pipeline.neighbour_offsets();
    offsets.insert({-1, 0, 1});
    // Two frames, so that history is read.
    for (const int number : {1, 2}) {
        FrameSetting among;
        for (const int offset : offsets) {
            auto capture = std::make_shared<Capture>(make_test_capture(64, 36, number + offset));
            add_required_images(manifest, *capture);
            if (offset == 0) add_layers(manifest, *capture);
            among.neighbours[offset] = std::move(capture);
        }
        const FrameInputs frame = among.inputs(*among.neighbours.at(0));
        try {
            // Timed, so that each pass has ended before the next begins: what fails is then known.
            const std::string bad = first_bad_value(renderer.render(frame, roles, true));
            if (!bad.empty()) return {{Severity::error, {}, bad}};
        } catch (const Error& error) {
            return error.faults();
        }
    }
    return {};
}

/// A shader's faults have places; others are the manifest's.
void add_fault(const EffectManifest& manifest, const Setting& setting, const Diagnostic& fault,
               Diagnostics& diagnostics) {
    // The check of the texts may have found the same.
    const bool is_known = std::ranges::any_of(diagnostics.all(), [&](const Diagnostic& found) {
        return to_string(found.place) == to_string(fault.place) && found.message == fault.message;
    });
    if (is_known) return;
    if (!fault.place.file.empty())
        return diagnostics.error(fault.place, fault.message + " (with " + setting.name + ")");
    for (const std::string_view line : split(fault.message, '\n'))
        diagnostics.error({manifest.document.string()}, "with " + setting.name + ": " + std::string(line));
}

}  // namespace

void check_effect(gpu::Context& context, const EffectManifest& manifest,
                  const std::filesystem::path& data_folder, NativeSources natives, Diagnostics& diagnostics) {
    std::set<std::string> told;
    for (const Setting& setting : settings_of(manifest)) {
        const std::vector<Diagnostic> faults = faults_of(context, manifest, setting, data_folder, natives);
        std::string text;
        for (const Diagnostic& fault : faults) text += to_string(fault.place) + ": " + fault.message + "\n";
        if (!told.insert(text).second) continue;
        for (const Diagnostic& fault : faults) add_fault(manifest, setting, fault, diagnostics);
    }
}

}  // namespace aftershade
