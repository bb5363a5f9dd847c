#include "aftershade/effects.h"

#include <utility>

#include "framework/host/host_data.h"
#include "framework/host/image_data.h"
#include "framework/host/look_data.h"

namespace aftershade::host {

namespace {

std::vector<PresetInfo> presets_of(const EffectManifest& manifest) {
    std::vector<PresetInfo> presets;
    for (const PresetSpec& preset : manifest.presets) {
        PresetInfo info{preset.name, {}};
        for (const auto& [name, value] : preset.values)
            info.values.push_back({name, value_of(*manifest.find_param(name), value)});
        presets.push_back(std::move(info));
    }
    return presets;
}

EffectInfo info_of(const EffectManifest& manifest) {
    EffectInfo info;
    info.id = manifest.id;
    info.version = manifest.version;
    info.summary = manifest.summary;
    info.folder = manifest.folder.string();
    for (const InputSpec& input : manifest.inputs)
        info.inputs.push_back(
            {input.name, input.image_role(), input.doc, input.optional, input.history, input.frame});
    for (const OutputSpec& output : manifest.outputs)
        info.outputs.push_back({output.name, output.role, output.doc});
    for (const ParamSpec& spec : manifest.params) info.params.push_back(host::info_of(spec));
    for (const TextureSpec& texture : manifest.textures)
        if (texture.layers == 1) info.textures.push_back(texture.name);
    info.presets = presets_of(manifest);
    info.sources = manifest.sources;
    info.has_history = manifest.has_history();
    info.has_native_code = manifest.native.has_value();
    info.warmup_frames = manifest.warmup ? manifest.warmup->frames : 0;
    return info;
}

}  // namespace

std::vector<EffectInfo> Host::effects(std::vector<Diagnostic>* faults) const {
    Data& data = Access::host(*this);
    return called(data, [&] {
        EffectRegistry registry = data.registry();
        Diagnostics found;
        registry.warn_of_unreadable(found);
        registry.warn_of_hidden(found);
        std::vector<EffectInfo> effects;
        for (const std::string& id : registry.ids())
            if (const EffectManifest* manifest = registry.find(id, found))
                effects.push_back(info_of(*manifest));
        if (!faults) stop_at_errors(ErrorKind::document, found);
        else *faults = public_diagnostics(found.all());
        return effects;
    });
}

EffectInfo Host::effect(const std::string& id) const {
    Data& data = Access::host(*this);
    return called(data, [&] {
        EffectRegistry registry = data.registry();
        if (!registry.contains(id))
            fail_at(ErrorKind::usage, "id", "no effect '" + id + "'" + did_you_mean(id, registry.ids()));
        Diagnostics faults;
        const EffectManifest* manifest = registry.find(id, faults);
        stop_at_errors(ErrorKind::document, faults);
        return info_of(*manifest);
    });
}

}  // namespace aftershade::host
