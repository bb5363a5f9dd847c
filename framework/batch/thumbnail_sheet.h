// Small copies of a report's pictures in one PNG, a row for each image.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "framework/image/image.h"

namespace aftershade {

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
