// A look of the command line, bound to its effects.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "cli/run_arguments.h"
#include "framework/base/diagnostics.h"
#include "framework/effect/registry.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"

namespace aftershade::cli {

/// The look and its effects as they are on disk now; a pipeline refers to the effects.
struct BoundLook {
    explicit BoundLook(EffectRegistry found) : effects(std::move(found)) {}
    EffectRegistry effects;
    std::optional<Look> look;
    Pipeline pipeline;
};

/// Reads the documents as they are now. After a fault the look or the pipeline is empty.
std::unique_ptr<BoundLook> bind_look(const RunArguments& options, Diagnostics& diagnostics);

}  // namespace aftershade::cli
