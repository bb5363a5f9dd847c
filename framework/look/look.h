// The user's JSON: ordered steps, no paths of captures or outputs inside.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/document/param.h"
#include "framework/effect/isf/isf_types.h"

namespace aftershade {

/// "in": {"depth": "capture.depth"}: where one input comes from.
struct WiringSpec {
    std::string input;
    std::string source;  ///< "capture", or the name of an earlier step
    std::string output;  ///< a role of the capture, or an output or a texture of that step
    Place place;
};

/// "mask": where a step works. One of role, objects and file is set.
struct MaskSpec {
    std::string role;  ///< of the capture, with one channel: "mask", "aov:hair"
    std::vector<TableKey>
        objects;                 ///< ids, ranges of ids, or names; needs the role object_id or a Cryptomatte
    std::filesystem::path file;  ///< picture over the display window; its first channel, as stored
    bool invert = false;
    Place place;

    /// Whether some of the objects are named, and not numbered.
    bool names_objects() const {
        return std::any_of(objects.begin(), objects.end(),
                           [](const TableKey& key) { return !key.name.empty(); });
    }
};

struct LookStep {
    std::string name;               ///< the effect's id unless the look says otherwise
    std::string effect;             ///< an id, or the path of an ISF file, from `folder`
    std::optional<IsfSpace> space;  ///< of an ISF file
    bool enabled = true;
    std::optional<std::string> preset;
    std::vector<Member> params;  ///< values are read against the effect's manifest; variables are put in
    std::vector<WiringSpec> wiring;
    std::optional<Node> mix;  ///< 0: the image as it was before the step, 1: as the step made it
    std::optional<MaskSpec> mask;
    std::filesystem::path folder;  ///< of the look that the step stands in: its files are named from there
    Place place;                   ///< of the step
    Place effect_place;
    Place space_place;
    Place preset_place;
};

struct Look {
    std::string file;
    std::vector<LookStep> steps;               ///< those of looks that it uses, too
    std::vector<std::filesystem::path> files;  ///< the look and every look that it uses
};

/// Bounds of a look with all looks that it uses, so that a small document cannot grow into one that fills the
/// memory.
inline constexpr std::size_t kMaxLookDepth = 32;  ///< looks in a chain of "use"
inline constexpr std::size_t kMaxLookUses = 256;  ///< "use" in all, each as often as its look is used
inline constexpr std::size_t kMaxLookSteps = 1000;
inline constexpr std::size_t kMaxLookVariables = 1000;      ///< of each look
inline constexpr std::size_t kMaxVariableValues = 100'000;  ///< of JSON, that variables put in

/// Values by name, above a look's own "vars".
using LookVariables = std::map<std::string, Node>;

/// A value of the command line: JSON where it reads as JSON, else a bare word. All of it stands at `place`.
Node parse_command_value(const std::string& text, const Place& place);

/// What a step without a `name` is called: its effect's id, or the name of an ISF file in snake_case.
std::string default_step_name(const std::string& effect);

/// Reads the form of the document and of every look that it uses ({"use": "lens.json"}); whether effects
/// exist and values fit is bind_pipeline's to say.
std::optional<Look> read_look(const std::filesystem::path& path, Diagnostics& diagnostics,
                              const LookVariables& variables = {});
/// The same for a document in memory; looks that it uses lie beside node.place.file.
std::optional<Look> parse_look(const Node& node, Diagnostics& diagnostics,
                               const LookVariables& variables = {});

}  // namespace aftershade
