// The verbs of the command. Each adds its options to a subcommand and returns what runs when it is chosen.
#pragma once

#include <functional>

#include "cli/cli11.h"
#include "framework/base/error.h"
#include "framework/batch/process_codes.h"

namespace aftershade::cli {

using Verb = std::function<ExitCode()>;

/// One line a verb, in the order of `aftershade --help`; add_<name> is in cli/<name>.cpp.
#define AFTERSHADE_VERBS(VERB)                                                                       \
    VERB(run, "Run a look over a capture and write the result")                                      \
    VERB(serve, "Open a look over a capture in the browser: sliders, steps and pictures")            \
    VERB(submit, "Write the files of a farm job that runs a look over a capture")                    \
    VERB(merge, "Merge the reports of a farm's tasks into one, and list the frames that failed")     \
    VERB(inspect, "Show a capture's parts, channels, statistics, roles and camera")                  \
    VERB(compare, "Compare two pictures layer by layer, with a verdict for scripts")                 \
    VERB(golden, "Run a suite of golden images: render, compare, approve")                           \
    VERB(render, "Render a scene to captures, with the true pictures that effects approximate")      \
    VERB(list, "List effects and scattering profiles")                                               \
    VERB(describe, "Show an effect's inputs, outputs and parameters, or a scattering profile")       \
    VERB(new, "Create the folder of a new effect that runs as it is")                                \
    VERB(import, "Make the folder of an effect from another program's filter")                       \
    VERB(check, "Check the documents, shaders and values of an effect or a look; exits 1 on faults") \
    VERB(warm, "Compile a look's shaders into the caches, so that the first frame need not wait")    \
    VERB(schema, "Print the JSON Schema of a kind of document, for editors")                         \
    VERB(docs, "Write the pages of effects from their manifests, and the scene reference")           \
    VERB(doctor, "Show which GL backends work on this machine, and why the others do not")           \
    VERB(completion, "Print a completion script for bash, zsh or fish")

#define AFTERSHADE_DECLARE_VERB(name, help) Verb add_##name(CLI::App& app);
AFTERSHADE_VERBS(AFTERSHADE_DECLARE_VERB)
#undef AFTERSHADE_DECLARE_VERB

}  // namespace aftershade::cli
