#include "framework/batch/approved_image.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "framework/capture/frame_range.h"
#include "framework/core/atomic_file.h"
#include "framework/core/document.h"
#include "framework/core/text.h"

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

constexpr std::string_view kVersionDigits = "0123456789.";

/// Where a sidecar of an earlier version does not say it.
bool is_software(const std::string& renderer) {
    constexpr std::array kNames = {"llvmpipe", "softpipe", "swrast", "SwiftShader", "software"};
    return std::any_of(kNames.begin(), kNames.end(),
                       [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

/// "llvmpipe (LLVM 15.0.6, 256 bits)" without "(LLVM 15.0.6,".
std::string without_llvm(const std::string& renderer) {
    constexpr std::string_view kLlvm = "LLVM ";
    const std::size_t found = renderer.find(kLlvm);
    if (found == std::string::npos) return renderer;
    const std::size_t digits = found + kLlvm.size();
    std::size_t end = std::min(renderer.find_first_not_of(kVersionDigits, digits), renderer.size());
    if (end == digits) return renderer;
    if (end < renderer.size() && renderer[end] == ',') ++end;
    const std::size_t begin = found > 0 && renderer[found - 1] == '(' ? found - 1 : found;
    return renderer.substr(0, begin) + renderer.substr(end);
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

std::optional<GoldenSidecar> read_sidecar(const fs::path& image, std::optional<SidecarFault>& fault) {
    const fs::path file = sidecar_path(image);
    constexpr const char* kRemedy = " (golden approve writes it again)";
    std::error_code failure;
    if (!fs::exists(file, failure) && !fs::is_symlink(file, failure)) return std::nullopt;
    std::string unreadable;
    const Json json = Json::parse(read_regular_file(file, kMaxSidecarBytes, unreadable), nullptr, false);
    if (!unreadable.empty() || !json.is_object()) {
        fault = {Verdict::file_error,
                 file.string() + ": " +
                     (unreadable.empty() ? "is not a sidecar, not even a JSON object" : unreadable) +
                     kRemedy};
        return std::nullopt;
    }
    const auto text = [&](const char* key) {
        const auto found = json.find(key);
        return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    GoldenSidecar sidecar;
    sidecar.environment = {text("backend"), text("renderer"), text("version"), text("cpu"), false};
    const auto software = json.find("software");
    sidecar.environment.software = software != json.end() && software->is_boolean()
                                       ? software->get<bool>()
                                       : is_software(sidecar.environment.renderer);
    sidecar.command = text("command");
    sidecar.look_hash = text("look_hash");
    sidecar.image_hash = text("image_hash");
    sidecar.approver = text("approver");
    sidecar.approved = text("approved");
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
    // LLVM's version follows from Mesa's package; the width of its vectors does not.
    const std::string name = without_llvm(renderer);
    const std::string driver = mesa();
    return slug(name + " " + (driver.empty() ? version : driver) + " " + cpu);
}

bool GoldenEnvironment::equals(const GoldenEnvironment& other) const {
    return renderer == other.renderer && mesa() == other.mesa() && cpu == other.cpu &&
           (!mesa().empty() || version == other.version);
}

GoldenEnvironment environment_of(const gpu::ContextInfo& info) {
    return {std::string(gpu::backend_name(info.backend)), info.renderer, info.version, cpu_model(),
            info.software};
}

Json json_of(const GoldenEnvironment& environment) {
    return {{"backend", environment.backend},  {"renderer", environment.renderer},
            {"version", environment.version},  {"mesa", environment.mesa()},
            {"llvm", environment.llvm()},      {"cpu", environment.cpu},
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
        const std::size_t at = name.size() + 1;
        ApprovedImage& image = images.emplace_back();
        image.file = entry.path();
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

std::string sidecar_text(const GoldenSidecar& sidecar) {
    Json json{{"aftershade", 1}};
    json.update(json_of(sidecar.environment));
    json["command"] = sidecar.command;
    json["look_hash"] = sidecar.look_hash;
    json["image_hash"] = sidecar.image_hash;
    if (!sidecar.approver.empty()) json["approver"] = sidecar.approver;
    if (!sidecar.approved.empty()) json["approved"] = sidecar.approved;
    // Names of people need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string file_hash(const fs::path& file) {
    std::error_code failure;
    const std::string bytes = read_text_file(file, failure);
    if (failure) return "";
    return fnv1a_hex(bytes);
}

std::string cpu_model() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

}  // namespace aftershade
