// Two picture files, layer by layer, and the verdict.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/compare/compare_area.h"
#include "framework/compare/difference_rules.h"
#include "framework/compare/flip.h"
#include "framework/compare/layer.h"
#include "framework/compare/layer_file.h"
#include "framework/compare/pixel_differences.h"
#include "framework/image/color_encoding.h"

namespace aftershade {

/// idiff's exit codes; a worse one is larger.
enum class Verdict { same = 0, warning = 1, failure = 2, different_size = 3, file_error = 4 };
/// "same", "warning", "failure", "different size or channels", "file error".
std::string_view verdict_name(Verdict verdict);

/// Which FLIP is computed of the layers with colours. `automatic`: LDR of encoded colours, HDR of light.
enum class FlipChoice { automatic, ldr, hdr, both, none };

/// The levels are those of every layer that has none of its own.
struct CompareRules : Levels {
    std::map<std::string, Levels> layers;  ///< by LayerInfo::label()
    std::vector<CompareArea> areas;        ///< at most PixelAreas::kMost
    Forgive forgive;
    bool nan_equal = false;
    /// Where data windows differ in one display window: outside of its own, a file has +inf of depth and 0 of
    /// all else, as docs/conventions.md says; both windows are compared. Else that is a different size.
    bool fill_outside = false;
    FlipChoice flip_choice = FlipChoice::automatic;
    FlipOptions flip;
    bool ssim = true;       ///< SSIM and MS-SSIM of the layers with colours
    bool ssim_map = false;  ///< ... with LayerComparison::ssim_map
    /// By LayerInfo::label(); nullopt: the layer is not looked at.
    std::map<std::string, std::optional<LayerRole>> roles;
    ReadLimits limits;
    int threads = 0;  ///< 0: as many as there are cores; changes no figure

    const Levels& levels_of(const std::string& label) const;
    DifferenceRules difference_rules(const std::string& label) const;
};

struct LayerComparison {
    std::string label;
    LayerRole role = LayerRole::data;
    std::vector<std::string> channels;  ///< compared; LargestDifference::channel counts in these
    StoredPrecision stored;             ///< the coarser of both files'
    Window window;  ///< compared: what both data windows cover, or either; places add its corner
    std::uint64_t absent_in_reference = 0, absent_in_test = 0;  ///< pixels that only the other image has
    PixelDifferences differences;
    std::vector<std::string> areas;  ///< names of those of PixelDifferences::by_area but its first
    std::optional<FlipResult> ldr_flip, hdr_flip;
    std::optional<double> ssim, ms_ssim;  ///< mean over R, G and B; see ssim.h
    Image ssim_map;                       ///< of each pixel's window; 1 everywhere for equal bits
    Verdict verdict = Verdict::same;
    std::vector<std::string> reasons;  ///< of the verdict: what was exceeded, by how much
    /// Layers and areas without a limit, where any difference passes: "Z", "Z in the area mask hair.png".
    std::vector<std::string> not_judged;

    double failing_percent() const;   ///< of the pixels that are not left out
    double left_out_percent() const;  ///< of all pixels of the window
};

struct Comparison {
    std::filesystem::path reference, test;
    Verdict verdict = Verdict::same;
    /// Reasons why the files cannot be compared: layers, channels and windows of one file alone, or a file
    /// that cannot be read.
    std::vector<std::string> faults;
    /// Content that is not compared, or whose equal numbers mean another picture: smaller levels of tiles,
    /// other primaries, another pixel aspect. The verdict is then at least a warning.
    std::vector<std::string> warnings;
    std::vector<std::string> notes;       ///< how files were read; no verdict
    std::vector<LayerComparison> layers;  ///< in the reference's order; without FLIP's error images and maps
    std::vector<std::string> ignored;     ///< labels of layers that CompareRules::roles leaves out
    std::vector<std::string> unknown_roles;   ///< labels in CompareRules::roles that neither file has
    std::vector<std::string> unknown_layers;  ///< likewise in CompareRules::layers
    std::vector<std::string> labels;          ///< of every layer of either file

    /// Layers that the verdict does not depend on: `ignored`, and LayerComparison::not_judged of every layer.
    std::vector<std::string> not_judged() const;
};

/// The two images of a layer over LayerComparison::window, kept for pictures of the differences.
struct LayerImages {
    Image reference, test;
    PixelAreas areas = {};
    /// The primaries of each image, where the layer is `color`.
    Chromaticities reference_primaries = kRec709, test_primaries = kRec709;
    /// The encoding of each image, where the layer is `display`.
    ColorEncoding reference_display = kSrgbDisplay, test_display = kSrgbDisplay;
};

/// Called after each layer; the images may be moved from.
using LayerVisitor = std::function<void(const LayerComparison&, LayerImages&)>;

/// Both files, every layer. Layers are matched by part, name and kind; parts by name, or where each file has
/// one part. A file that cannot be read is Verdict::file_error with the message in `faults`, and no
/// exception. Throws what `visit` throws. [thread-safe; files are read on the calling thread]
Comparison compare_files(const std::filesystem::path& reference, const std::filesystem::path& test,
                         const CompareRules& rules, const LayerVisitor& visit = {});

/// One layer of which both images cover `layer.window`, already read: figures, verdict and reasons.
/// `comparison` brings label, role, channels and window, `images.areas` what CompareRules::areas give there.
/// With every pixel left out nothing is measured, and the verdict stays.
void compare_layer(const LayerImages& images, const CompareRules& rules, LayerComparison& comparison);

}  // namespace aftershade
