#include "framework/batch/bound_case.h"

#include <optional>
#include <utility>

namespace aftershade {

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
