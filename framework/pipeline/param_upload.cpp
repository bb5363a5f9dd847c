#include "framework/pipeline/param_upload.h"

#include <algorithm>
#include <sstream>

#include "framework/core/error.h"
#include "framework/image/cryptomatte.h"
#include "framework/image/picture.h"
#include "framework/pipeline/built_graph.h"

namespace aftershade {

namespace {

std::optional<std::uint32_t> object_id_of_name(const std::string& name) {
    return cryptomatte_hash(name);
}

void upload_texture(const ParamTexture& source, gpu::Texture& texture) {
    const std::size_t layer_values = source.texels.size() / std::size_t(source.layers);
    for (int layer = 0; layer < source.layers; ++layer)
        texture.upload(std::span(source.texels).subspan(std::size_t(layer) * layer_values, layer_values),
                       layer);
}

void upload_param(const BoundParam& bound, const ParamValue& value, StepFiles& files,
                  const PipelineStep& step, const ParamSet& params, graph::Executor& executor) {
    if (is_param_buffer(bound.spec->type)) {
        const auto bytes = table_buffer(*bound.spec, table_of(value), object_id_of_name);
        if (gpu::Buffer* buffer = executor.buffer(bound.buffer)) buffer->write(bytes);
        if (bound.spec->type != ParamType::scattering_profile) return;
    }
    gpu::Texture* texture = executor.texture(bound.texture);
    if (!texture) return;
    if (const auto* scattering = std::get_if<ScatteringValue>(&value)) {
        upload_texture(scattering_texture(*scattering), *texture);
        return;
    }
    if (bound.spec->type == ParamType::curve)
        upload_texture(curve_texture(*bound.spec, std::get<CurveValue>(value)), *texture);
    else upload_texture(file_texture(files.of_step(bound.step, step, params).at(bound.spec->name)), *texture);
}

[[noreturn]] void refuse(const Diagnostics& faults) {
    std::ostringstream text;
    faults.print(text);
    std::string message = text.str();
    while (message.ends_with('\n')) message.pop_back();
    throw Error(ExitCode::usage, message);
}

}  // namespace

const std::map<std::string, ParamFile>& StepFiles::of_step(int index, const PipelineStep& step,
                                                           const ParamSet& params) {
    std::map<std::string, std::string> paths;
    for (const ParamSpec& spec : step.manifest->params)
        if (spec.type == ParamType::file) paths[spec.name] = std::get<std::string>(params.get(spec.name));
    const auto known = steps_.find(index);
    if (known != steps_.end() && known->second.paths == paths) return known->second.files;
    Loaded loaded{paths, {}};
    Diagnostics faults;
    for (const auto& [name, path] : paths)
        if (auto file = load_param_file(*step.manifest->find_param(name), path, faults))
            loaded.files[name] = std::move(*file);
    if (faults.has_errors()) refuse(faults);
    return (steps_[index] = std::move(loaded)).files;
}

const Image& StepFiles::mask_of(const std::filesystem::path& path) {
    const auto known = masks_.find(path);
    if (known != masks_.end()) return known->second;
    Image picture;
    try {
        picture = read_picture(path, PictureSpace::data);
    } catch (const Error& error) {
        throw Error(ExitCode::usage, error.what());
    }
    Image mask(picture.width(), picture.height(), 1);
    for (std::size_t i = 0; i < mask.floats().size(); ++i) mask.floats()[i] = picture.floats()[i * 4];
    return masks_[path] = std::move(mask);
}

void upload_params(const Pipeline& pipeline, const std::vector<ParamSet>& params, StepFiles& files,
                   BuiltGraph& built) {
    for (std::size_t i = 0; i < built.params.size(); ++i) {
        const BoundParam& bound = built.params[i];
        const auto step = std::size_t(bound.step);
        const ParamValue& value = params[step].get(bound.spec->name);
        if (built.uploaded[i] == value) continue;
        upload_param(bound, value, files, pipeline.steps[step], params[step], *built.executor);
        built.uploaded[i] = value;
    }
    if (built.masks_uploaded) return;
    for (const auto& [step, handle] : built.mask_files)
        if (gpu::Texture* texture = built.executor->texture(handle))
            texture->upload(files.mask_of(pipeline.steps[std::size_t(step)].mask->file).floats());
    built.masks_uploaded = true;
}

}  // namespace aftershade
