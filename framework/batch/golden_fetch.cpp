#include "framework/batch/golden_fetch.h"

#include <algorithm>
#include <set>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/side_file.h"
#include "framework/batch/approved_image.h"
#include "framework/batch/golden_cache.h"
#include "framework/batch/golden_store.h"

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
    for (auto image = first; image != last; ++image)
        write_text_file(path_below(image->second.folder, image->second.name), bytes);
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

}  // namespace aftershade
