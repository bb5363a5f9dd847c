#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <map>

#include "bind.h"
#include "convert.h"

namespace aftershade::python {

namespace {

using namespace nb::literals;
namespace fs = std::filesystem;

api::FlipChoice flip_from(const std::string& name) {
    const std::map<std::string, api::FlipChoice> choices = {{"auto", api::FlipChoice::automatic},
                                                            {"ldr", api::FlipChoice::ldr},
                                                            {"hdr", api::FlipChoice::hdr},
                                                            {"both", api::FlipChoice::both},
                                                            {"none", api::FlipChoice::none}};
    const auto found = choices.find(name);
    if (found == choices.end())
        throw nb::value_error(("flip '" + name + "' is unknown; it is auto, ldr, hdr, both or none").c_str());
    return found->second;
}

api::CompareOptions compare_options(double limit, double relative, double ulp, double percent,
                                    std::uint64_t allowed, std::optional<double> fail_flip,
                                    std::optional<double> fail_ssim, bool nan_equal, const std::string& flip,
                                    bool ssim, bool maps, double pixels_per_degree,
                                    const std::map<std::string, std::string>& roles) {
    api::CompareOptions options;
    options.fail.limit = limit;
    options.fail.relative = relative;
    options.fail.ulp = ulp;
    options.fail.percent = percent;
    options.fail.allowed = allowed;
    options.fail_flip = fail_flip;
    options.fail_ssim = fail_ssim;
    options.nan_equal = nan_equal;
    options.flip = flip_from(flip);
    options.ssim = ssim;
    options.maps = maps;
    options.pixels_per_degree = pixels_per_degree;
    options.roles.assign(roles.begin(), roles.end());
    return options;
}

nb::object optional_to(const std::optional<double>& value) {
    return value ? nb::cast(*value) : nb::none();
}

nb::dict layer_to(const api::LayerFigures& layer) {
    nb::dict result;
    result["label"] = layer.label;
    result["role"] = layer.role;
    result["channels"] = layer.channels;
    result["pixels"] = layer.pixels;
    result["failing"] = layer.failing;
    result["warning"] = layer.warning;
    result["bits_equal"] = layer.bits_equal;
    result["mean_absolute"] = layer.mean_absolute;
    result["rmse"] = layer.rmse;
    result["psnr_db"] = layer.psnr_db;
    result["mean_pixel"] = layer.mean_pixel;
    result["largest"] = layer.largest.value;
    result["largest_px"] = nb::make_tuple(layer.largest.x, layer.largest.y);
    result["ldr_flip"] = optional_to(layer.ldr_flip);
    result["hdr_flip"] = optional_to(layer.hdr_flip);
    result["ssim"] = optional_to(layer.ssim);
    result["ms_ssim"] = optional_to(layer.ms_ssim);
    result["verdict"] = api::verdict_name(layer.verdict);
    result["reasons"] = layer.reasons;
    result["is_judged"] = layer.is_judged;
    result["flip_map"] = layer.flip_map.empty() ? nb::none() : array_from(layer.flip_map);
    result["ssim_map"] = layer.ssim_map.empty() ? nb::none() : array_from(layer.ssim_map);
    return result;
}

nb::dict comparison_to(const api::Comparison& comparison) {
    nb::dict result;
    result["verdict"] = api::verdict_name(comparison.verdict);
    result["faults"] = comparison.faults;
    result["warnings"] = comparison.warnings;
    result["notes"] = comparison.notes;
    result["not_judged"] = comparison.not_judged;
    nb::list layers;
    for (const api::LayerFigures& layer : comparison.layers) layers.append(layer_to(layer));
    result["layers"] = layers;
    return result;
}

}  // namespace

void bind_compare(nb::module_& module) {
    nb::class_<api::CompareOptions>(module, "CompareOptions")
        .def(nb::new_(&compare_options), "limit"_a, "relative"_a, "ulp"_a, "percent"_a, "allowed"_a,
             "fail_flip"_a.none(), "fail_ssim"_a.none(), "nan_equal"_a, "flip"_a, "ssim"_a, "maps"_a,
             "pixels_per_degree"_a, "roles"_a);
    module.def(
        "compare_files",
        [](const fs::path& reference, const fs::path& test, const api::CompareOptions& options) {
            const auto comparison = [&] {
                const nb::gil_scoped_release released;
                return api::compare(reference, test, options);
            }();
            return comparison_to(comparison);
        },
        "reference"_a, "test"_a, "options"_a);
    module.def(
        "compare_arrays",
        [](const InputArray& reference, const InputArray& test, const std::string& role,
           const api::CompareOptions& options) {
            const api::ArrayView a = view_from(reference), b = view_from(test);
            const auto comparison = [&] {
                const nb::gil_scoped_release released;
                return api::compare(a, b, role, options);
            }();
            return comparison_to(comparison);
        },
        "reference"_a, "test"_a, "role"_a, "options"_a);
}

}  // namespace aftershade::python
