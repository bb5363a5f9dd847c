// Every role of a capture on one picture, for people.
#pragma once

#include <map>
#include <string>

#include "framework/capture/capture.h"

namespace aftershade {

constexpr int kTileSide_px = 480;      ///< no tile is wider or higher
constexpr int kMinCellWidth_px = 320;  ///< for the label, where the tile is narrower

/// A display-referred RGB picture: a title, a labelled tile for each of the capture's images in false colour,
/// and what the colours of faulty pixels mean. A faulty pixel shows however small its tile is. `unreadable`
/// says, by role, why there is a message instead of a picture. Larger images are reduced to a tile, smaller
/// ones enlarged by a whole factor; the pixel aspect is kept. The capture must have an image or an unreadable
/// role.
Image draw_contact_sheet(const Capture& capture, const std::map<std::string, std::string>& unreadable = {});

/// Where draw_contact_sheet puts things.
struct ContactSheetLayout {
    int columns = 0, rows = 0;
    int tile_width_px = 0, tile_height_px = 0;
    int width_px = 0, height_px = 0;
    int tile_x(int tile) const;  ///< left edge of the tiles in reading order, px
    int tile_y(int tile) const;  ///< top edge, px
};
ContactSheetLayout contact_sheet_layout(const CaptureHeader& header, int tiles);

}  // namespace aftershade
