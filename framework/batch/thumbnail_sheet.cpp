#include "framework/batch/thumbnail_sheet.h"

#include <algorithm>
#include <optional>

#include "framework/base/error.h"
#include "framework/base/side_file.h"
#include "framework/file/png_file.h"

namespace aftershade {

namespace {

constexpr int kWidthPx = 240, kHeightPx = 180, kGapPx = 4;

/// The mean of the pixels that each pixel of the smaller picture stands for; three channels.
Image shrunk(const Image& image) {
    const double scale =
        std::max({double(image.width()) / kWidthPx, double(image.height()) / kHeightPx, 1.0});
    Image small(std::max(1, int(image.width() / scale)), std::max(1, int(image.height() / scale)), 3);
    for (int y = 0; y < small.height(); ++y)
        for (int x = 0; x < small.width(); ++x) {
            const int left = int(x * scale),
                      right = std::min(std::max(int((x + 1) * scale), left + 1), image.width());
            const int top = int(y * scale),
                      bottom = std::min(std::max(int((y + 1) * scale), top + 1), image.height());
            for (int c = 0; c < 3; ++c) {
                double sum = 0;
                for (int v = top; v < bottom; ++v)
                    for (int u = left; u < right; ++u) sum += image.at(u, v, image.channels() < 3 ? 0 : c);
                small.at(x, y, c) = float(sum / ((right - left) * (bottom - top)));
            }
        }
    return small;
}

/// A report may be a stranger's: no path and no link leads out of it.
std::optional<Image> picture_below(const std::filesystem::path& report, const std::string& name) {
    std::string fault;
    if (name.empty() || !open_file_below(report, name, fault)) return std::nullopt;
    try {
        return shrunk(read_png(report / name));
    } catch (const Error&) {
        return std::nullopt;
    }
}

}  // namespace

bool ThumbnailSheet::add(const std::array<std::string, 3>& pictures) {
    std::array<Image, 3> row;
    bool any = false;
    for (std::size_t i = 0; i < pictures.size(); ++i)
        if (auto picture = picture_below(report_, pictures[i])) {
            row[i] = std::move(*picture);
            any = true;
        }
    if (any) rows_.push_back(std::move(row));
    return any;
}

void ThumbnailSheet::write() const {
    int height = 0;
    const auto height_of = [](const std::array<Image, 3>& row) {
        return std::max({row[0].height(), row[1].height(), row[2].height()}) + kGapPx;
    };
    for (const auto& row : rows_) height += height_of(row);
    Image sheet(3 * kWidthPx + 2 * kGapPx, height, 3);
    int top = 0;
    for (const auto& row : rows_) {
        for (int column = 0; column < 3; ++column) {
            const Image& picture = row[std::size_t(column)];
            for (int y = 0; y < picture.height(); ++y)
                for (int x = 0; x < picture.width(); ++x)
                    for (int c = 0; c < 3; ++c)
                        sheet.at(column * (kWidthPx + kGapPx) + x, top + y, c) = picture.at(x, y, c);
        }
        top += height_of(row);
    }
    write_png(path_below(report_, kName), sheet);
}

}  // namespace aftershade
