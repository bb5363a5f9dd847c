// A golden suite from its cases to verdicts: parallel workers, each image compared with the
// approved ones.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/compare/compare_files.h"
#include "framework/golden/approved_image.h"
#include "framework/golden/golden_fetch.h"
#include "framework/golden/golden_render.h"
#include "framework/golden/golden_suite.h"
#include "framework/golden/report_pictures.h"

namespace aftershade {

/// Paths relative to the report's folder; "" where there is none.
struct GoldenPictures {
    std::string reference, test, difference, heat_map, side_by_side;  ///< .png
    std::string reference_exr, test_exr;                              ///< as they are
    std::string reference_hash, test_hash;                            ///< of both, as file_hash() gives them
    double difference_scale = 1;  ///< of difference.png: |reference - test| times this
};

/// Which pixels of a layer the areas of a tolerance hold. [value type]
struct AreaMap {
    /// A mark and how many pixels in a row have it, from the window's upper left, row by row: 0 no area, -1
    /// left out, i the i-th area with limits of its own.
    struct Run {
        int mark = 0;
        std::uint64_t pixels = 0;
    };
    Window window;  ///< in px of the files
    std::vector<Run> runs;
};

/// One image of a case against the approved image that is nearest to it.
struct GoldenImage {
    std::string name, output;
    int frame = 0;
    Verdict verdict = Verdict::same;
    std::vector<std::string> reasons;  ///< of the verdict
    std::optional<ApprovedImage> approved;
    std::size_t approved_count = 0;  ///< images by this name; 0: missing
    /// Environment and look are those that the approved image was made by: every bit must be the same.
    bool exact_tier = false;
    bool bits_equal = false;
    /// If bits differ: what has changed since the approved image was made (look or effects, capture, program,
    /// machine), a sentence each without a full stop. Empty if its sidecar does not record it.
    std::vector<std::string> changes;
    bool only_machine_changed = false;
    std::optional<Comparison> comparison;
    CompareRules rules;  ///< of the comparison; areas by name alone
    GoldenPictures pictures;
    std::map<std::string, AreaMap> areas;  ///< by layer, where there are pictures
};

struct GoldenCaseResult {
    const GoldenCase* test = nullptr;
    Verdict verdict = Verdict::same;
    std::string skipped;  ///< why; "" where it ran
    std::vector<std::string> messages;
    std::vector<GoldenImage> images;
    std::string command;  ///< what rendered it
    GoldenSources sources;
    double seconds = 0;  ///< rendering and comparing
};

struct GoldenRunOptions {
    GoldenRenderOptions render;
    GoldenEnvironment environment;  ///< of the workers
    std::string program;            ///< GoldenSources::program
    std::vector<std::string> filters;
    UnfetchedImages unfetched;     ///< of a store; these cases have no verdict but a file error
    std::filesystem::path report;  ///< <report>/images exists and is for pictures; "": none are written
    int jobs = 1;
    bool no_skip = false;  ///< a skipped case fails
    int runs = 1;          ///< times that each case is drawn; it fails where the bits differ
};

struct GoldenSuiteResult {
    std::vector<GoldenCaseResult> cases;  ///< those that fit the filters, in the suite's order
    std::vector<std::filesystem::path> orphans;
    Verdict verdict = Verdict::same;  ///< the worst; at least a warning where all were skipped
    double seconds = 0;
    bool interrupted = false;
    std::string started;  ///< ISO 8601, UTC

    /// No case ran: nothing was compared, and nothing is known to be the same.
    bool all_skipped() const;
};

/// Called for each case that has ended, one at a time.
using GoldenListener = std::function<void(const GoldenCaseResult&, int done, int all)>;

/// Throws Error(ErrorKind::output) where the work folder or the report cannot be written.
GoldenSuiteResult run_golden_suite(const GoldenSuite& suite, const GoldenRunOptions& options,
                                   const GoldenListener& listener, const std::atomic<bool>& interrupt);

/// Hashes of the looks of the cases, in their order.
std::vector<std::string> look_hashes(const std::vector<const GoldenCase*>& cases,
                                     const GoldenRenderOptions& options);

/// Calls work(i, folder of its own, empty) for 0 .. count - 1 on `jobs` threads, beginning in order. The
/// folders go away. The first exception ends all and is thrown.
void for_each_in_folders(std::size_t count, int jobs,
                         const std::function<void(std::size_t, const std::filesystem::path&)>& work);

/// Whether images of the case could not be fetched; then the result has the reasons.
bool is_unfetched(const GoldenCase& test, const GoldenRunOptions& options, Verdict& verdict,
                  std::vector<std::string>& messages);

/// Calls `work` about one case. What it throws of the kind ErrorKind::capture, such as an approved image that
/// leads out of its folder, is a file error of this case and ends no other.
void with_case_faults(Verdict& verdict, std::vector<std::string>& messages,
                      const std::function<void()>& work);

/// Whether two files have the same layers with the same bits in every value.
bool has_equal_bits(const Comparison& comparison);

/// An image against those approved by its name, the renderer's own first; its pictures are written, unless
/// `pictures` is nullptr.
GoldenImage judge_image(const GoldenCase& test, const RenderedImage& rendered, const GoldenSources& sources,
                        const GoldenEnvironment& environment, ReportPictures* pictures);

}  // namespace aftershade
