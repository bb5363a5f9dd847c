// What a manifest takes from modules: glsl/<name>/module.json.
#include <algorithm>
#include <utility>

#include "framework/core/data_path.h"
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

namespace fs = std::filesystem;
using Presence = ObjectReader::Presence;

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

void ManifestParser::modules(const Node& section, const fs::path& glsl_folder) {
    if (section.items.empty()) return;
    const fs::path folder = glsl_folder.empty() ? data_path() / "glsl" : glsl_folder;
    for (const Node& item : section.items) module(item, folder);
}

void ManifestParser::module(const Node& item, const fs::path& glsl_folder) {
    if (!item.is_string()) {
        fault(item.place, "'modules' holds names, not " + std::string(kind_name(item.kind)));
        return;
    }
    const std::vector<std::string> known = module_names(glsl_folder);
    if (std::find(known.begin(), known.end(), item.string) == known.end()) {
        fault(item.place, "no module '" + item.string + "' in " + glsl_folder.string() +
                              did_you_mean(item.string, known));
        lacks_modules_ = true;
        return;
    }
    const auto same = [&](const Module& other) { return other.spec.name == item.string; };
    if (std::any_of(modules_.begin(), modules_.end(), same)) {
        fault(item.place, "the module '" + item.string + "' is named twice");
        return;
    }
    const fs::path folder = glsl_folder / item.string;
    auto document = read_document(folder / kModuleFile, diagnostics_);
    if (!document) {
        lacks_modules_ = true;
        return;
    }
    modules_.push_back({{item.string, "", folder}, std::move(*document), {}});
    modules_.back().sections = module_sections(modules_.back());
    manifest_.modules.push_back(modules_.back().spec);
}

std::map<std::string, const Node*> ManifestParser::module_sections(Module& module) {
    const Node& document = module.document;
    ObjectReader reader(document, "the module", diagnostics_);
    if (!reader.is_object()) return {};
    check_document_version(reader, document, diagnostics_);
    reader.text("$schema");
    const auto name = reader.text("module", Presence::required);
    if (name && *name != module.spec.name)
        fault(document.find("module")->place,
              "the module '" + *name + "' is not the name of its folder, '" + module.spec.name + "'");
    if (name) identifier(*name, document.find("module")->place, "the module");
    module.spec.summary = reader.text("summary", Presence::required).value_or("");
    std::map<std::string, const Node*> sections;
    for (const char* key : {"params", "textures", "buffers", "tiles"}) sections[key] = reader.object(key);
    for (const char* key : {"uses", "passes"}) sections[key] = reader.array(key);
    reader.finish();
    return sections;
}

void ManifestParser::declarations(const std::string& key, const Node* own, SectionReader section_reader) {
    for (const Module& module : modules_) {
        const auto section = module.sections.find(key);
        if (section == module.sections.end() || !section->second) continue;
        reading_ = &module;
        (this->*section_reader)(*section->second);
    }
    reading_ = nullptr;
    if (own) (this->*section_reader)(*own);
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
