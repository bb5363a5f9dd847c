#include "framework/batch/approved_image.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "framework/capture/frame_range.h"
#include "framework/core/atomic_file.h"
#include "framework/core/text.h"

namespace aftershade {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::string first_match(const std::string& text, const char* pattern) {
    std::smatch match;
    return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

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

std::optional<GoldenSidecar> read_sidecar(const fs::path& image) {
    std::error_code absent;
    const Json json = Json::parse(read_text_file(sidecar_path(image), absent), nullptr, false);
    if (absent || !json.is_object()) return std::nullopt;
    const auto text = [&](const char* key) {
        const auto found = json.find(key);
        return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    GoldenSidecar sidecar;
    sidecar.environment = {text("backend"), text("renderer"), text("version"), text("cpu"), false};
    const auto software = json.find("software");
    sidecar.environment.software =
        software != json.end() && software->is_boolean()
            ? software->get<bool>()
            : std::regex_search(sidecar.environment.renderer,
                                std::regex("llvmpipe|softpipe|swrast|SwiftShader|software"));
    sidecar.command = text("command");
    sidecar.look_hash = text("look_hash");
    sidecar.image_hash = text("image_hash");
    sidecar.approver = text("approver");
    sidecar.approved = text("approved");
    if (!sidecar.image_hash.empty() && sidecar.image_hash != file_hash(image)) return std::nullopt;
    return sidecar;
}

}  // namespace

std::string GoldenEnvironment::mesa() const {
    return first_match(version, R"(Mesa (\S+))");
}
std::string GoldenEnvironment::llvm() const {
    return first_match(renderer, R"(LLVM (\d[\d.]*))");
}

std::string GoldenEnvironment::key() const {
    // LLVM's version follows from Mesa's package; the width of its vectors does not.
    const std::string name = std::regex_replace(renderer, std::regex(R"(\(?LLVM [\d.]+,?)"), "");
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
        images.push_back(
            {entry.path(), first ? "" : file.substr(at, file.size() - at - 4), read_sidecar(entry.path())});
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
