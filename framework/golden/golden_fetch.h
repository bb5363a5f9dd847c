// The images of a suite with a store, fetched into its folder of goldens, and their copies on this machine.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/golden/golden_suite.h"

namespace aftershade {

/// What a case lacks, by its name: a sentence for each image.
using UnfetchedImages = std::map<std::string, std::vector<std::string>>;

struct FetchedGoldens {
    UnfetchedImages unfetched;
    std::string cache_fault;  ///< why the cache was not used, with the remedy; "" where it was
};

/// For each sidecar of the cases that names a SHA-256: the image beside it has these bytes afterwards, or is
/// `unfetched`. Takes it from the cache, else from the store, whose images go into the cache. Nothing is done
/// for a suite without a store. Throws Error(ErrorKind::output) where it cannot be put there.
FetchedGoldens fetch_goldens(const GoldenSuite& suite, const std::vector<std::string>& filters,
                             std::chrono::milliseconds timeout, const std::atomic<bool>& interrupt);

/// Images by their SHA-256, in the folder "goldens" of the cache. Files appear by rename: any number of
/// processes may share it. A cache that cannot be used costs time only: what it could not do is in fault().
class GoldenCache {
public:
    static constexpr std::uint64_t kMaxBytes = std::uint64_t(4) << 30;

    /// "": keeps nothing.
    explicit GoldenCache(std::filesystem::path folder, std::uint64_t max_bytes = kMaxBytes)
        : folder_(std::move(folder)), max_bytes_(max_bytes) {}
    /// In the cache that AFTERSHADE_CACHE names.
    static GoldenCache from_environment();

    /// Bytes with this digest, which count as used now; "" where there are none.
    std::string load(const std::string& digest);
    void save(const std::string& digest, std::string_view bytes);
    /// Removes those that were used longest ago, until the rest has at most `max_bytes`.
    void make_room();
    /// The first reason why something could not be read or written, with the remedy; "" where all could.
    const std::string& fault() const { return fault_; }

private:
    void note(const std::string& fault);

    std::filesystem::path folder_;
    std::uint64_t max_bytes_;
    std::string fault_;
};

}  // namespace aftershade
