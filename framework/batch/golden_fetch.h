// The images of a suite with a store, fetched into its folder of goldens.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "framework/batch/golden_suite.h"

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

}  // namespace aftershade
