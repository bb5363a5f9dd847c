#include "framework/inspect/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/image/false_color.h"
#include "framework/image/label_text.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr int kMargin_px = 16;
constexpr int kTextScale = 2;  // stb_easy_font's letters are 7 px high
constexpr int kLine_px = kTextLineHeight_px * kTextScale;
constexpr int kTitleHeight_px = 2 * kLine_px + kMargin_px;
constexpr int kLabelHeight_px = 4 * kLine_px + kMargin_px;  // role, two lines of range and unit, faults
constexpr int kFooterHeight_px = kLine_px + kMargin_px;
constexpr int kWheelSide_px = 3 * kLine_px - 8;

constexpr DisplayColor kPaper = {0.11f, 0.11f, 0.12f};
constexpr DisplayColor kBlank = {0.2f, 0.2f, 0.21f};
constexpr DisplayColor kBright = {1, 1, 1};
constexpr DisplayColor kQuiet = {0.72f, 0.72f, 0.74f};

PixelFault worst_fault(const FalseColor& picture, const Footprint& columns, const Footprint& rows) {
    PixelFault worst = PixelFault::none;
    for (int y = rows.first; y < rows.last; ++y)
        for (int x = columns.first; x < columns.last; ++x) worst = std::max(worst, picture.fault(x, y));
    return worst;
}

DisplayColor reduced(const FalseColor& picture, const Footprint& columns, const Footprint& rows) {
    if (const PixelFault fault = worst_fault(picture, columns, rows); fault != PixelFault::none)
        return pixel_fault_color(fault);
    if (!picture.is_blendable()) return picture.color(columns.middle(), rows.middle());
    DisplayColor sum{};
    int samples = 0;
    for (int y = rows.first; y < rows.last; y += rows.step())
        for (int x = columns.first; x < columns.last; x += columns.step()) {
            const DisplayColor color = picture.color(x, y);
            for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c];
            ++samples;
        }
    for (float& component : sum) component /= float(samples);
    return sum;
}

void draw_wheel(Image& sheet, int left, int top) {
    const float radius = float(kWheelSide_px) / 2;
    for (int y = 0; y < kWheelSide_px; ++y)
        for (int x = 0; x < kWheelSide_px; ++x) {
            const float dx = (float(x) + 0.5f) / radius - 1, dy = (float(y) + 0.5f) / radius - 1;
            if (std::hypot(dx, dy) <= 1) fill_rectangle(sheet, left + x, top + y, 1, 1, wheel_color(dx, dy));
        }
}

void draw_ramp(Image& sheet, int right, int top) {
    constexpr int kRampWidth_px = 100;
    for (int x = 0; x < kRampWidth_px; ++x)
        fill_rectangle(sheet, right - kRampWidth_px + x, top, 1, kLine_px - 8,
                       ramp_color(1 - float(x) / kRampWidth_px));
    const int words_width_px = text_width_px("near far") * kTextScale;
    draw_text(sheet, right - words_width_px, top + kLine_px, "near far", kTextScale, words_width_px, kQuiet);
}

/// Draws tiles and their labels one after the other.
class SheetPainter {
public:
    SheetPainter(Image& sheet, const ContactSheetLayout& layout)
        : sheet_(sheet), layout_(layout), cell_width_px_(std::max(layout.tile_width_px, kMinCellWidth_px)) {}

    void add_picture(const std::string& role, const Image& image, const FalseColor& picture) {
        for_tile_pixels(image, [&](int x, int y, const Footprint& columns, const Footprint& rows) {
            fill_rectangle(sheet_, x, y, 1, 1, reduced(picture, columns, rows));
        });
        // One bad pixel can spoil a frame; alone in a tile it would escape the eye.
        for (const PixelFault fault : {PixelFault::infinite, PixelFault::nan})
            if (picture.fault_count(fault) > 0)
                for_tile_pixels(image, [&](int x, int y, const Footprint& columns, const Footprint& rows) {
                    if (worst_fault(picture, columns, rows) == fault)
                        fill_rectangle(sheet_, x - 1, y - 1, 3, 3, pixel_fault_color(fault));
                });
        int legend_width_px = 0;
        if (picture.legend() != Legend::none) legend_width_px = 110;
        const int legend_top = top() + layout_.tile_height_px + 6;
        if (picture.legend() == Legend::ramp) draw_ramp(sheet_, left() + cell_width_px_, legend_top);
        if (picture.legend() == Legend::wheel)
            draw_wheel(sheet_, left() + cell_width_px_ - kWheelSide_px, legend_top);
        write(0, role, kBright, legend_width_px);
        for (int line = 0; line < 2; ++line)
            write(line + 1, picture.label()[std::size_t(line)], kQuiet, legend_width_px);
        write_faults(picture);
        ++tile_;
    }

    void add_message(const std::string& role, const std::string& message) {
        fill_rectangle(sheet_, left(), top(), layout_.tile_width_px, layout_.tile_height_px, kBlank);
        write(0, role, kBright, 0);
        write(1, "cannot be shown:", pixel_fault_color(PixelFault::infinite), 0);
        // Two lines of it, broken at a word where there is one.
        std::size_t cut = message.size();
        while (cut > 0 && text_width_px(message.substr(0, cut)) * kTextScale > cell_width_px_) --cut;
        if (const std::size_t space = message.rfind(' ', cut);
            cut < message.size() && space != std::string::npos)
            cut = space;
        write(2, message.substr(0, cut), kQuiet, 0);
        write(3, message.substr(std::min(message.size(), cut + 1)), kQuiet, 0);
        ++tile_;
    }

    /// That any picture has.
    const std::set<PixelFault>& faults() const { return faults_; }

private:
    int left() const { return layout_.tile_x(tile_); }
    int top() const { return layout_.tile_y(tile_); }

    template <class Visit>
    void for_tile_pixels(const Image& image, Visit visit) const {
        for (int y = 0; y < layout_.tile_height_px; ++y)
            for (int x = 0; x < layout_.tile_width_px; ++x)
                visit(left() + x, top() + y, Footprint(x, layout_.tile_width_px, image.width()),
                      Footprint(y, layout_.tile_height_px, image.height()));
    }

    void write(int line, const std::string& text, DisplayColor color, int legend_width_px) {
        draw_text(sheet_, left(), top() + layout_.tile_height_px + 8 + line * kLine_px, text, kTextScale,
                  cell_width_px_ - legend_width_px, color);
    }

    void write_faults(const FalseColor& picture) {
        int x = left();
        for (const PixelFault fault : kPixelFaults) {
            if (picture.fault_count(fault) == 0) continue;
            faults_.insert(fault);
            const std::string text =
                fmt::format("{} {}  ", picture.fault_count(fault), pixel_fault_name(fault));
            draw_text(sheet_, x, top() + layout_.tile_height_px + 8 + 3 * kLine_px, text, kTextScale,
                      left() + cell_width_px_ - x, pixel_fault_color(fault));
            x += text_width_px(text) * kTextScale;
        }
    }

    Image& sheet_;
    const ContactSheetLayout& layout_;
    int cell_width_px_ = 0;
    int tile_ = 0;
    std::set<PixelFault> faults_;
};

void draw_title(Image& sheet, const CaptureHeader& header) {
    const int width_px = sheet.width() - 2 * kMargin_px;
    const Window& window = header.data_window;
    const std::string view = header.view.empty() ? "" : "  view " + header.view;
    const std::string file = fmt::format("{}{}  {} x {} px", header.path.filename().string(), view,
                                         window.width(), window.height());
    draw_text(sheet, kMargin_px, kMargin_px, file, kTextScale, width_px, kBright);
    const std::string profile = fmt::format("profile {} ({})", header.profile, header.profile_reason);
    draw_text(sheet, kMargin_px, kMargin_px + kLine_px, profile, kTextScale, width_px, kQuiet);
}

/// What marks mean that are on the sheet; a mark that is not would only be taken for a colour that happens to
/// be like it.
void draw_footer(Image& sheet, const std::set<PixelFault>& faults, bool has_depth) {
    int x = kMargin_px;
    const int y = sheet.height() - kFooterHeight_px;
    const auto add = [&](std::string_view text, DisplayColor color) {
        constexpr int kSwatch_px = kLine_px - 8;
        fill_rectangle(sheet, x, y, kSwatch_px, kSwatch_px, color);
        if (color != kPaper) x += kSwatch_px + 8;
        draw_text(sheet, x, y + 1, text, kTextScale, sheet.width() - x, kQuiet);
        x += text_width_px(text) * kTextScale + kMargin_px;
    };
    if (faults.empty()) add("no NaN, no Inf, nothing negative where it must not be", kPaper);
    for (const PixelFault fault : faults) add(pixel_fault_name(fault), pixel_fault_color(fault));
    if (has_depth) add("nothing hit", kNothingHitColor);
}

/// Of as few empty cells and as near to 5:4 as may be: wider sheets are shown with smaller letters.
int chosen_columns(int tiles, int cell_width_px, int cell_height_px) {
    int best = 1;
    double least = 0;
    for (int columns = 1; columns <= tiles; ++columns) {
        const int rows = (tiles + columns - 1) / columns;
        const double aspect = double(columns) * cell_width_px / (double(rows) * cell_height_px);
        const double flaw = std::abs(std::log(aspect / 1.25)) + double(columns * rows - tiles) / tiles;
        if (columns == 1 || flaw < least) best = columns, least = flaw;
    }
    return best;
}

/// In the order of the documentation, what is passed through at the end.
std::vector<std::string> ordered_roles(const Capture& capture,
                                       const std::map<std::string, std::string>& unreadable) {
    std::vector<std::string> roles;
    const auto add = [&](const std::string& role) {
        const bool known = capture.images.contains(role) || unreadable.contains(role);
        if (known && std::find(roles.begin(), roles.end(), role) == roles.end()) roles.push_back(role);
    };
    for (const std::string& role : role_names()) add(role);
    for (const auto& [role, image] : capture.images) add(role.name());
    for (const auto& [role, message] : unreadable) add(role);
    return roles;
}

}  // namespace

int ContactSheetLayout::tile_x(int tile) const {
    return kMargin_px + tile % columns * (std::max(tile_width_px, kMinCellWidth_px) + kMargin_px);
}

int ContactSheetLayout::tile_y(int tile) const {
    return kMargin_px + kTitleHeight_px + tile / columns * (tile_height_px + kLabelHeight_px);
}

ContactSheetLayout contact_sheet_layout(const CaptureHeader& header, int tiles) {
    assert(tiles > 0);
    const double aspect =
        header.pixel_aspect > 0.01f && header.pixel_aspect < 100 ? double(header.pixel_aspect) : 1;
    const double width = header.data_window.width() * std::max(aspect, 1.0);
    const double height = header.data_window.height() / std::min(aspect, 1.0);
    double scale = kTileSide_px / std::max(width, height);
    if (scale > 1) scale = std::floor(scale);
    ContactSheetLayout layout;
    layout.tile_width_px = std::clamp(int(std::lround(width * scale)), 1, kTileSide_px);
    layout.tile_height_px = std::clamp(int(std::lround(height * scale)), 1, kTileSide_px);

    layout.columns = chosen_columns(tiles, std::max(layout.tile_width_px, kMinCellWidth_px) + kMargin_px,
                                    layout.tile_height_px + kLabelHeight_px);
    layout.rows = (tiles + layout.columns - 1) / layout.columns;
    layout.width_px =
        layout.tile_x(layout.columns - 1) + std::max(layout.tile_width_px, kMinCellWidth_px) + kMargin_px;
    layout.height_px = layout.tile_y(tiles - 1) + layout.tile_height_px + kLabelHeight_px + kFooterHeight_px;
    return layout;
}

Image draw_contact_sheet(const Capture& capture, const std::map<std::string, std::string>& unreadable) {
    const std::vector<std::string> roles = ordered_roles(capture, unreadable);
    const ContactSheetLayout layout = contact_sheet_layout(capture.header, int(roles.size()));
    Image sheet(layout.width_px, layout.height_px, 3);
    fill_rectangle(sheet, 0, 0, layout.width_px, layout.height_px, kPaper);
    draw_title(sheet, capture.header);
    SheetPainter painter(sheet, layout);
    for (const std::string& role : roles) {
        if (unreadable.contains(role)) {
            painter.add_message(role, unreadable.at(role));
            continue;
        }
        const Image& image = capture.images.at(role);
        try {
            painter.add_picture(role, image, FalseColor(role, image, capture.header.primaries));
        } catch (const Error& error) {  // primaries that span no space
            painter.add_message(role, error.what());
        }
    }
    const bool has_depth = std::any_of(roles.begin(), roles.end(), [&](const std::string& role) {
        return capture.images.contains(role) && kind_of_role(role) == RoleKind::distance;
    });
    draw_footer(sheet, painter.faults(), has_depth);
    return sheet;
}

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
