#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <map>
#include <optional>

#include "bind.h"
#include "convert.h"
#include "host_lock.h"

namespace aftershade::python {

namespace {

using namespace nb::literals;
namespace fs = std::filesystem;

/// Freed only under its host's lock: its GPU memory belongs to the host's context.
template <typename Held>
struct OnHost {
    OnHost(HostPointer its_host, Held made) : host(std::move(its_host)), held(std::move(made)) {}
    OnHost(OnHost&&) noexcept = default;
    ~OnHost() {
        if (host && held) host->call([&] { held.reset(); });
    }

    HostPointer host;
    std::optional<Held> held;
};

using LookOnHost = OnHost<api::Look>;
using SessionOnHost = OnHost<api::Session>;

std::map<std::string, api::Value> values_from(const nb::dict& values) {
    std::map<std::string, api::Value> result;
    for (const auto& [name, value] : values) result.emplace(nb::cast<std::string>(name), value_from(value));
    return result;
}

api::LookOptions look_options(const std::vector<std::string>& taps, const nb::dict& variables,
                              const fs::path& folder) {
    api::LookOptions options;
    options.taps = taps;
    options.variables = values_from(variables);
    options.folder = folder;
    return options;
}

api::NonFinite non_finite_from(const std::string& name) {
    if (name == "ignore") return api::NonFinite::ignore;
    if (name == "report") return api::NonFinite::report;
    if (name == "fail") return api::NonFinite::fail;
    if (name == "mend") return api::NonFinite::mend;
    throw nb::value_error(
        ("non_finite '" + name + "' is unknown; it is ignore, report, fail or mend").c_str());
}

/// Keeps the captures that host::RenderOptions points to.
struct RenderRequest {
    api::RenderOptions options;
    std::optional<api::Capture> previous, next;

    api::RenderOptions pointing() const {
        api::RenderOptions result = options;
        result.previous = previous ? &*previous : nullptr;
        result.next = next ? &*next : nullptr;
        return result;
    }
};

RenderRequest render_request(const std::vector<std::string>& roles, bool timed, bool telemetry,
                             const std::string& non_finite, const api::Capture* previous,
                             const api::Capture* next, bool begins_shot, double fps) {
    RenderRequest request;
    request.options.roles = roles;
    request.options.timed = timed;
    request.options.telemetry = telemetry;
    request.options.non_finite = non_finite_from(non_finite);
    request.options.begins_shot = begins_shot;
    request.options.fps = fps;
    if (previous) request.previous = *previous;
    if (next) request.next = *next;
    return request;
}

nb::dict look_param_to(const api::LookParam& param) {
    nb::dict result = param_to(param.info);
    result["name"] = param.name;
    result["step"] = param.step;
    result["value"] = value_to(param.value);
    result["origin"] = param.origin;
    return result;
}

nb::dict statistic_to(const api::StatisticInfo& info) {
    nb::dict result;
    result["step"] = info.step;
    result["name"] = info.name;
    result["count"] = info.count;
    result["non_finite"] = info.non_finite;
    result["sum"] = info.sum;
    result["mean"] = info.mean;
    result["deviation"] = info.deviation;
    result["min"] = info.min;
    result["max"] = info.max;
    result["histogram_range"] = nb::make_tuple(info.histogram_from, info.histogram_to);
    result["histogram"] = info.histogram;
    return result;
}

nb::dict non_finite_to(const api::NonFiniteInfo& info) {
    nb::dict result;
    result["image"] = info.image;
    result["of_capture"] = info.of_capture;
    result["first_px"] = nb::make_tuple(info.x, info.y);
    result["nan"] = info.nan;
    result["infinite"] = info.infinite;
    result["mended"] = info.mended;
    return result;
}

template <typename Items, typename Convert>
nb::list list_to(const Items& items, Convert convert) {
    nb::list result;
    for (const auto& item : items) result.append(convert(item));
    return result;
}

void write_result(const api::Result& result, const fs::path& path, const std::vector<std::string>& roles,
                  bool half, bool crop_to_display, const std::string& compression) {
    const nb::gil_scoped_release released;
    result.write(path, {roles, half, crop_to_display, compression});
}

void bind_result(nb::module_& module) {
    nb::class_<api::Result>(module, "Result")
        .def_prop_ro("frame", &api::Result::frame)
        .def_prop_ro("is_pending", &api::Result::is_pending)
        .def_prop_ro("roles", &api::Result::roles)
        .def(
            "image",
            [](const api::Result& self, const std::string& role) { return array_from(self.image(role)); },
            "role"_a)
        .def_prop_ro("taps", &api::Result::taps)
        .def(
            "tap",
            [](const api::Result& self, const std::string& name) { return array_from(self.tap(name)); },
            "name"_a)
        .def_prop_ro("times_ms",
                     [](const api::Result& self) {
                         return list_to(self.times(), [](const api::PassTime& time) {
                             return nb::make_tuple(time.pass, time.milliseconds);
                         });
                     })
        .def_prop_ro("statistics",
                     [](const api::Result& self) { return list_to(self.statistics(), statistic_to); })
        .def_prop_ro("non_finite",
                     [](const api::Result& self) { return list_to(self.non_finite(), non_finite_to); })
        .def_prop_ro("messages", &api::Result::messages)
        .def_prop_ro("notes", &api::Result::notes)
        .def_prop_ro("history_reset", &api::Result::history_reset)
        .def_prop_ro("gpu_bytes", &api::Result::gpu_bytes)
        .def("write", &write_result, "path"_a, "roles"_a, "half"_a, "crop_to_display"_a, "compression"_a);
}

void bind_session(nb::module_& module) {
    nb::class_<SessionOnHost>(module, "Session")
        .def(
            "render",
            [](SessionOnHost& self, const api::Capture& capture, const RenderRequest& request) {
                return self.host->call([&] { return self.held->render(capture, request.pointing()); });
            },
            "capture"_a, "request"_a)
        .def(
            "render_subframe",
            [](SessionOnHost& self, const api::Capture& capture, int index, int count,
               const RenderRequest& request) {
                return self.host->call(
                    [&] { return self.held->render_subframe(capture, index, count, request.pointing()); });
            },
            "capture"_a, "index"_a, "count"_a, "request"_a)
        .def(
            "render_frame",
            [](SessionOnHost& self, const SequenceOfHost& sequence, int frame, const RenderRequest& request) {
                return self.host->call(
                    [&] { return self.held->render(sequence.sequence, frame, request.options); });
            },
            "sequence"_a, "frame"_a, "request"_a)
        .def("reset", [](SessionOnHost& self) { self.host->call([&] { self.held->reset(); }); })
        .def(
            "save_history",
            [](SessionOnHost& self, const fs::path& path) {
                self.host->call([&] { self.held->save_history(path); });
            },
            "path"_a)
        .def(
            "load_history",
            [](SessionOnHost& self, const fs::path& path) {
                self.host->call([&] { self.held->load_history(path); });
            },
            "path"_a);
}

LookOnHost load_look(const HostPointer& host, const fs::path& path, const api::LookOptions& options) {
    return {host, host->call([&] { return host->host.load_look(path, options); })};
}

LookOnHost parse_look(const HostPointer& host, const std::string& json, const api::LookOptions& options) {
    return {host, host->call([&] { return host->host.parse_look(json, options); })};
}

}  // namespace

void bind_look(nb::module_& module) {
    nb::class_<api::LookOptions>(module, "LookOptions")
        .def(nb::new_(&look_options), "taps"_a, "variables"_a, "folder"_a);
    nb::class_<RenderRequest>(module, "RenderOptions")
        .def(nb::new_(&render_request), "roles"_a, "timed"_a, "telemetry"_a, "non_finite"_a,
             "previous"_a.none(), "next"_a.none(), "begins_shot"_a, "fps"_a);
    bind_result(module);
    bind_session(module);
    nb::class_<LookOnHost>(module, "Look")
        .def_static("load", &load_look, "host"_a, "path"_a, "options"_a)
        .def_static("parse", &parse_look, "host"_a, "json"_a, "options"_a)
        .def_prop_ro("steps",
                     [](LookOnHost& self) { return self.host->call([&] { return self.held->steps(); }); })
        .def_prop_ro("inputs",
                     [](LookOnHost& self) { return self.host->call([&] { return self.held->inputs(); }); })
        .def_prop_ro("outputs",
                     [](LookOnHost& self) { return self.host->call([&] { return self.held->outputs(); }); })
        .def_prop_ro(
            "has_history",
            [](LookOnHost& self) { return self.host->call([&] { return self.held->has_history(); }); })
        .def_prop_ro("warnings",
                     [](LookOnHost& self) {
                         return list_to(self.host->call([&] { return self.held->warnings(); }),
                                        diagnostic_to);
                     })
        .def_prop_ro("params",
                     [](LookOnHost& self) {
                         return list_to(self.host->call([&] { return self.held->params(); }), look_param_to);
                     })
        .def(
            "set",
            [](LookOnHost& self, const nb::dict& values) {
                const auto converted = values_from(values);
                self.host->call([&] { self.held->set(converted); });
            },
            "values"_a)
        .def(
            "reset",
            [](LookOnHost& self, const std::string& name) {
                self.host->call([&] { self.held->reset(name); });
            },
            "name"_a)
        .def(
            "get",
            [](LookOnHost& self, const std::string& name) {
                return value_to(self.host->call([&] { return self.held->get(name); }));
            },
            "name"_a)
        .def(
            "read",
            [](LookOnHost& self, const fs::path& path, const api::CaptureOptions& options) {
                return self.host->call([&] { return self.held->read(path, options); });
            },
            "path"_a, "options"_a)
        .def(
            "render",
            [](LookOnHost& self, const api::Capture& capture, const RenderRequest& request) {
                return self.host->call([&] { return self.held->render(capture, request.pointing()); });
            },
            "capture"_a, "request"_a)
        .def("session", [](LookOnHost& self) {
            return SessionOnHost(self.host, self.host->call([&] { return self.held->session(); }));
        });
}

}  // namespace aftershade::python
