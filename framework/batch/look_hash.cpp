#include "framework/batch/look_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <span>
#include <sstream>

#include "framework/core/text.h"
#include "framework/pipeline/look.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

std::string read_bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A shader file and all that it includes, each once.
void gather_shader(const fs::path& file, const fs::path& glsl_folder, std::set<fs::path>& files) {
    if (!files.insert(file.lexically_normal()).second) return;
    static const std::regex include(R"(^\s*#\s*include\s*([<"])([^">]*)[>"])");
    std::istringstream lines(read_bytes(file));
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, include) || match[2] == "pass") continue;
        gather_shader((match[1] == "<" ? glsl_folder : file.parent_path()) / match[2].str(), glsl_folder,
                      files);
    }
}

std::set<fs::path> files_of(const EffectManifest& manifest, const fs::path& glsl_folder) {
    std::set<fs::path> files{manifest.folder / "effect.json"};
    for (const ModuleSpec& part : manifest.modules) files.insert(part.folder / "module.json");
    for (const PassSpec& pass : manifest.passes)
        for (const std::string& shader : {pass.shader, pass.vertex})
            if (!shader.empty()) gather_shader(pass.folder / shader, glsl_folder, files);
    if (manifest.native)
        for (const auto& entry : fs::directory_iterator(manifest.folder))
            if (entry.path().extension() == ".cpp" && !entry.path().stem().string().ends_with("_test"))
                files.insert(entry.path());
    return files;
}

}  // namespace

LookHasher::LookHasher(std::vector<fs::path> effect_folders, fs::path glsl_folder)
    : effects_(std::move(effect_folders), glsl_folder), glsl_folder_(std::move(glsl_folder)) {}

std::string LookHasher::hash(const GoldenCase& test) {
    Diagnostics faults;  // are the worker's to tell
    std::optional<Look> look;
    if (!test.look.empty()) {
        look = read_look(test.look, faults);
    } else if (auto node = parse_document(test.steps, test.file.string(), faults)) {
        node->place.file = (test.folder / test.file.filename()).string();
        look = parse_look(*node, faults);
    }
    if (!look || faults.has_errors()) return "";
    std::string text = test.steps;
    // Of a suite or a case only the steps count; its tolerance changes no picture.
    for (std::size_t i = test.look.empty() ? 1 : 0; i < look->files.size(); ++i)
        text += read_bytes(look->files[i]);
    for (const std::string& set : test.sets) text += "\n" + set;
    std::set<std::string> ids;
    for (const LookStep& step : look->steps) ids.insert(step.effect);
    for (const std::string& id : ids)
        if (!add_effect(id, text)) return "";
    return fmt::format("{:016x}", fnv1a(std::as_bytes(std::span(text))));
}

bool LookHasher::add_effect(const std::string& id, std::string& text) {
    const auto [known, is_new] = effect_texts_.emplace(id, "");
    if (is_new) {
        Diagnostics faults;
        const EffectManifest* manifest = effects_.contains(id) ? effects_.find(id, faults) : nullptr;
        if (manifest)
            for (const fs::path& file : files_of(*manifest, glsl_folder_)) add_file(file, known->second);
    }
    text += known->second;
    return !known->second.empty();
}

/// The name too, but not where it lies: another checkout gives the same hash.
void LookHasher::add_file(const fs::path& file, std::string& text) {
    text += "\n" + file.filename().string() + "\n" + read_bytes(file);
}

}  // namespace aftershade
