#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <vector>

#include "bind.h"
#include "convert.h"
#include "host_lock.h"

namespace aftershade::python {

namespace {

using namespace nb::literals;
namespace fs = std::filesystem;

nb::dict settings_to(const api::VelocitySettings& settings) {
    nb::dict result;
    result["delta"] = settings.delta;
    result["y_axis"] = settings.y_axis;
    result["unit"] = settings.unit;
    result["scale"] = nb::make_tuple(settings.scale[0], settings.scale[1]);
    result["exchange_channels"] = settings.exchange_channels;
    return result;
}

nb::list checks_to(const std::vector<api::VelocityCheck>& checks) {
    nb::list result;
    for (const api::VelocityCheck& check : checks) {
        nb::dict one;
        one["role"] = check.role;
        one["verdict"] = api::velocity_verdict_name(check.verdict);
        one["sentence"] = check.sentence;
        one["score"] = check.score;
        one["rival_score"] = check.rival_score;
        one["settings"] = settings_to(check.settings);
        one["suggested"] = settings_to(check.suggested);
        one["untold"] = check.untold;
        one["longest_px"] = check.longest_px;
        result.append(one);
    }
    return result;
}

}  // namespace

void bind_velocity(nb::module_& module) {
    module.def(
        "check_velocity_of_files",
        [](const HostPointer& host, const fs::path& frame, const fs::path& next_frame,
           const api::CaptureOptions& options) {
            return checks_to(
                host->call([&] { return api::check_velocity(host->host, frame, next_frame, options); }));
        },
        "host"_a, "frame"_a, "next_frame"_a, "options"_a);
    module.def(
        "check_velocity_of_captures",
        [](const api::Capture& frame, const api::Capture& next_frame) {
            const api::Capture first(frame), second(next_frame);
            const auto checks = [&] {
                const nb::gil_scoped_release released;
                return api::check_velocity(first, second);
            }();
            return checks_to(checks);
        },
        "frame"_a, "next_frame"_a);
}

}  // namespace aftershade::python
