// Pictures of a comparison: differences as data, FLIP as a heat map, everything side by side.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "framework/compare/compare_files.h"
#include "framework/image/label_text.h"

namespace aftershade {

struct DifferenceOptions {
    bool absolute = false;
    double scale = 1;
};

/// matplotlib's magma, from black over red to pale yellow, t in 0..1.
DisplayColor magma_color(float t);

/// (reference - test) * scale per channel, as floats, as idiff writes it; 0 where bits or infinities are
/// equal, NaN where NaN is subtracted. Of ids 1 (times scale) where they differ.
Image difference_image(const Image& reference, const Image& test, LayerRole role,
                       const DifferenceOptions& options);

/// A row of three pictures, reference, test and difference, in one scale of colours, with what they show.
/// Pixels that are left out are blue in the difference.
struct SideBySideRow {
    std::array<Image, 3> pictures;  ///< three display channels, at most kSideBySideWidth_px wide
    std::array<std::string, 3> captions;
    std::array<std::string, 2> title;
    Verdict verdict = Verdict::same;
};
inline constexpr int kSideBySideWidth_px = 640;
SideBySideRow side_by_side_row(const LayerComparison& layer, const LayerImages& images);
/// All rows below each other under a title.
Image draw_side_by_side(const std::vector<SideBySideRow>& rows, const std::string& title);

/// Keeps what the pictures asked for need while compare_files goes through the layers (its LayerVisitor), and
/// writes them. Files appear by rename; a failure is Error(ErrorKind::output). [one thread at a time]
class ComparisonPictures {
public:
    ComparisonPictures(const DifferenceOptions& options, bool difference, bool heat_map, bool side_by_side)
        : options_(options), difference_(difference), heat_map_(heat_map), side_by_side_(side_by_side) {}

    void add(const LayerComparison& layer, const LayerImages& images);

    /// .exr: every channel under its name (after its part's, "part.channel") over the union of the windows
    /// compared, 0 outside and where pixels are left out. .png: the first layer with colours, else the first,
    /// as |difference| * scale.
    void write_difference(const std::filesystem::path& path) const;
    /// .png: magma of the first layer that has FLIP. .exr: "flip" or "<layer>.flip" of each layer. HDR-FLIP
    /// where there are both.
    void write_heat_map(const std::filesystem::path& path) const;
    void write_side_by_side(const std::filesystem::path& path, const std::string& title) const;

private:
    struct Plane {
        std::vector<std::string> channels;  ///< names in the EXR file
        Image image;
        Window window;
        bool colors = false;
    };
    static void write_planes(const std::filesystem::path& path, const std::vector<Plane>& planes);

    DifferenceOptions options_;
    bool difference_, heat_map_, side_by_side_;
    std::vector<Plane> differences_, flips_;
    std::vector<SideBySideRow> rows_;
};

}  // namespace aftershade
