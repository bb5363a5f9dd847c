#include "framework/batch/look_hash.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "framework/core/atomic_file.h"
#include "framework/core/param_type.h"
#include "framework/core/text.h"
#include "framework/effect/shader_source.h"
#include "framework/pipeline/pipeline.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// The name too, but not where it lies: another checkout gives the same hash.
void add_file(const fs::path& file, std::string& text) {
    text += "\n" + file.filename().string() + "\n" + read_text_file(file, ExitCode::usage);
}

/// What the files hold that the step's parameters and its mask name.
void add_values(const PipelineStep& step, std::string& text) {
    for (const ParamSpec& spec : step.manifest->params)
        for (const ParamValue& value : step.known_values(spec)) {
            if (spec.type->content) text += spec.type->content(value);
            if (is_file_type(spec.type) && !std::get<std::string>(value).empty())
                add_file(std::get<std::string>(value), text);
        }
    if (step.mask && !step.mask->file.empty()) add_file(step.mask->file, text);
}

/// The code of a native effect, without its tests.
bool is_native_source(const fs::path& file) {
    const std::string extension = file.extension().string();
    return (extension == ".c" || extension == ".cpp" || extension == ".h") &&
           !file.stem().string().ends_with("_test");
}

/// A shader file and all that it includes, each once.
void gather_shader(const fs::path& file, const fs::path& glsl_folder, std::set<fs::path>& files) {
    if (!files.insert(file.lexically_normal()).second) return;
    std::istringstream lines(read_text_file(file, ExitCode::usage));
    for (std::string line; std::getline(lines, line);) {
        const auto include = parse_include(line);
        if (!include || include->name == "pass" || include->name == "predicate") continue;
        gather_shader((include->is_shared ? glsl_folder : file.parent_path()) / include->name, glsl_folder,
                      files);
    }
}

std::set<fs::path> files_of(const EffectManifest& manifest, const fs::path& glsl_folder) {
    std::set<fs::path> files{manifest.folder / "effect.json"};
    for (const ModuleSpec& part : manifest.modules) files.insert(part.folder / "module.json");
    for (const PassSpec& pass : manifest.passes) {
        for (const std::string& shader : {pass.shader, pass.vertex})
            if (!shader.empty()) gather_shader(pass.folder / shader, glsl_folder, files);
        if (!pass.lists.empty())
            gather_shader(shader_path(pass, ShaderFile::main, glsl_folder), glsl_folder, files);
        if (!pass.over.empty())
            gather_shader(shader_path(pass, ShaderFile::vertex, glsl_folder), glsl_folder, files);
    }
    if (manifest.native)
        for (const auto& entry : fs::directory_iterator(manifest.folder))
            if (is_native_source(entry.path())) files.insert(entry.path());
    return files;
}

[[noreturn]] void refuse() {
    throw Error(ExitCode::usage, "the look has faults");
}

}  // namespace

LookHasher::LookHasher(std::vector<fs::path> effect_folders, fs::path glsl_folder)
    : effects_(std::move(effect_folders), glsl_folder), glsl_folder_(std::move(glsl_folder)) {}

std::string LookHasher::hash(const GoldenCase& test) {
    try {
        return fnv1a_hex(text_of(test));
    } catch (const Error&) {
        return "";  // the worker tells it
    }
}

std::string LookHasher::text_of(const GoldenCase& test) {
    Diagnostics faults;
    std::optional<Look> look;
    if (!test.look.empty()) {
        look = read_look(test.look, faults);
    } else if (auto node = parse_document(test.steps, test.file.string(), faults)) {
        node->place.file = (test.folder / test.file.filename()).string();
        look = parse_look(*node, faults);
    }
    if (!look) refuse();
    PipelineOptions options;
    options.sets = test.sets;
    const Pipeline pipeline = bind_pipeline(*look, effects_, options, faults);
    if (faults.has_errors()) refuse();
    std::string text = test.steps;
    // Of a suite or a case only the steps count; its tolerance changes no picture.
    for (std::size_t i = test.look.empty() ? 1 : 0; i < look->files.size(); ++i)
        text += read_text_file(look->files[i], ExitCode::usage);
    for (const std::string& set : test.sets) text += "\n" + set;
    std::set<std::string> ids;
    for (const LookStep& step : look->steps) ids.insert(step.effect);
    for (const std::string& id : ids) text += effect_text(id);
    for (const PipelineStep& step : pipeline.steps) add_values(step, text);
    return text;
}

const std::string& LookHasher::effect_text(const std::string& id) {
    if (const auto known = effect_texts_.find(id); known != effect_texts_.end()) return known->second;
    Diagnostics faults;
    std::string text;
    for (const fs::path& file : files_of(*effects_.find(id, faults), glsl_folder_)) add_file(file, text);
    return effect_texts_[id] = std::move(text);
}

}  // namespace aftershade
