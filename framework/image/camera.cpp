#include "framework/image/camera.h"

#include <algorithm>

#include "framework/document/grammar_reader.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"

namespace aftershade {

const std::vector<CameraField>& camera_fields() {
    static const std::vector<CameraField> fields = {
        {"focus_distance", "m", 0.001, "Along the view axis to the plane in focus."},
        {"focal_length", "mm", 0.1, "With the sensor's width it gives the angle of view."},
        {"sensor_width", "mm", 0.1, "Sensor, as wide as the display window."},
        {"f_number", "", 0.01, "Focal length over the aperture's diameter."},
        {"blades", "", 0, "Corners of the aperture; 0 is a disk."},
        {"rotation", "deg", -1e6, "Rotation of the aperture; 0 puts the middle of a straight edge at +x."},
        {"shutter_angle", "deg", 0, "360 is the whole frame."},
        {"near", "m", 0, "The plane where a stored depth begins."},
        {"far", "m", 0, "The plane where a stored depth ends."},
    };
    return fields;
}

const CameraField* find_camera_field(const std::string& name) {
    const auto& fields = camera_fields();
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

const std::vector<std::string>& lens_model_names() {
    static const std::vector<std::string> names = {"thin", "pinhole"};
    return names;
}

std::vector<std::string> camera_sources(ParamType type) {
    const std::string camera(kFromCamera);
    if (type->is_choice) return {camera + "lens_model"};
    std::vector<std::string> sources;
    for (const CameraField& field : camera_fields()) sources.push_back(camera + field.name);
    return sources;
}

bool converts_to(const CameraField& field, const ParamSpec& spec) {
    return field.unit == spec.unit || convert_unit(1, field.unit, spec.unit);
}

std::string unknown_source(const std::string& source, const std::vector<std::string>& known) {
    return "'" + source + "' is not a value of the capture" + did_you_mean(source, known) +
           " (known: " + list_of_names(known, "and") + ")";
}

std::optional<double> Camera::get(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::nullopt : std::optional(found->second);
}

std::string Camera::origin(const std::string& name) const {
    const auto found = origins_.find(name);
    return found == origins_.end() ? "" : found->second;
}

void Camera::set_lens_model(const std::string& name, const std::string& origin) {
    lens_model = name;
    origins_["lens_model"] = origin;
}

void Camera::complete_from(const Camera& other) {
    values_.insert(other.values_.begin(), other.values_.end());
    if (lens_model.empty()) lens_model = other.lens_model;
    origins_.insert(other.origins_.begin(), other.origins_.end());
    if (matrices_found.empty()) matrices_found = other.matrices_found;
    if (matrices_fault.empty()) matrices_fault = other.matrices_fault;
    if (!camera_from_world) camera_from_world = other.camera_from_world;
    if (!ndc_from_world) ndc_from_world = other.ndc_from_world;
    if (!jitter_px) jitter_px = other.jitter_px;
}

Camera read_camera(const grammar::Reader& reader) {
    Camera camera;
    for (const CameraField& field : camera_fields())
        if (const auto value = reader.value(field.name))
            camera.set(field.name, std::get<double>(*value), "capture.json");
    if (reader.has("lens_model")) camera.set_lens_model(reader.text("lens_model"), "capture.json");
    return camera;
}

}  // namespace aftershade
