#include "framework/batch/golden_cache.h"

#include <system_error>

#include "framework/base/atomic_file.h"
#include "framework/base/cache_room.h"
#include "framework/base/sha256.h"
#include "framework/base/side_file.h"
#include "framework/batch/golden_store.h"
#include "framework/effect/program_store.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kBelow = "goldens";

bool is_cached_image(const fs::path& file) {
    const std::string digest = file.stem().string();
    return file.extension() == ".exr" && digest.size() == 64 &&
           digest.find_first_not_of("0123456789abcdef") == digest.npos;
}

}  // namespace

GoldenCache GoldenCache::from_environment() {
    return GoldenCache(ProgramStore::from_environment().folder());
}

void GoldenCache::note(const std::string& fault) {
    if (fault_.empty()) fault_ = fault + " (choose another folder with AFTERSHADE_CACHE, or off)";
}

std::string GoldenCache::load(const std::string& digest) {
    if (folder_.empty()) return "";
    const fs::path name = fs::path(kBelow) / stored_name(digest);
    std::string fault;
    std::string bytes = read_file_below(folder_, name, kMaxStoredBytes, fault);
    if (!fault.empty() && fault != kNoSuchFile) note((folder_ / name).string() + ": " + fault);
    if (!fault.empty() || sha256(bytes) != digest) return "";
    std::error_code read_only;
    fs::last_write_time(folder_ / name, fs::file_time_type::clock::now(), read_only);
    return bytes;
}

void GoldenCache::save(const std::string& digest, std::string_view bytes) {
    if (folder_.empty()) return;
    std::error_code failure;  // make_folder_below() has the reason
    fs::create_directories(folder_, failure);
    try {
        make_folder_below(folder_, kBelow);
        write_text_file(path_below(folder_, fs::path(kBelow) / stored_name(digest)), bytes);
    } catch (const Error& error) {
        note(error.what());
    }
}

void GoldenCache::make_room() {
    make_cache_room(folder_ / kBelow, max_bytes_, is_cached_image);
}

}  // namespace aftershade
