// The frames of a sequence as thumbnails on one picture, for people.
#pragma once

#include <string>

#include "framework/image/image.h"

namespace aftershade {

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
