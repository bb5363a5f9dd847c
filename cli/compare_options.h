// The words of `aftershade compare`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/cli11.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/batch/process_codes.h"
#include "framework/compare/compare_files.h"

namespace aftershade::cli {

/// Wrong usage of `compare`, whose other codes are idiff's; idiff's own code for it is that of a warning.
inline constexpr ExitCode kCompareUsage = ExitCode(64);

/// As idiff has them.
struct ToleranceOptions {
    std::optional<double> limit, relative, ulp, percent, hard, flip, ssim;
    std::optional<std::uint64_t> allowed;
    bool any() const { return limit || relative || ulp || percent || hard || allowed; }
};

/// --ignore, --area and --layer.
struct CompareAreaOptions {
    std::vector<std::string> ignored;  ///< WHERE
    std::vector<std::string> areas;    ///< WHERE=LIMIT
    std::vector<std::string> layers;   ///< LAYER=LIMIT
    std::string objects_from;          ///< a capture; "": the reference
};

struct CompareOptions {
    std::string reference, test;
    ToleranceOptions fail, warn;
    bool nan_equal = false, absolute = false, json = false, quiet = false, no_ssim = false,
         only_different = false, fill_outside = false;
    double scale = 1;
    std::string output, heat_map, side_by_side, csv;
    std::string flip = "auto", tone_mapper = "aces";
    std::optional<double> pixels_per_degree, start_exposure, stop_exposure;
    std::vector<double> viewing;
    std::optional<int> exposures;
    std::vector<std::string> roles;
    CompareAreaOptions areas;
    int forgive_shift_px = 0;
    double forgive_blur_px = 0;
    int threads = 0;
};

void add_compare_options(CLI::App& app, CompareOptions& options);

/// Throws CodedError(kCompareUsage) with every fault of the words, Error(ErrorKind::capture) where a mask or
/// objects cannot be read.
CompareRules rules_of(const CompareOptions& options);

}  // namespace aftershade::cli
