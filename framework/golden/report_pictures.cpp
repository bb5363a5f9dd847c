#include "framework/golden/report_pictures.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Imath/half.h>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/side_file.h"
#include "framework/file/png_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kList = ".pictures";

/// Whoever changed the list, nothing outside the folder is removed.
bool is_plain_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && fs::path(name).filename() == name;
}

}  // namespace

ReportPictures::ReportPictures(fs::path folder) : folder_(std::move(folder)) {
    make_folder_below(folder_.parent_path(), folder_.filename());
    constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 28;
    std::string fault;
    std::istringstream lines(read_file_below(folder_, kList, kMostBytes, fault));
    if (!fault.empty() && fault != kNoSuchFile)
        throw Error(ErrorKind::output, (folder_ / kList).string() + ": " + fault);
    for (std::string name; std::getline(lines, name);)
        if (is_plain_name(name)) old_.insert(name);
}

fs::path ReportPictures::add(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    if (own_.insert(name).second && !old_.contains(name)) {
        const std::string line = name + "\n";
        std::string fault;
        const auto list = open_file_below(folder_, kList, fault, FileUse::append);
        if (list && write(list->descriptor(), line.data(), line.size()) != ssize_t(line.size()))
            fault = "cannot be written";
        if (!fault.empty()) throw Error(ErrorKind::output, (folder_ / kList).string() + ": " + fault);
    }
    return path_below(folder_, name);
}

void ReportPictures::remove_old() {
    const std::scoped_lock lock(mutex_);
    std::string names;
    for (const std::string& name : own_) names += name + "\n";
    for (const std::string& name : old_) {
        std::error_code failure;
        const fs::path file = folder_ / name;
        if (own_.contains(name) || !fs::is_regular_file(fs::symlink_status(file, failure))) continue;
        fs::remove(file, failure);
        if (failure)
            throw Error(ErrorKind::output, file.string() + ": cannot be removed: " + failure.message());
    }
    write_text_file(path_below(folder_, kList), names);
    old_.clear();
}

namespace {

bool is_half(float value) {
    return std::isnan(value) || float(Imath::half(value)) == value;
}

/// Planes as page_pixels() says, of `bytes` bytes each value.
template <class BitsAt>
std::vector<Bytef> planes_of(const Image& image, int bytes, BitsAt bits_at) {
    const std::size_t channels = std::size_t(image.channels());
    const std::size_t pixels = std::size_t(image.width()) * std::size_t(image.height());
    std::vector<Bytef> planes;
    planes.reserve(pixels * channels * std::size_t(bytes));
    for (std::size_t channel = 0; channel < channels; ++channel)
        for (int shift = 0; shift < 8 * bytes; shift += 8) {
            std::uint32_t before = 0;
            for (std::size_t i = 0; i < pixels; ++i) {
                const std::uint32_t byte = bits_at(i * channels + channel) >> shift & 255u;
                planes.push_back(Bytef(byte - before));
                before = byte;
            }
        }
    return planes;
}

std::string deflated(const std::vector<Bytef>& bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    std::vector<std::byte> stream(size);
    // It fails only where memory runs out.
    if (compress2(reinterpret_cast<Bytef*>(stream.data()), &size, bytes.data(), uLong(bytes.size()),
                  Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::runtime_error("zlib has no memory left");
    stream.resize(size);
    return base64(stream);
}

}  // namespace

// No library that this project uses has it in its public headers.
std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < count; ++k)
            group |= std::to_integer<std::uint32_t>(bytes[i + k]) << (16 - 8 * k);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

PagePixels page_pixels(const Image& image) {
    if (image.type() == ComponentType::uint32)
        return {"uint", deflated(planes_of(image, 4, [&](std::size_t i) { return image.uints()[i]; }))};
    const auto values = image.floats();
    if (std::ranges::all_of(values, is_half))
        return {"half", deflated(planes_of(image, 2, [&](std::size_t i) {
                    return std::uint32_t(Imath::half(values[i]).bits());
                }))};
    return {"float", deflated(planes_of(
                         image, 4, [&](std::size_t i) { return std::bit_cast<std::uint32_t>(values[i]); }))};
}

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
