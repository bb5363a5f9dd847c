// Areas of a picture that a comparison leaves out, or holds to limits of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/compare/compare_levels.h"
#include "framework/compare/pixel_areas.h"
#include "framework/file/exr_file.h"
#include "framework/image/image.h"

namespace aftershade {

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
