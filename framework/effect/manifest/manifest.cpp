#include "framework/effect/manifest/manifest.h"

#include <algorithm>

#include "framework/image/role.h"

namespace aftershade {

namespace {

template <typename T>
const T* find_named(const std::vector<T>& list, const std::string& name) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const T& item) { return item.name == name; });
    return found == list.end() ? nullptr : &*found;
}

}  // namespace

std::vector<std::string> PassSpec::shader_files() const {
    std::vector<std::string> files;
    if (!shader.empty()) files.push_back(shader);
    if (vertex()) files.push_back(*vertex());
    return files;
}

std::string InputSpec::image_role() const {
    return layer < 0 ? role : RoleId::of_layer(layer, role).name();
}

const std::string* EffectManifest::find_generated(const std::filesystem::path& file) const {
    const auto found =
        file.parent_path() == folder ? generated.find(file.filename().string()) : generated.end();
    return found == generated.end() ? nullptr : &found->second;
}

const InputSpec* EffectManifest::find_input(const std::string& name) const {
    return find_named(inputs, name);
}
const OutputSpec* EffectManifest::find_output(const std::string& name) const {
    return find_named(outputs, name);
}
const ParamSpec* EffectManifest::find_param(const std::string& name) const {
    return find_named(params, name);
}
const TextureSpec* EffectManifest::find_texture(const std::string& name) const {
    return find_named(textures, name);
}
const BufferSpec* EffectManifest::find_buffer(const std::string& name) const {
    return find_named(buffers, name);
}
const TileListSpec* EffectManifest::tile_list_of(const PassSpec& pass) const {
    const std::string* const name = pass.lists() ? pass.lists() : pass.over();
    return name ? find_named(tiles, *name) : nullptr;
}
const PresetSpec* EffectManifest::find_preset(const std::string& name) const {
    return find_named(presets, name);
}

bool EffectManifest::has_history() const {
    const auto any = [](const auto& list) {
        return std::any_of(list.begin(), list.end(), [](const auto& item) { return item.history; });
    };
    return any(inputs) || any(textures) || any(buffers);
}

std::vector<std::string> EffectManifest::param_names() const {
    std::vector<std::string> names;
    for (const ParamSpec& spec : params) names.push_back(spec.name);
    return names;
}

int EffectManifest::most_of(const CountSpec& count) const {
    const ParamSpec* spec = find_param(count.param);
    return spec && spec->max ? int(*spec->max) : count.number;
}

const std::vector<std::string>& effect_groups() {
    static const std::vector<std::string> groups = {"lens", "shutter", "scattering", "light",
                                                    "film", "color",   "repair",     "diagnosis"};
    return groups;
}

}  // namespace aftershade
