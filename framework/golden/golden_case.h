// Cases of golden suites: a look over a capture, and the images that it must give.
//
// They stand in a golden.json (golden_suite.h) or, for an effect, in effects/<id>/cases/<case>.json with the
// images beside them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/compare/compare_area.h"
#include "framework/compare/compare_files.h"
#include "framework/document/document.h"
#include "framework/document/object_keys.h"

namespace aftershade::grammar {
class Reader;
}

namespace aftershade {

/// Pixels of a case's images that are left out or have limits of their own.
struct GoldenArea {
    std::optional<AreaShape> rectangle;
    std::filesystem::path mask;     ///< of a mask, with its
    std::string channel;            ///< "" for the file's only one
    std::vector<TableKey> objects;  ///< of the case's capture
    std::optional<Levels> levels;   ///< nullopt: left out
};

/// Today, UTC: "2027-01-31".
std::string day_of_today();

/// Until when a failure is a warning.
struct Quarantine {
    std::string until;  ///< the last day, "2027-01-31", UTC; "": there is none
    std::string reason;
};

struct GoldenCase {
    std::string name;               ///< unique in its suite: "vignette", of an effect "bloom/lamps"
    std::string stem;               ///< what its goldens' file names begin with: "lamps"
    std::filesystem::path file;     ///< of the document that declares it
    std::filesystem::path goldens;  ///< folder of its images
    std::filesystem::path look;     ///< a file; empty: `steps`
    std::string steps;              ///< a look as text
    std::filesystem::path folder;   ///< that files named by `steps` lie in
    std::filesystem::path capture;  ///< what `run` takes: capture.json, EXR file, pattern or folder
    std::string frames;             ///< a range; "": those of the capture
    std::vector<std::string> sets;  ///< "step.param=value", above the look's own
    std::vector<std::string> taps;  ///< "step.texture", each an image like an output
    std::vector<std::string> outputs{"color"};  ///< roles
    CompareRules rules;                         ///< the tolerance but for its areas
    std::vector<GoldenArea> areas;
    std::vector<std::string> tags;
    std::string skip;  ///< why it is not run; "" where it is
    Quarantine quarantine;
    bool optional = false;  ///< skipped, not failed, where its capture is absent

    /// "lamps.color", of a tap "lamps.bloom.bright": what FramePattern adds ".0001.exr" to.
    std::vector<std::string> image_stems() const;
    /// The whole tolerance of a frame. Reads masks and objects: throws Error(ErrorKind::capture).
    CompareRules rules_of(int frame) const;
};

/// "lamps.color" and 1: "lamps.color.0001".
std::string golden_image_name(const std::string& image_stem, int frame);

/// Keys of compare's flags: fail, fail_relative, fail_percent, hard_fail, allow_failures, fail_flip,
/// fail_ssim; the same with `warn`; nan_equal, forgive_shift, forgive_blur, layers. Without any `warn` key
/// only a failing image is reported.
CompareRules parse_golden_tolerance(const Node& node, Diagnostics& diagnostics);

/// A tolerance that has been checked, without its areas.
CompareRules read_golden_tolerance(const grammar::Reader& reader, Diagnostics& diagnostics);
/// Its areas. Masks lie relative to `folder`.
std::vector<GoldenArea> read_golden_areas(const grammar::Reader& tolerance,
                                          const std::filesystem::path& folder, Diagnostics& diagnostics);

/// The keys that cases in golden.json and cases of effects share; the document has been checked. Paths are
/// relative to `folder`.
void read_golden_case(const grammar::Reader& reader, const std::filesystem::path& folder, GoldenCase& result,
                      Diagnostics& diagnostics);

/// effects/<id>/cases/<case>.json; nullopt after faults. `root` is what the capture's path is relative to:
/// the folder that `effects` lies in.
std::optional<GoldenCase> parse_effect_case(const Node& node, const std::filesystem::path& file,
                                            const std::filesystem::path& root, Diagnostics& diagnostics);

/// The cases of one effect's folder, sorted by name.
std::vector<GoldenCase> read_effect_cases(const std::filesystem::path& effect_folder,
                                          const std::filesystem::path& root, Diagnostics& diagnostics);

/// A node as JSON. Places are lost.
std::string json_of_node(const Node& node);

}  // namespace aftershade
