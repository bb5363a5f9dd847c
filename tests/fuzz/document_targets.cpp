// What users write: documents, shaders and ranges of frames.
#include <algorithm>
#include <span>
#include <string>

#include "framework/capture/frame_range.h"
#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/image_loads.h"
#include "framework/effect/isf/isf_effect.h"
#include "framework/effect/manifest/manifest_reader.h"
#include "framework/effect/registry.h"
#include "framework/effect/usage_check.h"
#include "framework/golden/golden_case.h"
#include "framework/golden/golden_decisions.h"
#include "framework/golden/golden_suite.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"
#include "framework/scattering/scattering_profile.h"
#include "framework/scene/scene_reader.h"
#include "tests/fuzz/target_checks.h"

namespace aftershade::fuzz {

namespace {

void look(std::string_view bytes) {
    static EffectRegistry effects({kSources / "effects"}, kSources / "glsl");
    document("look.json", bytes, [](const Node& node, const fs::path&, Diagnostics& faults) {
        const auto read = parse_look(node, faults);
        if (read) bind_pipeline(*read, effects, {}, faults);
    });
}

/// The effect's shaders lie where the bytes are read from.
void copy_shaders() {
    static const bool done = [] {
        fs::create_directories(work_folder() / "effects/every_form");
        for (const char* name : {"chosen.glsl", "main.comp", "main.frag", "main.vert"})
            fs::copy_file(kSources / "tests/schema/every_form" / name,
                          work_folder() / "effects/every_form" / name);
        fs::create_directories(work_folder() / "glsl");
        fs::copy(kSources / "tests/schema/every_part", work_folder() / "glsl/every_part",
                 fs::copy_options::recursive);
        return true;
    }();
    (void)done;
}

void manifest(std::string_view bytes) {
    copy_shaders();
    document("effects/every_form/effect.json", bytes,
             [](const Node& node, const fs::path& file, Diagnostics& faults) {
                 const auto read = parse_manifest(node, file.parent_path(), faults, work_folder() / "glsl");
                 if (read) check_declared_used(*read, work_folder() / "glsl", faults);
             });
}

void module_document(std::string_view bytes) {
    copy_shaders();
    file_of("glsl/every_part/module.json", bytes);
    Diagnostics faults;
    const auto node = read_document(kSources / "tests/schema/every_form/effect.json", faults);
    refused_or_read(
        [&] { parse_manifest(*node, work_folder() / "effects/every_form", faults, work_folder() / "glsl"); });
}

void capture(std::string_view bytes) {
    const fs::path file = file_of("capture.json", bytes);
    Diagnostics faults;
    refused_or_read([&] {
        const auto sequence = open_sequence(file.string(), faults);
        if (!sequence && !faults.has_errors()) broken("a capture is read, or has faults");
    });
}

void scene_document(std::string_view bytes) {
    document("scene.json", bytes, [](const Node& node, const fs::path&, Diagnostics& faults) {
        scene::parse_scene(node, faults);
    });
}

void golden(std::string_view bytes) {
    const fs::path file = file_of("golden.json", bytes);
    Diagnostics faults;
    refused_or_read([&] { read_golden_suite(file.string(), faults); });
}

/// What was read is written, and read again as the same.
void decisions(std::string_view bytes) {
    Diagnostics faults;
    const auto read = parse_decisions(bytes, "decisions.json", faults);
    if (faults.has_errors()) return;
    if (parse_decisions(decisions_text(read), "decisions.json", faults) != read)
        broken("decisions are written as they were read");
}

void golden_case(std::string_view bytes) {
    document("case.json", bytes, [](const Node& node, const fs::path& file, Diagnostics& faults) {
        parse_effect_case(node, file, kSources, faults);
    });
}

void profile(std::string_view bytes) {
    document("profile.json", bytes,
             [](const Node& node, const fs::path&, Diagnostics& faults) { parse_profile(node, faults); });
}

void scattering(std::string_view bytes) {
    document("scattering.json", bytes, [](const Node& node, const fs::path&, Diagnostics& faults) {
        parse_scattering_profile(node, "the profile", work_folder(), faults);
    });
}

void glsl(std::string_view bytes) {
    const fs::path file = file_of("shader/in.frag", bytes);
    file_of("shader/other.glsl", "#include \"in.frag\"\nfloat other;\n");
    EffectManifest manifest;
    PassSpec pass;
    pass.folder = file.parent_path();
    pass.shader = "in.frag";
    Diagnostics faults;
    refused_or_read([&] {
        const ShaderSource source = author_text(manifest, pass, kSources / "glsl", faults, ShaderFile::main);
        if (source.lines.size() > kMaxShaderLines || source.text.size() > kMaxShaderBytes)
            broken("a shader is no larger than its limits");
        check_shader_size(source, faults);
        glsl_tokens(source);
        ShaderSource loads = source;
        load_as_images(loads, {{0, gpu::TextureFormat::rgba32f}, {1, gpu::TextureFormat::r32ui}}, 0, 4);
        if (std::ranges::count(loads.text, '\n') != std::ranges::count(source.text, '\n'))
            broken("a shader whose fetches become loads keeps its lines");
    });
}

void isf(std::string_view bytes) {
    for (const IsfSpace space : {IsfSpace::display, IsfSpace::linear}) {
        Diagnostics faults;
        refused_or_read([&] {
            const auto read =
                read_isf_manifest(file_of("isf/in.fs", bytes), space, kSources / "glsl", faults);
            if (!read && !faults.has_errors()) broken("an ISF file is read, or has faults");
            if (read) check_declared_used(*read, kSources / "glsl", faults);
        });
        for (const Diagnostic& fault : faults.all())
            if (fault.place.file.empty() || fault.message.empty())
                broken("a fault of an ISF file has a place and a message");
    }
}

void frame_range(std::string_view bytes) {
    const auto frames = parse_frame_range(bytes);
    if (frames && parse_frame_range(format_frame_range(*frames)) != frames && !frames->empty())
        broken("a range that is written is read as the same frames");
    const FramePattern pattern{std::string(bytes)};
    for (const int frame : {-7, 0, 12, 123456})
        if (pattern.has_frame() && pattern.match(pattern.path(frame)) != frame)
            broken("a pattern finds the number that it wrote");
}

constexpr Target kDocumentTargets[] = {
    {"look", "look.json", look},
    {"manifest", "effect.json", manifest},
    {"module", "module.json", module_document},
    {"capture", "capture.json", capture},
    {"scene", "scene.json", scene_document},
    {"golden", "golden.json", golden},
    {"case", "case.json", golden_case},
    {"decisions", "decisions.json", decisions},
    {"profile", "profile.json", profile},
    {"scattering", "scattering.json", scattering},
    {"glsl", "in.frag", glsl},
    {"isf", "in.fs", isf},
    {"frame_range", "in.txt", frame_range},
};

}  // namespace

std::span<const Target> document_targets() {
    return kDocumentTargets;
}

}  // namespace aftershade::fuzz
