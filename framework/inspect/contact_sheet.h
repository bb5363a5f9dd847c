// A frame's parts, or the frames of a sequence, as thumbnails on one picture, for people.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

#include "framework/capture/capture.h"
#include "framework/image/image.h"

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

/// Along one side: `first` up to, not including, `last`.
struct Footprint {
    int first = 0, last = 0;
    Footprint(int at, int tile_px, int image_px)
        : first(int(std::int64_t(at) * image_px / tile_px)),
          last(std::max(int(std::int64_t(at + 1) * image_px / tile_px), first + 1)) {}
    int middle() const { return (first + last) / 2; }
    int step() const { return std::max(1, (last - first) / 4); }  // of 4 x 4 samples, the eye needs no more
};

constexpr int kMostSheetFrames = 1000;

/// Holds the sheet alone, not the frames. [value type]
class FrameSheet {
public:
    /// For 1 to kMostSheetFrames frames, the first of which has this size. `columns` 0: as many as make the
    /// sheet about 8:5. Thumbnails are at most 240 px a side, above 100 frames 120 px.
    FrameSheet(const std::string& title, int frames, int columns, int width, int height);

    /// The next frame: display-referred values of 3 or 4 channels, shown over black.
    void add(int frame, const Image& display);
    /// The next frame is not there, or cannot be read.
    void add_missing(int frame, const std::string& why);

    const Image& picture() const { return sheet_; }
    /// Left and top edge of a thumbnail's cell, px.
    int cell_x(int index) const;
    int cell_y(int index) const;
    int tile_width_px() const { return tile_width_px_; }
    int tile_height_px() const { return tile_height_px_; }

private:
    void write_label(const std::string& text);

    int columns_ = 1;
    int tile_width_px_ = 0, tile_height_px_ = 0;
    int text_scale_ = 2;
    int added_ = 0;
    Image sheet_;
};

}  // namespace aftershade
