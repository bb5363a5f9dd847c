#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <optional>
#include <string>

#include "convert.h"

namespace aftershade::python {

namespace {

/// Visits the fields by name.
template <typename Camera, typename Visit>
void each_field(Camera& camera, Visit visit) {
    visit("focus_distance_m", camera.focus_distance_m);
    visit("focal_length_mm", camera.focal_length_mm);
    visit("sensor_width_mm", camera.sensor_width_mm);
    visit("f_number", camera.f_number);
    visit("blades", camera.blades);
    visit("rotation_deg", camera.rotation_deg);
    visit("shutter_angle_deg", camera.shutter_angle_deg);
    visit("near_m", camera.near_m);
    visit("far_m", camera.far_m);
    visit("camera_from_world", camera.camera_from_world);
    visit("ndc_from_world", camera.ndc_from_world);
    visit("jitter_px", camera.jitter_px);
}

/// Of 4 rows of 4 numbers too, such as a NumPy array.
api::Matrix4 matrix_from(nb::handle object) {
    const nb::object rows = nb::hasattr(object, "tolist") ? object.attr("tolist")() : nb::borrow(object);
    api::Matrix4 matrix{};
    std::size_t i = 0;
    const auto add = [&](nb::handle number) {
        if (i < matrix.size()) matrix[i] = nb::cast<double>(number);
        ++i;
    };
    for (nb::handle row : rows)
        if (nb::isinstance<nb::list>(row) || nb::isinstance<nb::tuple>(row))
            for (nb::handle number : row) add(number);
        else add(row);
    if (i != matrix.size()) throw nb::value_error("a matrix must have 4 rows of 4 numbers");
    return matrix;
}

void read(nb::handle object, std::optional<double>& field) {
    field = nb::cast<double>(object);
}
void read(nb::handle object, std::optional<api::Matrix4>& field) {
    field = matrix_from(object);
}
void read(nb::handle object, std::optional<std::array<double, 2>>& field) {
    field = nb::cast<std::array<double, 2>>(object);
}

}  // namespace

api::Camera camera_from(const nb::dict& fields) {
    api::Camera camera;
    for (const auto& [key, value] : fields) {
        const auto name = nb::cast<std::string>(key);
        bool found = name == "lens_model";
        if (found) camera.lens_model = nb::cast<std::string>(value);
        std::string names = "lens_model";
        each_field(camera, [&](const char* field_name, auto& field) {
            names += std::string(", ") + field_name;
            if (name != field_name) return;
            found = true;
            if (!value.is_none()) read(value, field);
        });
        if (!found) throw nb::type_error(("a camera has no '" + name + "'; it has " + names).c_str());
    }
    return camera;
}

nb::dict camera_to(const api::Camera& camera) {
    nb::dict fields;
    if (!camera.lens_model.empty()) fields["lens_model"] = camera.lens_model;
    each_field(camera, [&](const char* name, const auto& field) {
        if (field) fields[name] = nb::cast(*field);
    });
    return fields;
}

}  // namespace aftershade::python
