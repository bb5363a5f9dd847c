#include "framework/look/look_content.h"

#include <exception>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/document/param_type.h"
#include "framework/effect/shader_source.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// The name too, but not where it lies: another checkout gives the same hash.
void add_file(const fs::path& file, std::string& text) {
    constexpr std::uintmax_t kMaxBytes = 1u << 30;  // of a table of colours, the largest of them
    text += "\n" + file.filename().string() + "\n" + read_text_file(file, ErrorKind::usage, kMaxBytes);
}

/// The code of a native effect, without its tests.
bool is_native_source(const fs::path& file) {
    const std::string extension = file.extension().string();
    return (extension == ".c" || extension == ".cpp" || extension == ".h") &&
           !file.stem().string().ends_with("_test");
}

/// A shader file and all that it includes, each once.
void gather_shader(const EffectManifest& manifest, const fs::path& file, const fs::path& glsl_folder,
                   std::set<fs::path>& files, int depth = 0) {
    const std::string* generated = manifest.find_generated(file);
    std::error_code failure;
    const bool is_file = !generated || fs::is_regular_file(file, failure);
    if (depth >= kMaxIncludeDepth || (is_file && !files.insert(file.lexically_normal()).second && !generated))
        return;
    std::string fault;
    std::istringstream lines(generated ? *generated : read_regular_file(file, kMaxShaderFileBytes, fault));
    if (!fault.empty()) throw Error(ErrorKind::usage, file.string() + ": " + fault);
    for (std::string line; std::getline(lines, line);) {
        const auto include = parse_include(line);
        if (!include || include->name == "pass" || include->name == "predicate") continue;
        gather_shader(manifest, (include->is_shared ? glsl_folder : file.parent_path()) / include->name,
                      glsl_folder, files, depth + 1);
    }
}

std::set<fs::path> files_of(const EffectManifest& manifest, const fs::path& glsl_folder) {
    std::set<fs::path> files{manifest.document};
    for (const ModuleSpec& part : manifest.modules) files.insert(part.folder / "module.json");
    for (const PassSpec& pass : manifest.passes) {
        for (const std::string& shader : pass.shader_files())
            gather_shader(manifest, pass.folder / shader, glsl_folder, files);
        if (pass.lists())
            gather_shader(manifest, shader_path(pass, ShaderFile::main, glsl_folder), glsl_folder, files);
        if (pass.over())
            gather_shader(manifest, shader_path(pass, ShaderFile::vertex, glsl_folder), glsl_folder, files);
    }
    if (manifest.native)
        for (const auto& entry : fs::directory_iterator(manifest.folder))
            if (is_native_source(entry.path())) files.insert(entry.path());
    return files;
}

std::vector<fs::path> files_of_values(const PipelineStep& step) {
    std::vector<fs::path> files;
    for (const ParamSpec& spec : step.manifest->params)
        for (const ParamValue& value : step.known_values(spec))
            if (is_file_type(spec.type) && !is_ocio_file(spec) && !std::get<std::string>(value).empty())
                files.emplace_back(std::get<std::string>(value));
    for (const StepColorRequest& asked : color_requests(step)) {
        const auto made = make_color_transform(asked.request);
        if (const auto* transform = std::get_if<ColorTransform>(&made))
            files.insert(files.end(), transform->files.begin(), transform->files.end());
        else if (!asked.request.path.empty()) files.emplace_back(asked.request.path);
    }
    if (step.mask && !step.mask->file.empty()) files.push_back(step.mask->file);
    return files;
}

}  // namespace

std::set<fs::path> files_of_step(const PipelineStep& step, const fs::path& glsl_folder) {
    const std::vector<fs::path> values = files_of_values(step);
    std::set<fs::path> files(values.begin(), values.end());
    try {
        files.merge(files_of(*step.manifest, glsl_folder));
    } catch (const std::exception&) {
        // A shader that cannot be read is a fault of its effect, reported where it is compiled.
    }
    return files;
}

std::vector<fs::path> files_of_pipeline(const Pipeline& pipeline, const fs::path& glsl_folder) {
    std::set<fs::path> files;
    for (const PipelineStep& step : pipeline.steps) files.merge(files_of_step(step, glsl_folder));
    return {files.begin(), files.end()};
}

std::string content_of_values(const PipelineStep& step) {
    std::string text;
    for (const ParamSpec& spec : step.manifest->params)
        for (const ParamValue& value : step.known_values(spec)) text += spec.type->content(value);
    for (const fs::path& file : files_of_values(step)) add_file(file, text);
    return text;
}

std::string content_of_effect(const EffectManifest& manifest, const fs::path& glsl_folder) {
    std::string text;
    for (const fs::path& file : files_of(manifest, glsl_folder)) add_file(file, text);
    return text;
}

namespace {

/// `requests` with each value of one more parameter.
std::set<ColorRequest> with_values(const std::set<ColorRequest>& requests, const PipelineStep& step,
                                   const ParamSpec& spec) {
    std::set<ColorRequest> all;
    for (const ParamValue& value : step.known_values(spec))
        for (ColorRequest request : requests) {
            set_color_part(request, spec, value);
            all.insert(std::move(request));
        }
    return all;
}

}  // namespace

std::vector<StepColorRequest> color_requests(const PipelineStep& step) {
    std::vector<StepColorRequest> all;
    for (const ParamSpec& file : step.manifest->params) {
        if (!is_ocio_file(file)) continue;
        std::set<ColorRequest> requests{empty_request(file)};
        for (const ParamSpec& spec : step.manifest->params)
            if (!spec.ocio.empty() || spec.name == file.name) requests = with_values(requests, step, spec);
        for (const ColorRequest& request : requests)
            if (!request.is_file || !request.path.empty()) all.push_back({&file, request});
    }
    return all;
}

void check_color_requests(const PipelineStep& step, const Place& place, Diagnostics& diagnostics) {
    std::set<std::string> told;
    for (const StepColorRequest& asked : color_requests(step)) {
        const auto made = make_color_transform(asked.request);
        const auto* fault = std::get_if<ColorFault>(&made);
        if (!fault) continue;
        const std::string& param = param_at_fault(*step.manifest, *asked.file, *fault).name;
        const std::string text = step.name + "." + param + ": " + fault->text;
        const auto said = step.places.find(param);
        if (told.insert(text).second)
            diagnostics.error(said == step.places.end() ? place : said->second, text);
    }
}

}  // namespace aftershade
