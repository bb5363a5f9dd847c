#include "framework/golden/approved_image.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/cores.h"
#include "framework/base/lfs_pointer.h"
#include "framework/base/path_bounds.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/capture/frame_range.h"
#include "framework/document/document.h"

namespace aftershade {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// What of `text` follows the first `word`, up to one of `ends`.
std::string after_word(std::string_view text, std::string_view word, std::string_view ends) {
    const std::size_t found = text.find(word);
    if (found == std::string_view::npos) return "";
    text.remove_prefix(found + word.size());
    return std::string(text.substr(0, text.find_first_of(ends)));
}

/// Where a sidecar of an earlier version does not say it.
bool is_software(const std::string& renderer) {
    constexpr std::array kNames = {"llvmpipe", "softpipe", "swrast", "SwiftShader", "software"};
    return std::any_of(kNames.begin(), kNames.end(),
                       [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

/// "llvmpipe" for the renderer "llvmpipe (LLVM 15.0.6, 256 bits)": the width of the vectors changes no bit.
std::string kind_of(const GoldenEnvironment& environment) {
    const std::string& renderer = environment.renderer;
    return environment.llvm().empty() ? renderer : renderer.substr(0, renderer.find(" (LLVM "));
}

std::string instead_of(std::string_view what, const std::string& now, const std::string& before) {
    return now == before ? "" : std::string(what) + " " + now + " instead of " + before;
}

constexpr std::uintmax_t kMaxSidecarBytes = 1024 * 1024;

/// "AMD EPYC 7763 (64-core)" as a part of a file's name: "amd-epyc-7763-64-core".
std::string slug(const std::string& text) {
    std::string result;
    for (const unsigned char c : text) {
        if (std::isalnum(c) || c == '.') result += char(std::tolower(c));
        else if (!result.empty() && result.back() != '-') result += '-';
    }
    while (result.ends_with('-') || result.ends_with('.')) result.pop_back();
    return result;
}

std::string digest_of(const Json& sidecar) {
    const auto found = sidecar.find("sha256");
    if (found == sidecar.end() || !found->is_string()) return "";
    const std::string digest = found->get<std::string>();
    const bool fits = digest.size() == 64 && digest.find_first_not_of("0123456789abcdef") == digest.npos;
    return fits ? digest : "";
}

std::optional<GoldenSidecar> read_sidecar(const fs::path& image, std::optional<SidecarFault>& fault) {
    const fs::path file = sidecar_path(image);
    constexpr const char* kRemedy = " (golden approve writes it again)";
    std::error_code failure;
    if (!fs::exists(file, failure) && !fs::is_symlink(file, failure)) return std::nullopt;
    std::string unreadable;
    const Json json = Json::parse(read_regular_file(file, kMaxSidecarBytes, unreadable), nullptr, false);
    if (!unreadable.empty() || !json.is_object()) {
        const std::string pointer = lfs_fault(file);
        if (unreadable.empty()) unreadable = "is not a sidecar, not even a JSON object";
        fault = {Verdict::file_error,
                 file.string() + ": " + (pointer.empty() ? unreadable + kRemedy : pointer)};
        return std::nullopt;
    }
    const auto text = [&](const char* key) {
        const auto found = json.find(key);
        return found != json.end() && found->is_string() ? printable(found->get<std::string>())
                                                         : std::string();
    };
    GoldenSidecar sidecar;
    sidecar.environment = {text("backend"), text("renderer"), text("version"), text("cpu"), false};
    const auto software = json.find("software");
    sidecar.environment.software = software != json.end() && software->is_boolean()
                                       ? software->get<bool>()
                                       : is_software(sidecar.environment.renderer);
    sidecar.environment.instructions = text("instructions");
    sidecar.command = text("command");
    sidecar.sources = {text("look_hash"), text("capture_hash"), text("program")};
    sidecar.image_hash = text("image_hash");
    sidecar.approver = text("approver");
    sidecar.approved = text("approved");
    sidecar.origin = origin_of(json);
    sidecar.sha256 = digest_of(json);
    if (sidecar.image_hash.empty() || sidecar.image_hash == file_hash(image)) return sidecar;
    fault = {Verdict::warning,
             file.string() + ": is of another image than " + image.filename().string() + kRemedy};
    return std::nullopt;
}

}  // namespace

std::string GoldenEnvironment::mesa() const {
    return after_word(version, "Mesa ", " \t");
}
std::string GoldenEnvironment::llvm() const {
    return after_word(renderer, "LLVM ", " ,)");
}

std::string GoldenEnvironment::key() const {
    // LLVM's version follows from Mesa's package.
    const std::string driver = mesa();
    return slug(kind_of(*this) + " " + (driver.empty() ? version : driver) + " " + instructions);
}

std::string GoldenEnvironment::difference(const GoldenEnvironment& other) const {
    if (kind_of(*this) != kind_of(other)) return instead_of("the renderer", kind_of(*this), kind_of(other));
    if (mesa().empty() || other.mesa().empty()) return instead_of("the driver", version, other.version);
    if (mesa() != other.mesa()) return instead_of("Mesa", mesa(), other.mesa());
    if (llvm() != other.llvm()) return instead_of("LLVM", llvm(), other.llvm());
    if (!software) return "";
    // A sidecar of old form knows the processor by its name alone, and may be of one that Mesa used in full.
    if (instructions.empty() || other.instructions.empty()) {
        const bool limited = (instructions + other.instructions).find("without FMA") != std::string::npos;
        return limited ? "one processor is without FMA" : instead_of("the processor", cpu, other.cpu);
    }
    return instead_of("the processor is", instructions, other.instructions);
}

GoldenEnvironment environment_of(const gpu::ContextInfo& info) {
    // OSMesa and EGL are two ways to one software renderer.
    const gpu::Backend backend = info.software ? gpu::Backend::software : info.backend;
    return {std::string(gpu::backend_name(backend)), info.renderer, info.version, cpu_model(), info.software,
            info.software ? cpu_instructions() : ""};
}

Json json_of(const GoldenEnvironment& environment) {
    return {{"backend", environment.backend},
            {"renderer", environment.renderer},
            {"version", environment.version},
            {"mesa", environment.mesa()},
            {"llvm", environment.llvm()},
            {"cpu", environment.cpu},
            {"instructions", environment.instructions},
            {"software", environment.software}};
}

std::optional<int> approved_frame(const std::string& file_name, const std::string& image_stem) {
    std::string name = file_name;
    if (!name.ends_with(".exr")) return std::nullopt;
    name.resize(name.size() - 4);
    name = name.substr(0, name.find('@'));
    return FramePattern(image_stem + ".####").match(name);
}

std::vector<ApprovedImage> approved_images(const fs::path& folder, const std::string& name,
                                           const GoldenEnvironment& own) {
    std::vector<ApprovedImage> images;
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator(folder, unreadable)) {
        const std::string file = entry.path().filename().string();
        const bool first = file == name + ".exr";
        if (!first && !(file.starts_with(name + "@") && file.ends_with(".exr"))) continue;
        if (printable(file) != file)
            throw Error(ErrorKind::capture, (folder / printable(file)).string() +
                                                ": the golden's name has control characters, or is not UTF-8 "
                                                "(rename or remove it)");
        const std::size_t at = name.size() + 1;
        ApprovedImage& image = images.emplace_back();
        image.file = entry.path();
        for (const fs::path& beside : {image.file, sidecar_path(image.file)})
            if (const std::string why = out_of_bounds(beside, folder); !why.empty())
                throw Error(ErrorKind::capture, beside.string() + ": " + why);
        image.key = first ? "" : file.substr(at, file.size() - at - 4);
        image.sidecar = read_sidecar(entry.path(), image.sidecar_fault);
    }
    const std::string own_key = own.key();
    const auto rank = [&](const ApprovedImage& image) {
        if (image.sidecar && image.sidecar->environment.equals(own)) return 0;
        return image.key == own_key ? 1 : image.key.empty() ? 2 : 3;
    };
    std::ranges::sort(images, [&](const ApprovedImage& a, const ApprovedImage& b) {
        return std::pair(rank(a), a.key) < std::pair(rank(b), b.key);
    });
    return images;
}

fs::path sidecar_path(const fs::path& image) {
    return fs::path(image).replace_extension(".json");
}

std::string stored_digest(const fs::path& folder, const std::string& sidecar, std::string& fault) {
    const std::string text = read_file_below(folder, sidecar, kMaxSidecarBytes, fault);
    const Json json = Json::parse(text, nullptr, false);
    return fault.empty() && json.is_object() ? digest_of(json) : "";
}

std::string sidecar_text(const GoldenSidecar& sidecar) {
    Json json{{"aftershade", 1}};
    json.update(json_of(sidecar.environment));
    json["command"] = sidecar.command;
    json["look_hash"] = sidecar.sources.look;
    json["capture_hash"] = sidecar.sources.capture;
    json["program"] = sidecar.sources.program;
    json["image_hash"] = sidecar.image_hash;
    if (!sidecar.sha256.empty()) json["sha256"] = sidecar.sha256;
    if (!sidecar.approver.empty()) json["approver"] = sidecar.approver;
    if (!sidecar.approved.empty()) json["approved"] = sidecar.approved;
    add_origin(sidecar.origin, json);
    // Names of people need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string file_hash(const fs::path& file) {
    constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 34;
    std::string fault;
    const std::string bytes = read_regular_file(file, kMostBytes, fault);
    return fault.empty() ? fnv1a_hex(bytes) : "";
}

namespace {

std::map<std::string, std::string> texts_of(const Json& object) {
    std::map<std::string, std::string> texts;
    if (!object.is_object()) return texts;
    for (const auto& [key, value] : object.items())
        if (value.is_string()) texts[printable(key)] = printable(value.get<std::string>());
    return texts;
}

}  // namespace

void add_origin(const CaseOrigin& origin, Json& sidecar) {
    if (origin == CaseOrigin{}) return;
    sidecar["files"] = origin.files;
    sidecar["values"] = origin.values;
    Json& steps = sidecar["steps"] = Json::object();
    for (const StepHashes& step : origin.steps) steps[step.step] = step.outputs;
}

CaseOrigin origin_of(const Json& sidecar) {
    CaseOrigin origin;
    origin.files = texts_of(sidecar.value("files", Json()));
    origin.values = texts_of(sidecar.value("values", Json()));
    const Json steps = sidecar.value("steps", Json());
    if (steps.is_object())
        for (const auto& [step, outputs] : steps.items())
            origin.steps.push_back({printable(step), texts_of(outputs)});
    return origin;
}

}  // namespace aftershade
