// The verbs of the command. Each adds its options to a subcommand and returns what runs when it is chosen.
#pragma once

#include <functional>

#include "framework/core/error.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

using Verb = std::function<ExitCode()>;

/// One line a verb, in the order of `aftershade --help`; add_<name> is in cli/<name>.cpp.
#define AFTERSHADE_VERBS(VERB)                                                                               \
    VERB(run, "Run a look over a capture and write the result")                                              \
    VERB(submit, "Write the files of a farm's job that runs a look over a capture; says how to submit them") \
    VERB(merge, "Merge the reports of a farm's tasks into one, and list the frames that failed")             \
    VERB(inspect, "Show what a capture holds: parts, channels with their figures, roles, camera")            \
    VERB(compare, "Compare two pictures, layer by layer: how different, how visible, a verdict for scripts") \
    VERB(golden, "Render a suite of cases and compare them with approved images; approve new ones")          \
    VERB(render, "Render a scene: captures, and the true pictures that effects approximate")                 \
    VERB(list, "List effects and scattering profiles")                                                       \
    VERB(describe, "Show an effect's inputs, outputs and parameters, or a scattering profile")               \
    VERB(new, "Make the folder of a new effect, which runs at once")                                         \
    VERB(check, "Check an effect or a look: documents, shaders, values; exit 1: no")                         \
    VERB(schema, "Print the JSON Schema of looks, captures, effects, scenes or profiles, for editors")       \
    VERB(docs, "Write the page of each effect from its manifest, and the scene reference")                   \
    VERB(doctor, "Show which GL backends work on this machine, and why others do not")                       \
    VERB(completion, "Print a script that completes this command in bash, zsh or fish")

#define AFTERSHADE_DECLARE_VERB(name, help) Verb add_##name(CLI::App& app);
AFTERSHADE_VERBS(AFTERSHADE_DECLARE_VERB)
#undef AFTERSHADE_DECLARE_VERB

}  // namespace aftershade::cli
