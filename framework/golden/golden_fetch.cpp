#include "framework/golden/golden_fetch.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "framework/base/atomic_file.h"
#include "framework/base/cache_room.h"
#include "framework/base/error.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/sha256.h"
#include "framework/base/side_file.h"
#include "framework/effect/program_store.h"
#include "framework/golden/approved_image.h"
#include "framework/golden/golden_store.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

struct WantedImage {
    std::string test;  ///< name of the case
    fs::path folder;   ///< of its goldens
    std::string name;  ///< "lens.color.0001.exr"
};

using Wanted = std::multimap<std::string, WantedImage>;  ///< by digest

/// Images of the case that are not beside their sidecars as these name them.
void add_wanted(const GoldenCase& test, Wanted& wanted, UnfetchedImages& unfetched) {
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(test.goldens, absent)) {
        const std::string sidecar = entry.path().filename().string();
        const std::string image = fs::path(sidecar).replace_extension(".exr").string();
        const auto is_of_case = [&](const std::string& stem) {
            return approved_frame(image, stem).has_value();
        };
        if (entry.path().extension() != ".json" || std::ranges::none_of(test.image_stems(), is_of_case))
            continue;
        std::string fault;
        const std::string digest = stored_digest(test.goldens, sidecar, fault);
        if (!fault.empty()) unfetched[test.name].push_back(entry.path().string() + ": " + fault);
        else if (!digest.empty() && sha256_of_file(test.goldens / image) != digest)
            wanted.emplace(digest, WantedImage{test.name, test.goldens, image});
    }
}

/// The bytes were verified; the file may be another by now.
void place(const std::string& bytes, const std::string& digest, const Wanted& wanted) {
    const auto [first, last] = wanted.equal_range(digest);
    for (auto image = first; image != last; ++image) {
        try {
            write_text_file(path_below(image->second.folder, image->second.name), bytes);
        } catch (const Error& error) {
            throw Error(error.kind(), std::string(error.what()) +
                                          " (images of the store are written beside their sidecars: of a "
                                          "read-only checkout, run in a copy)");
        }
    }
}

/// Copies what the cache has, and takes it out of `wanted`.
void take_from_cache(GoldenCache& cache, Wanted& wanted) {
    for (auto image = wanted.begin(); image != wanted.end();) {
        const std::string digest = image->first, bytes = cache.load(digest);
        if (!bytes.empty()) place(bytes, digest, wanted);
        const auto next = wanted.upper_bound(digest);
        if (!bytes.empty()) wanted.erase(image, next);
        image = next;
    }
}

}  // namespace

FetchedGoldens fetch_goldens(const GoldenSuite& suite, const std::vector<std::string>& filters,
                             std::chrono::milliseconds timeout, const std::atomic<bool>& interrupt) {
    FetchedGoldens result;
    if (suite.store.empty()) return result;
    Wanted wanted;
    for (const GoldenCase& test : suite.cases)
        if (test.skip.empty() && fits_filter(test, filters)) add_wanted(test, wanted, result.unfetched);
    GoldenCache cache = GoldenCache::from_environment();
    take_from_cache(cache, wanted);
    std::set<std::string> digests;
    for (const auto& [digest, image] : wanted) digests.insert(digest);
    const ScratchFolder scratch;
    const auto faults =
        GoldenStore(suite.store, suite.folder(), timeout).fetch(digests, scratch.path(), interrupt);
    for (const std::string& digest : digests) {
        if (faults.contains(digest)) continue;
        const std::string bytes =
            read_text_file(scratch.path() / stored_name(digest), ErrorKind::output, kMaxStoredBytes);
        cache.save(digest, bytes);
        place(bytes, digest, wanted);
    }
    for (const auto& [digest, image] : wanted)
        if (const auto fault = faults.find(digest); fault != faults.end())
            result.unfetched[image.test].push_back((image.folder / image.name).string() +
                                                   ": not fetched: " + fault->second);
    if (!digests.empty()) cache.make_room();
    result.cache_fault = cache.fault();
    return result;
}

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
