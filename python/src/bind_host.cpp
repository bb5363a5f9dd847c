#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bind.h"
#include "convert.h"
#include "host_lock.h"

namespace aftershade::python {

namespace {

using namespace nb::literals;
namespace fs = std::filesystem;

api::Backend backend_from(const std::string& name) {
    for (const auto backend : {api::Backend::automatic, api::Backend::egl, api::Backend::software,
                               api::Backend::egl_software, api::Backend::osmesa})
        if (name == api::backend_name(backend)) return backend;
    throw nb::value_error(
        ("backend '" + name + "' is unknown; there are auto, egl, software, egl-software and osmesa")
            .c_str());
}

HostPointer make_host(const fs::path& data, const std::vector<fs::path>& effect_paths,
                      const std::vector<fs::path>& profile_paths, const std::vector<fs::path>& plugin_paths,
                      const std::string& backend, const std::string& device, const fs::path& cache,
                      int max_side_px, std::uint64_t max_image_bytes) {
    api::HostOptions options;
    options.data = data;
    options.effect_paths = effect_paths;
    options.profile_paths = profile_paths;
    options.plugin_paths = plugin_paths;
    options.backend = backend_from(backend);
    options.device = device;
    options.cache = cache;
    options.limits = {max_side_px, max_image_bytes};
    return std::make_shared<SharedHost>(std::move(options));
}

template <typename Number>
nb::object optional_to(const std::optional<Number>& value) {
    return value ? nb::cast(*value) : nb::none();
}

nb::object optional_value_to(const std::optional<api::Value>& value) {
    return value ? value_to(*value) : nb::none();
}

}  // namespace

nb::dict param_to(const api::ParamInfo& info) {
    nb::dict result;
    result["name"] = info.name;
    result["type"] = info.type;
    result["unit"] = info.unit;
    result["doc"] = info.doc;
    result["default"] = optional_value_to(info.default_value);
    result["min"] = optional_to(info.min);
    result["max"] = optional_to(info.max);
    result["ui_range"] =
        info.ui_range ? nb::object(nb::make_tuple((*info.ui_range)[0], (*info.ui_range)[1])) : nb::none();
    result["values"] = info.values;
    result["from_"] = info.from;
    result["identity"] = optional_value_to(info.identity);
    nb::list columns;
    for (const api::ParamInfo& column : info.columns) columns.append(param_to(column));
    result["columns"] = columns;
    return result;
}

namespace {

nb::dict effect_to(const api::EffectInfo& info) {
    nb::dict result;
    result["id"] = info.id;
    result["version"] = info.version;
    result["summary"] = info.summary;
    result["folder"] = info.folder;
    nb::list inputs, outputs, params;
    for (const api::InputInfo& input : info.inputs) {
        nb::dict one;
        one["name"] = input.name;
        one["role"] = input.role;
        one["doc"] = input.doc;
        one["optional"] = input.optional;
        one["history"] = input.history;
        one["frame"] = input.frame;
        inputs.append(one);
    }
    for (const api::OutputInfo& output : info.outputs) {
        nb::dict one;
        one["name"] = output.name;
        one["role"] = output.role;
        one["doc"] = output.doc;
        outputs.append(one);
    }
    for (const api::ParamInfo& param : info.params) params.append(param_to(param));
    nb::dict presets;
    for (const api::PresetInfo& preset : info.presets) {
        nb::dict values;
        for (const api::PresetValue& value : preset.values)
            values[value.param.c_str()] = value_to(value.value);
        presets[preset.name.c_str()] = values;
    }
    result["inputs"] = inputs;
    result["outputs"] = outputs;
    result["params"] = params;
    result["textures"] = info.textures;
    result["presets"] = presets;
    result["sources"] = info.sources;
    result["has_history"] = info.has_history;
    result["has_native_code"] = info.has_native_code;
    result["warmup_frames"] = info.warmup_frames;
    return result;
}

}  // namespace

void bind_host(nb::module_& module) {
    module.def("library_version", [] { return std::string(api::library_version()); });
    nb::class_<SharedHost>(module, "Host")
        .def(nb::new_(&make_host), "data"_a, "effect_paths"_a, "profile_paths"_a, "plugin_paths"_a,
             "backend"_a, "device"_a, "cache"_a, "max_side_px"_a, "max_image_bytes"_a)
        .def("close", [](SharedHost& self) { self.call([&] { self.host.close(); }); })
        .def_prop_ro("is_closed", [](const SharedHost& self) { return self.host.is_closed(); })
        .def("gl",
             [](SharedHost& self) {
                 const api::GlInfo info = self.call([&] { return self.host.gl(); });
                 nb::dict result;
                 result["backend"] = api::backend_name(info.backend);
                 result["renderer"] = info.renderer;
                 result["version"] = info.version;
                 result["vendor"] = info.vendor;
                 result["is_software"] = info.is_software;
                 result["device"] = info.device;
                 result["hardware_fault"] = info.hardware_fault;
                 return result;
             })
        .def("effects",
             [](SharedHost& self) {
                 nb::list result;
                 for (const api::EffectInfo& effect : self.call([&] { return self.host.effects(); }))
                     result.append(effect_to(effect));
                 return result;
             })
        .def(
            "effect",
            [](SharedHost& self, const std::string& id) {
                return effect_to(self.call([&] { return self.host.effect(id); }));
            },
            "id"_a)
        .def("profiles", [](SharedHost& self) {
            nb::dict result;
            for (const api::NameAndSummary& profile : self.call([&] { return self.host.profiles(); }))
                result[profile.name.c_str()] = profile.summary;
            return result;
        });
}

}  // namespace aftershade::python
