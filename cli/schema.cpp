#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/documents.h"
#include "cli/effect_options.h"
#include "cli/verbs.h"

namespace aftershade::cli {

namespace {

struct SchemaOptions {
    std::string document = "look";
    std::vector<std::string> effect_paths;
};

ExitCode print_schema(const SchemaOptions& options) {
    const auto& all = documents();
    const auto document = std::find_if(all.begin(), all.end(),
                                       [&](const Document& one) { return one.name == options.document; });
    const std::string text = document->schema(options.effect_paths);
    std::fwrite(text.data(), 1, text.size(), stdout);
    return ExitCode::done;
}

}  // namespace

Verb add_schema(CLI::App& app) {
    auto options = std::make_shared<SchemaOptions>();
    std::string names;
    for (const std::string& name : document_names()) names += (names.empty() ? "" : ", ") + name;
    app.add_option("document", options->document, names)
        ->check(CLI::IsMember(document_names()))
        ->capture_default_str();
    add_effect_path_option(app, options->effect_paths);
    return [options] { return print_schema(*options); };
}

}  // namespace aftershade::cli
