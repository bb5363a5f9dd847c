#include "framework/render/step_files.h"

#include <optional>
#include <utility>

#include "framework/base/error.h"
#include "framework/effect/color_param.h"
#include "framework/file/picture.h"

namespace aftershade {

namespace {

std::optional<ParamFile> load_transform(const PipelineStep& step, const ParamSpec& file,
                                        const std::map<std::string, ParamValue>& values,
                                        Diagnostics& faults) {
    const auto request =
        color_request(*step.manifest, file, [&](const ParamSpec& spec) { return values.at(spec.name); });
    if (!request) return ParamFile{};
    auto made = make_color_transform(*request);
    if (auto* transform = std::get_if<ColorTransform>(&made)) return std::move(*transform);
    const auto& fault = std::get<ColorFault>(made);
    faults.error({}, step.name + "." + param_at_fault(*step.manifest, file, fault).name + ": " + fault.text);
    return std::nullopt;
}

}  // namespace

const std::map<std::string, ParamFile>& StepFiles::of_step(int index, const PipelineStep& step,
                                                           const ParamReader& params) {
    std::map<std::string, ParamValue> values;
    for (const ParamSpec& spec : step.manifest->params)
        if (is_file_type(spec.type) || is_color_part(spec)) values[spec.name] = params.get(spec.name);
    const auto known = steps_.find(index);
    if (known != steps_.end() && known->second.values == values) return known->second.files;
    Loaded loaded{values, {}};
    Diagnostics faults;
    for (const ParamSpec& spec : step.manifest->params) {
        if (!is_file_type(spec.type)) continue;
        auto file = is_ocio_file(spec)
                        ? load_transform(step, spec, values, faults)
                        : load_param_file(spec, std::get<std::string>(values[spec.name]), faults);
        if (file) loaded.files[spec.name] = std::move(*file);
    }
    if (faults.has_errors()) throw Error(ErrorKind::usage, faults);
    return (steps_[index] = std::move(loaded)).files;
}

const ParamFile* StepFiles::loaded(int index, const std::string& param) const {
    const auto step = steps_.find(index);
    if (step == steps_.end()) return nullptr;
    const auto file = step->second.files.find(param);
    return file == step->second.files.end() ? nullptr : &file->second;
}

const Image& StepFiles::mask_of(const std::filesystem::path& path) {
    const auto known = masks_.find(path);
    if (known != masks_.end()) return known->second;
    Image picture;
    try {
        picture = read_picture(path, PictureSpace::data);
    } catch (const Error& error) {
        throw Error(ErrorKind::usage, error.what());
    }
    Image mask(picture.width(), picture.height(), 1);
    for (std::size_t i = 0; i < mask.floats().size(); ++i) mask.floats()[i] = picture.floats()[i * 4];
    return masks_[path] = std::move(mask);
}

}  // namespace aftershade
