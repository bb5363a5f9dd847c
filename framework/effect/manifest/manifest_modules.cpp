// What a manifest takes from modules: glsl/<name>/module.json.
#include <algorithm>
#include <utility>

#include "framework/base/data_path.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/effect/manifest/manifest_groups.h"
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kModuleFile = "module.json";

std::vector<std::string> module_names(const fs::path& glsl_folder) {
    std::vector<std::string> names;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(glsl_folder, failure))
        if (fs::is_regular_file(entry.path() / kModuleFile, failure))
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

void ManifestParser::modules(const Reader& document, const fs::path& glsl_folder) {
    const Node* names = document.find("modules");
    if (!names || names->items.empty()) return;
    const fs::path folder = glsl_folder.empty() ? data_path() / "glsl" : glsl_folder;
    for (const Node& item : names->items)
        if (item.is_string()) module(item, folder);
}

void ManifestParser::module(const Node& item, const fs::path& glsl_folder) {
    const std::vector<std::string> known = module_names(glsl_folder);
    if (std::find(known.begin(), known.end(), item.string) == known.end()) {
        fault(item.place, "no module '" + item.string + "' in " + glsl_folder.string() +
                              did_you_mean(item.string, known));
        lacks_modules_ = true;
        return;
    }
    const auto same = [&](const Module& other) { return other.spec.name == item.string; };
    if (std::any_of(modules_.begin(), modules_.end(), same)) return;
    const fs::path folder = glsl_folder / item.string;
    auto document = read_document(folder / kModuleFile, diagnostics_);
    const int errors_before = diagnostics_.error_count();
    if (document) document = without_groups(std::move(*document), diagnostics_);
    if (!document || diagnostics_.error_count() > errors_before) {
        lacks_modules_ = true;
        return;
    }
    modules_.push_back({{item.string, "", folder}, std::move(*document)});
    Module& module = modules_.back();
    grammar::check(module.document, module_block(), diagnostics_);
    const Reader reader(module.document, module_block());
    module.spec.summary = reader.text("summary");
    if (const Node* before = reader.find("before"))
        for (const Node& other : before->items) {
            if (!other.is_string()) continue;
            if (!fs::is_regular_file(glsl_folder / other.string / kModuleFile))
                fault(other.place, "no module '" + other.string + "' in " + glsl_folder.string());
            module.spec.before.push_back(other.string);
        }
    const Node* name = module.document.find("module");
    if (name && name->is_string() && name->string != module.spec.name)
        fault(name->place,
              "the module '" + name->string + "' is not the name of its folder, '" + module.spec.name + "'");
    manifest_.modules.push_back(module.spec);
}

void ManifestParser::declarations(const Reader& effect, SectionReader section_reader) {
    for (const Module& module : modules_) {
        reading_ = &module;
        (this->*section_reader)(Reader(module.document, module_block()));
    }
    reading_ = nullptr;
    (this->*section_reader)(effect);
}

bool ManifestParser::is_new(const std::string& thing, const Member& member) {
    const std::string name = thing + " '" + member.key + "'";
    const Declaration declaration{reading_ ? "the module '" + reading_->spec.name + "'" : "the effect",
                                  member.key_place};
    const auto [known, is_new] = declared_.emplace(name, declaration);
    // In one document a second key is a fault of its syntax.
    if (!is_new)
        fault(member.key_place, name + " is declared already by " + known->second.owner + " (" +
                                    to_string(known->second.place) + ")");
    return is_new;
}

}  // namespace aftershade
