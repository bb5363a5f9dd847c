#include "framework/pipeline/schema.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/verbs.h"
#include "framework/batch/golden_suite.h"
#include "framework/scattering/scattering_schema.h"
#include "framework/scene/scene_schema.h"

namespace aftershade::cli {

namespace {

struct SchemaOptions {
    std::string document = "look";
    std::vector<std::string> effect_paths;
};

std::string schema_of(const SchemaOptions& options) {
    if (options.document == "capture") return capture_schema();
    if (options.document == "effect") return effect_schema();
    if (options.document == "module") return module_schema();
    if (options.document == "golden") return golden_schema();
    if (options.document == "scene") return scene::scene_schema();
    if (options.document == "scattering_profile") return schema::scattering_profile_file().dump(2) + "\n";
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(options.effect_paths, diagnostics);
    std::vector<const EffectManifest*> manifests;
    for (const std::string& id : effects.ids())
        if (const EffectManifest* manifest = effects.find(id, diagnostics)) manifests.push_back(manifest);
    stop_at_errors(diagnostics);
    return look_schema(manifests);
}

}  // namespace

Verb add_schema(CLI::App& app) {
    auto options = std::make_shared<SchemaOptions>();
    app.add_option("document", options->document,
                   "look, capture, effect, module, scene, scattering_profile or golden")
        ->check(
            CLI::IsMember({"look", "capture", "effect", "module", "scene", "scattering_profile", "golden"}))
        ->capture_default_str();
    add_effect_path_option(app, options->effect_paths);
    return [options] {
        const std::string text = schema_of(*options);
        std::fwrite(text.data(), 1, text.size(), stdout);
        return ExitCode::done;
    };
}

}  // namespace aftershade::cli
