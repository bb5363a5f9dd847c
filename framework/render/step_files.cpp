#include "framework/render/step_files.h"

#include <utility>

#include "framework/base/error.h"
#include "framework/file/picture.h"

namespace aftershade {

const std::map<std::string, ParamFile>& StepFiles::of_step(int index, const PipelineStep& step,
                                                           const ParamReader& params) {
    std::map<std::string, std::string> paths;
    for (const ParamSpec& spec : step.manifest->params)
        if (is_file_type(spec.type)) paths[spec.name] = std::get<std::string>(params.get(spec.name));
    const auto known = steps_.find(index);
    if (known != steps_.end() && known->second.paths == paths) return known->second.files;
    Loaded loaded{paths, {}};
    Diagnostics faults;
    for (const auto& [name, path] : paths)
        if (auto file = load_param_file(*step.manifest->find_param(name), path, faults))
            loaded.files[name] = std::move(*file);
    if (faults.has_errors()) throw Error(ErrorKind::usage, faults);
    return (steps_[index] = std::move(loaded)).files;
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
