// The limits of a layer, and areas of a picture that a comparison leaves out or gives limits of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/compare/difference_rules.h"
#include "framework/compare/pixel_differences.h"
#include "framework/file/exr_file.h"
#include "framework/image/image.h"

namespace aftershade {

/// A level is exceeded where more than `percent` of a layer's pixels, and more than `allowed` pixels, differ
/// by more than `limit`; or more than `allowed` by more than `hard`. Both are always tested (idiff
/// does not test -hardfail and -warn if no pixel exceeds -fail).
struct Tolerance {
    double limit = 1e-6;  ///< of a pixel's difference; see DifferenceRules
    double percent = 0;   ///< of the pixels
    double hard = std::numeric_limits<double>::infinity();
    std::uint64_t allowed = 0;  ///< pixels
    /// A difference above `limit` counts where it is also more than this part of its magnitude; see
    /// DifferenceRules. `hard` does not ask it.
    double relative = 0;
    double ulp = 0;  ///< units in the last place by which pixels may differ; see DifferenceRules
};

struct Levels {
    Tolerance fail;
    /// nullopt: as `fail`, but with percent 0, so that what only `percent` lets pass is a warning, as
    /// idiff's.
    std::optional<Tolerance> warn;
    std::optional<double> fail_flip, warn_flip;  ///< exceeded by the mean of a layer's FLIP, LDR or HDR
    std::optional<double> fail_ssim, warn_ssim;  ///< exceeded where a layer's SSIM is below

    Tolerance warn_tolerance() const;
    /// Whether some difference of a layer of this role and number of pixels exceeds a level of fail or warn;
    /// NaN against a number exceeds any level. FLIP and SSIM count if the layer has them.
    bool judge(LayerRole role, std::uint64_t pixels, bool has_flip, bool has_ssim) const;
    /// The limits of a pixel alone.
    DifferenceRules difference_limits() const;
};

/// Some pixels of a picture. [value type]
struct AreaShape {
    /// In px of the files where `display` is a file's own window, else from the display window's upper left
    /// pixel.
    Window window;
    std::vector<std::uint8_t> inside;  ///< for each pixel of the window; empty: all of them
    /// The display window of what the shape was read from, which must be that of the pictures; of a PNG,
    /// which has none, only the size counts. nullopt: a rectangle.
    std::optional<Window> display;
    bool from_corner = true;  ///< the window is from the display window's upper left pixel
    std::string note{};       ///< on how its file was read; "" where there is nothing to say
};

/// Most of a rectangle's width and height, and of x and y either way.
inline constexpr int kMaxAreaSide_px = 1 << 20;
/// At least 1 px in each direction; x and y from the display window's upper left pixel.
AreaShape rectangle_area(int x, int y, int width, int height);
/// Where `coverage`, of one channel, is above `limit`, over `window` in px of a file of that display window.
AreaShape covered_area(const Image& coverage, float limit, const Window& window, const Window& display);
/// The pixels of a picture file whose value is above a half: of an OpenEXR file in `channel` (its only one
/// where that is ""), of a PNG in any colour channel. Throws Error(ErrorKind::capture), which begins with the
/// path, where the file cannot be read, or has no such channel.
AreaShape mask_area(const std::filesystem::path& path, const std::string& channel, const ReadLimits& limits);

struct CompareArea {
    std::string name;  ///< for people: "10,20,64,32", "mask hair.png", "objects 'Wheel'"
    AreaShape shape;
    std::optional<Levels> levels;  ///< nullopt: left out
};

/// The reason why an area cannot be found in a picture of that display window; "" if it can.
std::string fault_of(const CompareArea& area, const Window& display);

/// The areas over `window`, in px of files of that display window. Ignoring takes precedence;
/// among areas with limits the first counts. `layer` has the rules that areas share with their layer.
PixelAreas pixel_areas(const std::vector<CompareArea>& areas, const Window& window, const Window& display,
                       const DifferenceRules& layer);

}  // namespace aftershade
