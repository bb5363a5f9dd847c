// Parts of pictures that `compare` leaves out or holds to limits of their own: --ignore, --area, --layer.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/compare/compare_files.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

struct CompareAreaOptions {
    std::vector<std::string> ignored;  ///< WHERE
    std::vector<std::string> areas;    ///< WHERE=LIMIT
    std::vector<std::string> layers;   ///< LAYER=LIMIT
    std::string objects_from;          ///< a capture; "": the reference
};

void add_compare_area_options(CLI::App& app, CompareAreaOptions& options);

/// The files that these words name: masks and the capture of the objects.
std::vector<std::filesystem::path> compare_area_inputs(const CompareAreaOptions& options);

/// Reads masks and objects. Faults of words go to `diagnostics`; a file that cannot be read is
/// Error(ErrorKind::capture).
void read_compare_areas(const CompareAreaOptions& options, const std::string& reference, CompareRules& rules,
                        Diagnostics& diagnostics);

}  // namespace aftershade::cli
