// Colour tables: .cube files (Adobe Cube LUT Specification 1.0, 2013).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/diagnostics.h"

namespace aftershade {

/// RGB to RGB. Input outside the domain is clamped to it. [value type]
struct Lut {
    int dimensions = 3;  ///< 3: one table over r, g, b; 1: a curve for each channel, in one table
    int size = 0;        ///< samples a side: 2 to 256 of three dimensions, 2 to 65536 of one
    std::array<double, 3> domain_min = {0, 0, 0};  ///< r, g, b of the first sample
    std::array<double, 3> domain_max = {1, 1, 1};  ///< and of the last
    std::string title;
    std::vector<float> values;  ///< size or size^3 triples; of three dimensions, red changes fastest
};

/// Reads the text of a .cube file: both sizes' tables, TITLE, DOMAIN_MIN and DOMAIN_MAX, comments, and the
/// LUT_1D_INPUT_RANGE and LUT_3D_INPUT_RANGE that DaVinci Resolve writes for the domain. nullopt after
/// faults, each at a line of `file`; after 20 of them reading ends. A file with both a 1-D and a 3-D table,
/// which Resolve writes too, is refused.
std::optional<Lut> parse_lut(std::string_view text, const std::string& file, Diagnostics& diagnostics);

/// The same from a regular file of at most 1 GiB.
std::optional<Lut> read_lut(const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace aftershade
