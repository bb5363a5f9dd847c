#include "framework/golden/bound_case.h"

#include <optional>
#include <set>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/content_hash.h"
#include "framework/base/data_path.h"
#include "framework/base/text.h"
#include "framework/look/look_content.h"

namespace aftershade {

std::vector<std::filesystem::path> effect_folders(const std::vector<std::string>& effect_paths) {
    std::vector<std::filesystem::path> folders(effect_paths.begin(), effect_paths.end());
    folders.push_back(data_path() / "effects");
    return folders;
}

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

namespace fs = std::filesystem;

LookHasher::LookHasher(const std::vector<fs::path>& effect_folders, fs::path glsl_folder,
                       const std::vector<fs::path>& plugins)
    : effects_(effect_folders, glsl_folder), glsl_folder_(std::move(glsl_folder)) {
    std::set<fs::path> libraries;
    std::error_code unreadable;
    for (const fs::path& folder : plugins)
        for (const auto& entry : fs::directory_iterator(folder, unreadable))
            if (entry.path().extension() == ".so") libraries.insert(entry.path());
    for (const fs::path& library : libraries) plugins_ += file_content(library).hash;
}

std::string LookHasher::hash(const GoldenCase& test) {
    try {
        return fnv1a_hex(text_of(test));
    } catch (const Error&) {
        return "";  // the worker tells it
    }
}

std::string LookHasher::text_of(const GoldenCase& test) {
    const auto [look, pipeline] = bind_case(test, effects_);
    std::string text = test.steps + plugins_;
    // Of a suite or a case only the steps count; its tolerance changes no picture.
    for (std::size_t i = test.look.empty() ? 1 : 0; i < look.files.size(); ++i)
        text += read_text_file(look.files[i], ErrorKind::usage);
    for (const std::string& set : test.sets) text += "\n" + set;
    std::set<std::string> ids;
    for (const LookStep& step : look.steps)
        if (!is_isf_path(step.effect)) ids.insert(step.effect);
    for (const std::string& id : ids) text += effect_text(id);
    for (const PipelineStep& step : pipeline.steps)
        if (is_isf_path(step.manifest->document)) text += content_of_effect(*step.manifest, glsl_folder_);
    for (const PipelineStep& step : pipeline.steps) text += content_of_values(step);
    return text;
}

const std::string& LookHasher::effect_text(const std::string& id) {
    if (const auto known = effect_texts_.find(id); known != effect_texts_.end()) return known->second;
    Diagnostics faults;
    std::string text = content_of_effect(*effects_.find(id, faults), glsl_folder_);
    return effect_texts_[id] = std::move(text);
}

}  // namespace aftershade
