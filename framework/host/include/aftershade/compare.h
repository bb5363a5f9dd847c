// How far two pictures are apart: what `aftershade compare` computes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aftershade/export.h"
#include "aftershade/image.h"

namespace aftershade::host {

/// A worse verdict is larger.
enum class Verdict { same, warning, failure, different_size, file_error };
/// "same", "warning", "failure", "different size or channels", "file error". Never fails.
AFTERSHADE_API const char* verdict_name(Verdict verdict) noexcept;

/// Exceeded where more than `percent` of a layer's pixels, and more than `allowed` pixels, differ by more
/// than `limit`; or more than `allowed` by more than `hard`.
struct Tolerance {
    double limit = 1e-6;                                    ///< of a pixel's difference; at least 0
    double percent = 0;                                     ///< of the pixels; from 0 to 100
    double hard = std::numeric_limits<double>::infinity();  ///< at least 0
    std::uint64_t allowed = 0;                              ///< pixels
    /// At least 0: a difference above `limit` counts where it is also more than this part of its value.
    double relative = 0;
    /// At least 0: a difference counts, also for `hard`, where it is more than this many units in the last
    /// place of the coarser file's type; images in memory are floats.
    double ulp = 0;
};

/// `automatic`: LDR of encoded colours, HDR of light.
enum class FlipChoice { automatic, ldr, hdr, both, none };
enum class ToneMapper { aces, reinhard, hable };

struct CompareOptions {
    Tolerance fail{};                                ///< Verdict::failure where exceeded
    std::optional<Tolerance> warn{};                 ///< Verdict::warning; empty: as `fail` with percent 0
    std::optional<double> fail_flip{}, warn_flip{};  ///< exceeded by a layer's mean FLIP; from 0 to 1
    std::optional<double> fail_ssim{}, warn_ssim{};  ///< exceeded where a layer's SSIM is below; from 0 to 1
    bool nan_equal = false;                          ///< NaN equals NaN; else a pixel with one fails
    /// Data windows may differ: outside its own, a file has infinite depth and 0 of all else. Files only.
    bool fill_outside = false;
    FlipChoice flip = FlipChoice::automatic;
    double pixels_per_degree = 67.020643;       ///< of visual angle, for FLIP; from 1 to 1000
    ToneMapper tone_mapper = ToneMapper::aces;  ///< of HDR-FLIP
    std::optional<double> start_exposure{},
        stop_exposure{};             ///< of HDR-FLIP, stops, from -100 to 100, in order
    std::optional<int> exposures{};  ///< of HDR-FLIP; from 1 to 1000
    bool ssim = true;                ///< compute SSIM and MS-SSIM
    bool maps = false;               ///< fill LayerFigures::flip_map and ssim_map
    /// How layers are compared, by their label ("RGB", "Z", "diffuse.RGB"): color, display, alpha, depth,
    /// velocity, id, data, or ignore. A label that neither file has is Error(usage).
    std::vector<std::pair<std::string, std::string>> roles{};
    int threads = 0;  ///< upper limit, from 0 to 1024; 0: as many as there are cores; changes no figure
};

/// The layer's largest difference; places are pixels of the files' data windows.
struct LargestDifference {
    double value = 0;  ///< absolute; +infinity where the values cannot be subtracted
    int x = 0, y = 0;
    std::string channel;
    double reference = 0, test = 0;
};

/// One layer: channels of one name.
struct LayerFigures {
    std::string label;  ///< "RGB", "Z", "diffuse.RGB"; of arrays the role
    std::string role;   ///< that it was compared by
    std::vector<std::string> channels;
    Window window;                           ///< that was compared
    std::uint64_t pixels = 0;                ///< in it
    std::uint64_t failing = 0, warning = 0;  ///< pixels above the tolerance's limit
    bool bits_equal = false;                 ///< every stored value has the same bits
    double mean_absolute = 0;                ///< over the values that are finite in both
    double rmse = 0;
    double psnr_db = 0;     ///< +infinity for equal images; docs/compare.md says of which peak
    double mean_pixel = 0;  ///< mean difference of a pixel by its role; depth: relative; velocity: px
    LargestDifference largest;
    std::optional<double> ldr_flip, hdr_flip;  ///< means, from 0 to 1; empty: not computed
    std::optional<double> ssim, ms_ssim;       ///< empty: not computed
    Verdict verdict = Verdict::same;
    std::vector<std::string> reasons;  ///< of the verdict, in whole sentences
    bool is_judged = true;             ///< false: no limit holds this layer, so that any difference passes
    Image flip_map;  ///< one channel, from 0 to 1: HDR-FLIP where there are both; empty without `maps`
    /// One channel, from -1 to 1, of the window around each pixel; NaN where the window does not lie inside;
    /// 1 everywhere for equal bits. Empty without `maps`, and where SSIM is not computed.
    Image ssim_map;
};

struct Comparison {
    Verdict verdict = Verdict::same;
    /// Reasons why the files cannot be compared: layers, channels and windows of one file alone, or a file
    /// that cannot be read.
    std::vector<std::string> faults;
    /// Content that is not compared, or whose equal numbers mean another picture: at least a warning.
    std::vector<std::string> warnings;
    std::vector<std::string> notes;    ///< on how the files were read
    std::vector<LayerFigures> layers;  ///< in the reference's order
    std::vector<std::string> labels;   ///< of every layer of either file
    /// Labels of layers that the verdict does not depend on: layers without a limit, and ignored layers.
    std::vector<std::string> not_judged;
};

/// Compares two files (.exr, .png, .hdr) layer by layer. A file that cannot be read is Verdict::file_error
/// and no exception. Throws Error(usage) naming every option outside its range. [thread-safe]
AFTERSHADE_API Comparison compare(const std::filesystem::path& reference, const std::filesystem::path& test,
                                  const CompareOptions& options = {});

/// Compares two images of one size, type and channel count as a layer of this role: color, display, alpha,
/// depth, velocity, id or data. The alpha of color and display is a layer "A" of its own. Otherwise as above;
/// CompareOptions::roles must be empty. [thread-safe]
AFTERSHADE_API Comparison compare(const Image& reference, const Image& test,
                                  const std::string& role = "color", const CompareOptions& options = {});
/// The same of the caller's arrays.
AFTERSHADE_API Comparison compare(const ArrayView& reference, const ArrayView& test,
                                  const std::string& role = "color", const CompareOptions& options = {});

}  // namespace aftershade::host
