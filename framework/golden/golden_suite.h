// golden.json: which cases there are and where their goldens lie.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/base/input_files.h"
#include "framework/golden/golden_case.h"

namespace aftershade {

struct GoldenSuite {
    std::filesystem::path file;
    std::string argument;  ///< the file or folder as the user named it, for commands
    /// Folders of effects: searched before the shipped ones, and with `cases_of_effects` the place of cases.
    std::vector<std::filesystem::path> effect_paths;
    std::vector<std::filesystem::path> documents;  ///< that were read
    /// That goldens may lie in, also where no case is left: that of the document, those of effects' cases.
    std::vector<std::filesystem::path> golden_folders;
    std::string store;  ///< of the approved images (golden_store.h); "": they are in the tree alone
    std::vector<GoldenCase> cases;  ///< those of the document, then those of effects by name

    /// That the document lies in.
    std::filesystem::path folder() const { return file.has_parent_path() ? file.parent_path() : "."; }
};

/// `argument` is the document, or the folder of a golden.json. Faults of it and of every case go to
/// `diagnostics`; nullopt after any.
std::optional<GoldenSuite> read_golden_suite(const std::string& argument, Diagnostics& diagnostics);

/// Whether a filter fits: its name as a glob (fnmatch's, `*` takes `/` too), or one of its tags as a word.
/// Without filters every case fits.
bool fits_filter(const GoldenCase& test, const std::vector<std::string>& filters);

/// What is wrong with a name, glob or tag that matches no case of the suite, and the nearest name.
std::string no_case_fits(const GoldenSuite& suite, const std::string& filter);

/// Images (and sidecars without one) in the folders of goldens that no case of the suite gives. With filters
/// only those whose names begin with a case that fits. Sorted.
std::vector<std::filesystem::path> orphaned_goldens(const GoldenSuite& suite,
                                                    const std::vector<std::string>& filters);

/// Files that a run of the suite reads: its documents, looks, captures and approved images.
InputFiles suite_inputs(const GoldenSuite& suite, bool with_goldens);

/// JSON Schema of golden.json.
std::string golden_schema();
/// JSON Schema of an effect's case.
std::string effect_case_schema();

}  // namespace aftershade
