#include "tests/fuzz/targets.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/base/text.h"
#include "framework/capture/capture.h"
#include "framework/capture/frame_range.h"
#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "framework/document/document.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/image_loads.h"
#include "framework/effect/isf/isf_effect.h"
#include "framework/effect/manifest/manifest_reader.h"
#include "framework/effect/native/native_wire.h"
#include "framework/effect/registry.h"
#include "framework/effect/usage_check.h"
#include "framework/file/exr_file.h"
#include "framework/file/hdr_file.h"
#include "framework/file/jpeg_file.h"
#include "framework/file/png_file.h"
#include "framework/golden/golden_case.h"
#include "framework/golden/golden_decisions.h"
#include "framework/golden/golden_suite.h"
#include "framework/image/lut.h"
#include "framework/image/role.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"
#include "framework/render/history_file.h"
#include "framework/run/journal.h"
#include "framework/scattering/scattering_profile.h"
#include "framework/scene/gltf_model.h"
#include "framework/scene/mesh.h"
#include "framework/scene/scene_reader.h"
#include "framework/serve/http_message.h"
#include "framework/serve/look_edits.h"
#include "tests/temporary_folder.h"

namespace aftershade::fuzz {

namespace {

namespace fs = std::filesystem;

const fs::path kSources = AFTERSHADE_SOURCE_DIR;

[[noreturn]] void broken(const char* promise) {
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

const fs::path& work_folder() {
    static const test::TemporaryFolder folder;
    return folder.path();
}

fs::path file_of(const char* name, std::string_view bytes) {
    fs::path path = work_folder() / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return path;
}

/// Calls `read`; a refusal must be an Error with a message, and name no code that means our own fault.
template <class Read>
void refused_or_read(Read read) {
    try {
        read();
    } catch (const Error& error) {
        if (std::strlen(error.what()) == 0) broken("a refusal has a message");
        if (error.kind() != ErrorKind::capture && error.kind() != ErrorKind::usage)
            broken("a document or a file of the user is at fault, and nothing else");
    } catch (const std::bad_alloc&) {
        broken("sizes are limited before anything is allocated");
    }
}

/// Parses the document, and hands it on if it is JSON.
template <class Read>
void document(const char* name, std::string_view bytes, Read read) {
    Diagnostics faults;
    const fs::path file = file_of(name, bytes);
    const auto node = read_document(file, faults);
    if (!node && !faults.has_errors()) broken("what is not read has a fault");
    if (node) refused_or_read([&] { read(*node, file, faults); });
    for (const Diagnostic& fault : faults.all())
        if (fault.message.empty()) broken("a fault has a message");
}

// ---- pictures ----

constexpr ReadLimits kSmall{.max_side_px = 1024, .max_image_bytes = 8 * 1024 * 1024};

void exr(std::string_view bytes) {
    const fs::path file = file_of("in.exr", bytes);
    refused_or_read([&] {
        const ExrFile exr_file(file, kSmall);
        for (std::size_t part = 0; part < exr_file.parts().size(); ++part)
            for (const ExrChannel& channel : exr_file.parts()[part].channels)
                refused_or_read([&] {
                    const std::vector<std::string> one{channel.name};
                    if (exr_file.parts()[part].is_deep()) exr_file.read_deep(int(part), one);
                    else exr_file.read_floats(int(part), one);
                });
    });
}

void capture_file(std::string_view bytes) {
    static const std::vector<Profile> profiles = [] {
        Diagnostics faults;
        return read_profiles(kSources / "profiles", faults);
    }();
    Sequence sequence;
    sequence.files = FramePattern::of_file(file_of("in.exr", bytes).string());
    sequence.cryptomatte = CryptomatteChoice{"", {}};
    for (const bool with_matte : {false, true}) {
        if (!with_matte) sequence.cryptomatte.reset();
        else sequence.cryptomatte = CryptomatteChoice{"", {"Cube"}};
        std::vector<RoleId> roles = role_ids(role_names());
        for (const char* role : {kColorRole, kDepthRole, kObjectIdRole})
            roles.push_back(RoleId::of_layer(2, role));
        refused_or_read([&] { CaptureReader(sequence, profiles, kSmall).read(1, roles); });
    }
}

void png(std::string_view bytes) {
    const fs::path file = file_of("in.png", bytes);
    refused_or_read([&] { read_png(file); });
}

void jpeg(std::string_view bytes) {
    const fs::path file = file_of("in.jpg", bytes);
    refused_or_read([&] { read_jpeg(file); });
}

void hdr(std::string_view bytes) {
    const fs::path file = file_of("in.hdr", bytes);
    refused_or_read([&] { read_hdr(file); });
}

void cube(std::string_view bytes) {
    Diagnostics faults;
    const auto lut = parse_lut(bytes, "in.cube", faults);
    if (lut.has_value() == faults.has_errors()) broken("a table is read, or has faults");
}

void gltf(std::string_view bytes) {
    const fs::path file = file_of(bytes.starts_with("glTF") ? "in.glb" : "in.gltf", bytes);
    refused_or_read([&] { scene::read_gltf_model(file); });
}

/// Three bytes say the size and the compression, the rest are the pixels' bits, halves and floats in turn.
void round_trip(std::string_view bytes) {
    if (bytes.size() < 3) return;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i % bytes.size()]); };
    const int width = 1 + byte(0) % 40, height = 1 + byte(1) % 40;
    constexpr const char* kLossless[] = {"none", "rle", "zips", "zip", "piz"};
    Image image(width, height, 2);
    for (std::size_t i = 0; i < image.floats().size(); ++i) {
        const std::uint32_t bits = std::uint32_t(byte(3 + 4 * i)) | std::uint32_t(byte(4 + 4 * i)) << 8 |
                                   std::uint32_t(byte(5 + 4 * i)) << 16 |
                                   std::uint32_t(byte(6 + 4 * i)) << 24;
        std::memcpy(&image.floats()[i], &bits, sizeof bits);
    }
    const fs::path file = work_folder() / "out.exr";
    const std::vector<ExrOutputChannel> channels = {{"a", PixelType::float32, &image, 0},
                                                    {"b", PixelType::float32, &image, 1}};
    ExrWriteOptions options;
    options.data_window = {byte(2), -int(byte(2)), int(byte(2)) + width - 1, height - 1 - int(byte(2))};
    options.display_window = options.data_window;
    options.compression = kLossless[byte(2) % std::size(kLossless)];
    write_exr(file, channels, options);
    const Image read = ExrFile(file).read_floats(0, std::vector<std::string>{"a", "b"});
    if (read.floats().size_bytes() != image.floats().size_bytes() ||
        std::memcmp(read.floats().data(), image.floats().data(), image.floats().size_bytes()) != 0)
        broken("what is written is read to the bit");
}

// ---- documents ----

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

// ---- text ----

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

// ---- what runs leave for each other, and what other processes send ----

/// The first line describes resources, the rest are their bytes; the checksum is right.
void history(std::string_view bytes) {
    const std::size_t line = std::min(bytes.find('\n'), bytes.size());
    const std::string_view head = bytes.substr(0, line);
    const std::string_view resources = bytes.substr(std::min(line + 1, bytes.size()));
    const std::uint64_t sum = fnv1a(std::as_bytes(std::span(resources)), fnv1a(head));
    std::string file = "aftershade-history 1\n";
    file.append(head).append("\n").append(resources).append(reinterpret_cast<const char*>(&sum), sizeof sum);
    const fs::path path = file_of("in.history", file);
    refused_or_read([&] { read_history(path); });
}

void journal(std::string_view bytes) {
    const RunState state = run_state((work_folder() / "run/out_####.exr").string());
    fs::create_directories(state.state_folder());
    file_of("run/.aftershade/journal.jsonl", bytes);
    const std::vector<fs::path> expected{work_folder() / "run/out_0001.exr"};
    const Journal read(state);
    if (const JournalFrame* frame = read.find(1)) {
        read.setup(frame->setup);
        // No frame was rendered here.
        if (read.fault_of_files(*frame, expected).empty()) broken("a frame without its files is not current");
    }
}

/// What the process of a plug-in answers may be the plug-in's own.
void plugin(std::string_view bytes) {
    const auto refused = [](const auto& take) {
        try {
            take();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::effect) broken("a plug-in is at fault, and nothing else");
        }
    };
    refused([&] {
        WireReader in(bytes);
        take_declaration(in);
        in.expect_end();
    });
    refused([&] {
        WireReader in(bytes);
        const NativeResult result = take_result(in);
        in.expect_end();
        WireWriter out;
        put(out, result);
        WireReader again(out.bytes());
        take_result(again);
        again.expect_end();
    });
    refused([&] {
        WireReader in(bytes);
        WireFrame frame;
        take_frame(in, frame);
        in.expect_end();
    });
}

/// As a connection gets its bytes: in pieces of this size.
std::optional<serve::Request> arrived(std::string_view bytes, std::size_t piece, bool& is_refused) {
    serve::Incoming incoming;
    for (; !bytes.empty() && !is_refused && !incoming.is_whole();
         bytes.remove_prefix(std::min(piece, bytes.size()))) {
        const auto refusal = incoming.add(bytes.substr(0, piece));
        if (refusal && refusal->status < 400) broken("a refusal is one");
        is_refused = refusal.has_value();
    }
    return incoming.is_whole() ? std::optional(incoming.take()) : std::nullopt;
}

void http(std::string_view bytes) {
    bool is_refused = false, is_refused_in_pieces = false;
    const auto request = arrived(bytes, std::max<std::size_t>(bytes.size(), 1), is_refused);
    const auto in_pieces = arrived(bytes, bytes.size() / 3 + 1, is_refused_in_pieces);
    if (is_refused != is_refused_in_pieces || request.has_value() != in_pieces.has_value())
        broken("how the bytes are divided decides nothing");
    if (!request) return;
    if (request->body.size() > serve::kMaxBodyBytes) broken("a body is no larger than it may be");
    if (request->path != in_pieces->path || request->body != in_pieces->body)
        broken("how the bytes are divided changes nothing");
    serve::response_bytes(serve::error_response(404, request->path));
}

/// A list of edits, one after the other, of one look.
void edit(std::string_view bytes) {
    using Json = nlohmann::ordered_json;
    constexpr int kDeepest = 80;  // the page server refuses what is nested deeper
    int depth = 0;
    const Json edits = Json::parse(
        bytes,
        [&](int level, Json::parse_event_t, Json&) {
            depth = std::max(depth, level);
            return level <= kDeepest;
        },
        false);
    if (depth > kDeepest || !edits.is_array()) return;
    const auto is_document = [](const std::string& text) {
        Diagnostics faults;
        return text.size() <= kMaxDocumentBytes && parse_document(text, "look.json", faults);
    };
    static const std::string look = read_text_file(kSources / "tests/schema/look.json", ErrorKind::usage);
    std::string text = look;
    for (const Json& each : edits)
        refused_or_read([&] {
            const bool was_document = is_document(text);
            text = serve::edited(text, each);
            // The whole text may be anything, and values may nest too deep together.
            const bool may_be_faulty = each.value("op", "") == "text" || depth > 50;
            if (was_document && !may_be_faulty && text.size() <= kMaxDocumentBytes && !is_document(text))
                broken("what an edit makes of a look is a document");
        });
}

constexpr Target kTargets[] = {
    {"exr", "in.exr", exr},
    {"capture_file", "in.exr", capture_file},
    {"png", "in.png", png},
    {"hdr", "in.hdr", hdr},
    {"jpeg", "in.jpg", jpeg},
    {"cube", "in.cube", cube},
    {"gltf", "in.glb", gltf},
    {"round_trip", "in.bin", round_trip},
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
    {"history", "in.history", history},
    {"journal", "journal.jsonl", journal},
    {"plugin", "in.bin", plugin},
    {"http", "in.http", http},
    {"edit", "edits.json", edit},
};

}  // namespace

std::span<const Target> targets() {
    return kTargets;
}

}  // namespace aftershade::fuzz
