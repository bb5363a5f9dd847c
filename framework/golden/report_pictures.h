// The pictures of a report: DIR/images and which of the files there are its own, pixels as text for its page,
// and small copies in one PNG.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/image/image.h"

namespace aftershade {

/// Recognises files by a list of the names that reports have written here, DIR/images/.pictures. A name alone
/// would not do: "shot.0001.reference.exr" may be anybody's; nor would the report.json of an earlier run,
/// which a run that was killed has not written.
class ReportPictures {
public:
    /// Makes the folder. Throws Error(ErrorKind::output) where it cannot be made, or its list cannot be read.
    explicit ReportPictures(std::filesystem::path folder);

    const std::filesystem::path& folder() const { return folder_; }

    /// Where to write the picture of that file name. It is listed before it exists, in case the
    /// process ends. Throws Error(ErrorKind::output). [thread-safe]
    std::filesystem::path add(const std::string& name);

    /// Removes the pictures of earlier runs that this one has not written again; files in no list stay.
    /// Throws Error(ErrorKind::output).
    void remove_old();

private:
    std::filesystem::path folder_;
    std::mutex mutex_;
    std::set<std::string> old_;  // of runs before this one
    std::set<std::string> own_;
};

/// RFC 4648 section 4, padded.
std::string base64(std::span<const std::byte> bytes);

struct PagePixels {
    std::string_view type;  ///< "half" where every value is one, else "float"; "uint"
    std::string text;
};

/// Every value of the image, exact: base64 of a zlib stream (RFC 1950) of planes. A plane has one byte of one
/// channel of every pixel, row by row, as its difference from the byte before (modulo 256, the first from 0);
/// planes are ordered by channel, then from the least significant byte. NaN keeps no payload as a half.
PagePixels page_pixels(const Image& image);

/// [value type]
class ThumbnailSheet {
public:
    static constexpr const char* kName = "thumbnails.png";

    explicit ThumbnailSheet(std::filesystem::path report) : report_(std::move(report)) {}

    /// Pictures (.png) below the report, "" for none. False where none can be read: then there is no row.
    bool add(const std::array<std::string, 3>& pictures);
    std::size_t rows() const { return rows_.size(); }
    /// Writes the report's kName. Throws Error(ErrorKind::output).
    void write() const;

private:
    std::filesystem::path report_;
    std::vector<std::array<Image, 3>> rows_;
};

}  // namespace aftershade
