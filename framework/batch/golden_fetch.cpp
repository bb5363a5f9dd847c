#include "framework/batch/golden_fetch.h"

#include <algorithm>
#include <set>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/batch/approved_image.h"
#include "framework/batch/golden_store.h"
#include "framework/effect/program_store.h"

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

void place(const fs::path& image, const WantedImage& wanted) {
    const fs::path target = path_below(wanted.folder, wanted.name);
    write_text_file(target, read_text_file(image, ErrorKind::output, kMaxStoredBytes));
}

/// Copies what the cache has, and takes it out of `wanted`.
void take_from_cache(const fs::path& cache, Wanted& wanted) {
    std::erase_if(wanted, [&](const auto& entry) {
        const auto& [digest, image] = entry;
        const fs::path kept = cache / stored_name(digest);
        if (sha256_of_file(kept) != digest) return false;
        place(kept, image);
        return true;
    });
}

}  // namespace

UnfetchedImages fetch_goldens(const GoldenSuite& suite, const std::vector<std::string>& filters,
                              std::chrono::milliseconds timeout, const std::atomic<bool>& interrupt) {
    UnfetchedImages unfetched;
    if (suite.store.empty()) return unfetched;
    Wanted wanted;
    for (const GoldenCase& test : suite.cases)
        if (test.skip.empty() && fits_filter(test, filters)) add_wanted(test, wanted, unfetched);
    const fs::path programs = ProgramStore::from_environment().folder();
    const fs::path cache = programs.empty() ? programs : programs / "goldens";
    if (!cache.empty()) take_from_cache(cache, wanted);
    std::set<std::string> digests;
    for (const auto& [digest, image] : wanted) digests.insert(digest);
    const ScratchFolder scratch;
    const auto faults =
        GoldenStore(suite.store, suite.folder(), timeout).fetch(digests, scratch.path(), interrupt);
    if (!cache.empty() && !digests.empty()) fs::create_directories(cache);
    for (const auto& [digest, image] : wanted) {
        const fs::path fetched = scratch.path() / stored_name(digest);
        if (const auto fault = faults.find(digest); fault != faults.end()) {
            const std::string sidecar = (image.folder / image.name).replace_extension(".json").string();
            unfetched[image.test].push_back((image.folder / image.name).string() +
                                            ": not fetched: " + fault->second +
                                            " (if the store has lost it, put it there again, or remove " +
                                            sidecar + " and approve a new one)");
            continue;
        }
        if (!cache.empty())
            write_text_file(path_below(cache, stored_name(digest)),
                            read_text_file(fetched, ErrorKind::output, kMaxStoredBytes));
        place(fetched, image);
    }
    return unfetched;
}

}  // namespace aftershade
