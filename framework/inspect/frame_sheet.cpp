#include "framework/inspect/frame_sheet.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "framework/image/label_text.h"
#include "framework/inspect/footprint.h"

namespace aftershade {

namespace {

constexpr int kGap_px = 8;
constexpr int kHeadHeight_px = 2 * kTextLineHeight_px + kGap_px;
constexpr int kFewFrames = 100;
constexpr int kThumbnailSide_px = 240;
constexpr double kSheetAspect = 1.6;

constexpr DisplayColor kSheetPaper = {0.11f, 0.11f, 0.12f};
constexpr DisplayColor kMissingCell = {0.2f, 0.2f, 0.21f};
constexpr DisplayColor kLettering = {1, 1, 1};

/// The mean of a thumbnail pixel's footprint, over black.
DisplayColor mean_over_black(const Image& display, const Footprint& columns, const Footprint& rows) {
    std::array<double, 3> sum{};
    for (int y = rows.first; y < rows.last; ++y)
        for (int x = columns.first; x < columns.last; ++x) {
            const float alpha = display.channels() == 4 ? std::clamp(display.at(x, y, 3), 0.0f, 1.0f) : 1.0f;
            for (int c = 0; c < 3; ++c)
                sum[std::size_t(c)] += double(std::clamp(display.at(x, y, c), 0.0f, 1.0f) * alpha);
        }
    const double count = double(columns.last - columns.first) * (rows.last - rows.first);
    return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

}  // namespace

FrameSheet::FrameSheet(const std::string& title, int frames, int columns, int width, int height) {
    assert(frames > 0 && frames <= kMostSheetFrames && width > 0 && height > 0);
    const int side_px = frames > kFewFrames ? kThumbnailSide_px / 2 : kThumbnailSide_px;
    const double scale = double(side_px) / std::max(width, height);
    tile_width_px_ = std::max(1, int(std::lround(width * scale)));
    tile_height_px_ = std::max(1, int(std::lround(height * scale)));
    text_scale_ = frames > kFewFrames ? 1 : 2;
    const double cell_width = tile_width_px_ + kGap_px;
    const double cell_height = tile_height_px_ + text_scale_ * kTextLineHeight_px + kGap_px;
    const int best = int(std::lround(std::sqrt(frames * kSheetAspect * cell_height / cell_width)));
    columns_ = std::clamp(columns > 0 ? columns : best, 1, frames);
    const int rows = (frames + columns_ - 1) / columns_;
    sheet_ = Image(cell_x(columns_ - 1) + tile_width_px_ + kGap_px,
                   cell_y((rows - 1) * columns_) + int(cell_height), 3);
    fill_rectangle(sheet_, 0, 0, sheet_.width(), sheet_.height(), kSheetPaper);
    draw_text(sheet_, kGap_px, kGap_px, title, 2, sheet_.width() - 2 * kGap_px, kLettering);
}

int FrameSheet::cell_x(int index) const {
    return kGap_px + index % columns_ * (tile_width_px_ + kGap_px);
}

int FrameSheet::cell_y(int index) const {
    const int cell_height_px = tile_height_px_ + text_scale_ * kTextLineHeight_px + kGap_px;
    return kGap_px + kHeadHeight_px + index / columns_ * cell_height_px;
}

void FrameSheet::write_label(const std::string& text) {
    draw_text(sheet_, cell_x(added_), cell_y(added_) + tile_height_px_ + 4, text, text_scale_, tile_width_px_,
              kLettering);
}

void FrameSheet::add(int frame, const Image& display) {
    assert(display.channels() >= 3 && !display.empty());
    // A frame of another shape than the first is fitted into its cell.
    const double scale =
        std::min(double(tile_width_px_) / display.width(), double(tile_height_px_) / display.height());
    const int width = std::clamp(int(std::lround(display.width() * scale)), 1, tile_width_px_);
    const int height = std::clamp(int(std::lround(display.height() * scale)), 1, tile_height_px_);
    const int left = cell_x(added_) + (tile_width_px_ - width) / 2;
    const int top = cell_y(added_) + (tile_height_px_ - height) / 2;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            fill_rectangle(sheet_, left + x, top + y, 1, 1,
                           mean_over_black(display, Footprint(x, width, display.width()),
                                           Footprint(y, height, display.height())));
    write_label(std::to_string(frame));
    ++added_;
}

void FrameSheet::add_missing(int frame, const std::string& why) {
    fill_rectangle(sheet_, cell_x(added_), cell_y(added_), tile_width_px_, tile_height_px_, kMissingCell);
    write_label(std::to_string(frame) + ": " + why);
    ++added_;
}

}  // namespace aftershade
