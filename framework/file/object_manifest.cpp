#include "framework/file/object_manifest.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "framework/base/error.h"
#include "framework/base/side_file.h"

namespace aftershade {

namespace {

namespace fs = std::filesystem;

/// nullopt where there is none. A name that leads out of the file's folder is not followed: files come from
/// elsewhere. A folder may be one of links to a farm's storage, and the manifest beside the link's target.
std::optional<std::string> manifest_beside(const fs::path& exr, const std::optional<std::string>& name) {
    constexpr std::uintmax_t kMaxBytes = 64 << 20;
    if (!name || name->empty() || fs::path(*name).filename() != *name) return std::nullopt;
    std::error_code failure;
    const fs::path folder = exr.parent_path();
    std::string fault, fault_of_target = kNoSuchFile;
    std::string text = read_file_below(folder, *name, kMaxBytes, fault);
    if (!fault.empty() && fs::is_symlink(exr, failure))
        text = read_file_below(fs::canonical(exr, failure).parent_path(), *name, kMaxBytes, fault_of_target);
    if (fault.empty() || fault_of_target.empty()) return text;
    if (fault == kNoSuchFile) return std::nullopt;
    throw Error(ErrorKind::capture, (folder / *name).string() + ", the Cryptomatte manifest of " +
                                        exr.filename().string() + ": " + fault);
}

}  // namespace

std::vector<std::string> cryptomatte_keys(const ExrMetadata& metadata) {
    constexpr std::string_view kHead = "cryptomatte/", kName = "/name";
    std::vector<std::string> keys;
    for (const std::string& attribute : metadata.names())
        if (attribute.starts_with(kHead) && attribute.ends_with(kName))
            keys.push_back(attribute.substr(0, attribute.size() - kName.size()));
    return keys;
}

std::vector<ManifestEntry> read_object_manifest(const fs::path& exr, const ExrMetadata& metadata,
                                                const std::string& key) {
    auto manifest = metadata.text(key + "/manifest");
    if (!manifest) manifest = manifest_beside(exr, metadata.text(key + "/manif_file"));
    std::vector<ManifestEntry> entries;
    const auto parsed = nlohmann::json::parse(manifest.value_or("{}"), nullptr, false);
    if (!parsed.is_object()) return entries;
    for (const auto& [object, hash] : parsed.items()) {
        const std::string text = hash.is_string() ? hash.get<std::string>() : "";
        std::uint32_t id = 0;
        const auto end = std::from_chars(text.data(), text.data() + text.size(), id, 16);
        const bool is_id = end.ec == std::errc() && end.ptr == text.data() + text.size() && id != 0;
        entries.push_back({object, is_id ? std::optional(id) : std::nullopt});
    }
    return entries;
}

}  // namespace aftershade
