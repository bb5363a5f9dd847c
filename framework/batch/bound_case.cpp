#include "framework/batch/bound_case.h"

#include <optional>
#include <utility>

#include "framework/base/data_path.h"

namespace aftershade {

std::vector<std::filesystem::path> effect_folders(const std::vector<std::string>& effect_paths) {
    std::vector<std::filesystem::path> folders(effect_paths.begin(), effect_paths.end());
    folders.push_back(data_path() / "effects");
    return folders;
}

BoundCase bind_case(const GoldenCase& test, EffectRegistry& effects) {
    Diagnostics faults;
    std::optional<Look> look;
    if (!test.look.empty()) {
        look = read_look(test.look, faults);
    } else if (auto node = parse_document(test.steps, test.file.string(), faults)) {
        node->place.file = (test.folder / test.file.filename()).string();
        look = parse_look(*node, faults);
    }
    if (look) {
        PipelineOptions options;
        options.sets = test.sets;
        Pipeline pipeline = bind_pipeline(*look, effects, options, faults);
        if (!faults.has_errors()) return {std::move(*look), std::move(pipeline)};
    }
    throw Error(ErrorKind::usage, "the look has faults");
}

}  // namespace aftershade
