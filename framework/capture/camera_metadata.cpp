#include "framework/capture/camera_metadata.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <glm/matrix.hpp>
#include "framework/base/error.h"
#include "framework/capture/stored_matrices.h"
#include "framework/document/units.h"

#include "framework/image/camera_matrix.h"

namespace aftershade {

namespace {

/// OpenEXR's standard attributes, ImfStandardAttributes.h: focus in metres, lengths in millimetres.
struct StandardAttribute {
    const char* attribute;
    const char* field;
};
constexpr std::array kStandard = {
    StandardAttribute{"focus", "focus_distance"},
    StandardAttribute{"aperture", "f_number"},
    StandardAttribute{"effectiveFocalLength", "focal_length"},
    StandardAttribute{"nominalFocalLength", "focal_length"},
};

void set_if_known(Camera& camera, const CameraField& field, std::optional<double> value,
                  const std::string& attribute) {
    if (value && *value >= field.min && !camera.get(field.name))
        camera.set(field.name, *value, "attribute " + attribute);
}

struct StoredNumber {
    double value = 0;
    std::string attribute;
};

/// The first attribute of the source that the header has, in `unit`; nullopt where it is not a number.
std::optional<StoredNumber> find_number(const ExrMetadata& metadata, const CameraSource& source,
                                        const std::string& unit) {
    const std::vector<std::string> names = metadata.names();
    for (const std::string& pattern : source.attributes) {
        const auto fits = [&](const std::string& name) { return matches_pattern(name, pattern); };
        const auto found = std::find_if(names.begin(), names.end(), fits);
        if (found == names.end()) continue;
        const auto stored = metadata.number(*found);
        if (!stored) continue;
        const bool converts = !source.times_sensor_width && source.unit != unit;
        const auto value = converts ? convert_unit(*stored, source.unit, unit) : std::optional(*stored);
        if (value) return StoredNumber{*value, *found};
    }
    return std::nullopt;
}

/// The angle of view is what the picture shows, whatever part of the film a renderer used: the sensor is as
/// wide as the angle at the focal length. `widths` is of the picture, by the distance.
void set_by_angle(double widths, const std::string& origin, const Camera& known, Camera& camera) {
    const auto given_width_mm = known.get("sensor_width"), given_focal_mm = known.get("focal_length");
    const auto focal_mm = given_focal_mm ? given_focal_mm : camera.get("focal_length");
    if (focal_mm && !given_width_mm) camera.set("sensor_width", *focal_mm * widths, origin);
    else if (const auto width_mm = given_width_mm ? given_width_mm : camera.get("sensor_width"))
        camera.set("focal_length", *width_mm / widths, origin);
}

void set_by_field_of_view(const ExrMetadata& metadata, const Profile& profile, const Camera& known,
                          Camera& camera) {
    if (!profile.field_of_view) return;
    const auto angle = find_number(metadata, *profile.field_of_view, "deg");
    if (!angle || !(angle->value > 0 && angle->value < 180)) return;
    set_by_angle(2 * std::tan(angle->value * std::numbers::pi / 360), "attribute " + angle->attribute, known,
                 camera);
}

constexpr double kContradiction = 0.01;

bool contradict(double a, double b) {
    return std::abs(a - b) > kContradiction * std::max(std::abs(a), std::abs(b));
}

/// A projection in perspective that shows another angle than the lens: how wide its picture is, by the
/// distance.
std::optional<double> widths_beside_lens(const Camera& camera, const Camera& known) {
    if (known.get("focal_length") && known.get("sensor_width")) return std::nullopt;
    Camera lens = known;
    lens.complete_from(camera);
    const auto focal_mm = lens.get("focal_length"), width_mm = lens.get("sensor_width");
    if (!camera.camera_from_world || !camera.ndc_from_world || !focal_mm || !width_mm) return std::nullopt;
    const glm::dmat4 ndc_from_camera =
        glm_matrix(*camera.ndc_from_world) * glm::inverse(glm_matrix(*camera.camera_from_world));
    const double x = ndc_from_camera[0][0], distance = ndc_from_camera[2][3], none = ndc_from_camera[3][3];
    if (!(x != 0 && std::abs(distance) > std::abs(none))) return std::nullopt;
    const double widths = std::abs(2 * distance / x);
    return contradict(widths, *width_mm / *focal_mm) ? std::optional(widths) : std::nullopt;
}

/// Attributes that should give a field, in the order in which they are looked at.
struct FieldSource {
    std::string field, attribute;
    std::optional<double> value;  ///< in the field's unit
};

std::vector<FieldSource> sources_of_fields(const ExrMetadata& metadata, const Profile& profile) {
    std::vector<FieldSource> sources;
    const std::vector<std::string> names = metadata.names();
    for (const auto& [field, source] : profile.camera)
        for (const std::string& pattern : source.attributes)
            for (const std::string& name : names) {
                if (!matches_pattern(name, pattern)) continue;
                const std::string& unit = find_camera_field(field)->unit;
                const auto number = metadata.number(name);
                const bool converts = number && !source.times_sensor_width;
                sources.push_back({field, name,
                                   !converts             ? std::nullopt
                                   : source.unit == unit ? number
                                                         : convert_unit(*number, source.unit, unit)});
            }
    for (const CameraField& field : camera_fields()) {
        const std::string own = "aftershade/camera/" + field.name;
        sources.push_back({field.name, own, metadata.number(own)});
    }
    for (const StandardAttribute& standard : kStandard)
        sources.push_back({standard.field, standard.attribute, metadata.number(standard.attribute)});
    return sources;
}

void find_other_values(const std::vector<FieldSource>& sources, const Camera& known,
                       std::vector<std::string>& faults) {
    std::map<std::string, const FieldSource*> first;
    for (const FieldSource& source : sources) {
        if (known.get(source.field) || !source.value || !(*source.value > 0)) continue;
        const FieldSource& taken = *first.emplace(source.field, &source).first->second;
        if (!contradict(*taken.value, *source.value)) continue;
        const std::string unit = find_camera_field(source.field)->unit;
        faults.push_back("attribute " + taken.attribute + " gives the camera's " + source.field + " as " +
                         format_number(*taken.value) + " " + unit + ", " + source.attribute + " as " +
                         format_number(*source.value) + " " + unit + "; the first is taken (set \"" +
                         source.field + "\" in capture.json's camera)");
    }
}

std::string degrees_of(double widths) {
    return format_number(std::round(std::atan(widths / 2) * 3600 / std::numbers::pi) / 10);
}

/// Without the matrices.
Camera lens_of_metadata(const ExrMetadata& metadata, const Profile& profile, const Camera& known) {
    Camera camera;
    const std::optional<double> sensor_width = known.get("sensor_width");
    for (const auto& [name, source] : profile.camera) {
        const CameraField& field = *find_camera_field(name);
        if (source.times_sensor_width && !sensor_width) continue;
        auto stored = find_number(metadata, source, field.unit);
        if (!stored) continue;
        if (source.times_sensor_width) stored->value *= *sensor_width;
        set_if_known(camera, field, stored->value, stored->attribute);
    }
    set_by_field_of_view(metadata, profile, known, camera);
    for (const CameraField& field : camera_fields()) {
        const std::string own = "aftershade/camera/" + field.name;
        set_if_known(camera, field, metadata.number(own), own);
    }
    for (const StandardAttribute& standard : kStandard)
        set_if_known(camera, *find_camera_field(standard.field), metadata.number(standard.attribute),
                     standard.attribute);
    const auto sensor = metadata.value("sensorOverallDimensions");
    if (const auto* size = sensor ? std::get_if<std::vector<float>>(&*sensor) : nullptr;
        size && !size->empty())
        set_if_known(camera, *find_camera_field("sensor_width"), size->front(), "sensorOverallDimensions");
    const std::string own_model = "aftershade/camera/lens_model";
    if (const auto model = metadata.text(own_model)) camera.set_lens_model(*model, "attribute " + own_model);
    else if (!profile.lens_model.empty()) camera.set_lens_model(profile.lens_model, "profile " + profile.id);
    return camera;
}

}  // namespace

Camera camera_of_metadata(const ExrPart& part, const Profile& profile, const Camera& known) {
    const ExrMetadata& metadata = part.metadata;
    Camera camera = lens_of_metadata(metadata, profile, known);
    Camera lens = known;
    lens.complete_from(camera);
    StoredMatrices matrices = read_matrices(part, lens);
    camera.camera_from_world = matrices.camera_from_world;
    camera.ndc_from_world = matrices.ndc_from_world;
    camera.matrices_found = std::move(matrices.found);
    camera.matrices_fault = std::move(matrices.fault);
    if (const auto widths = widths_beside_lens(camera, known))
        set_by_angle(*widths, "the header's projection", known, camera);
    const auto jitter = metadata.value("aftershade/jitter_px");
    if (const auto* px = jitter ? std::get_if<std::vector<float>>(&*jitter) : nullptr; px && px->size() == 2)
        camera.jitter_px = {double((*px)[0]), double((*px)[1])};
    return camera;
}

std::vector<std::string> camera_faults(const ExrPart& part, const Profile& profile, const Camera& known) {
    const ExrMetadata& metadata = part.metadata;
    const std::vector<FieldSource> sources = sources_of_fields(metadata, profile);
    std::vector<std::string> faults;
    for (const auto& [field, attribute, value] : sources) {
        if (!metadata.value(attribute) || known.get(field)) continue;
        const auto number = metadata.number(attribute);
        const bool is_signed = find_camera_field(field)->min < 0;
        if (number && !std::isnan(*number) && (is_signed || *number >= 0)) continue;
        faults.push_back("attribute " + attribute +
                         (number && !std::isnan(*number) ? " is below 0" : " is not a number") +
                         ", so it does not give the camera's " + field + " (set \"" + field +
                         "\" in capture.json's camera)");
    }
    // Where an angle of view says how wide the film is, other attributes may name the whole film.
    if (!profile.field_of_view) find_other_values(sources, known, faults);
    Camera lens = known;
    Camera camera = lens_of_metadata(metadata, profile, known);
    lens.complete_from(camera);
    const StoredMatrices matrices = read_matrices(part, lens);
    if (!matrices.contradiction.empty())
        faults.push_back(matrices.contradiction +
                         ", so it is not used (have the renderer write the camera's)");
    camera.camera_from_world = matrices.camera_from_world;
    camera.ndc_from_world = matrices.ndc_from_world;
    if (const auto widths = widths_beside_lens(camera, known))
        faults.push_back("the lens, focal_length " + format_number(*lens.get("focal_length")) +
                         " mm and sensor_width " + format_number(*lens.get("sensor_width")) + " mm, shows " +
                         degrees_of(*lens.get("sensor_width") / *lens.get("focal_length")) +
                         " degrees, and the header's projection " + degrees_of(*widths) +
                         ", which is taken (set \"focal_length\" and \"sensor_width\" in capture.json's "
                         "camera)");
    return faults;
}

void add_attributes(const Camera& camera, const std::vector<CaptureLight>& lights,
                    std::map<std::string, ExrValue>& attributes) {
    for (const auto& [field, value] : camera.values())
        attributes["aftershade/camera/" + field] = float(value);
    if (!camera.lens_model.empty()) attributes["aftershade/camera/lens_model"] = camera.lens_model;
    const auto add = [&](const char* field, const char* attribute) {
        if (const auto value = camera.get(field)) attributes[attribute] = float(*value);
    };
    add("focus_distance", "focus");
    add("f_number", "aperture");
    add("focal_length", "nominalFocalLength");
    add_matrices(camera, attributes);
    if (camera.jitter_px)
        attributes["aftershade/jitter_px"] =
            std::vector<float>{float((*camera.jitter_px)[0]), float((*camera.jitter_px)[1])};
    if (!lights.empty()) attributes["aftershade/lights"] = format_lights(lights);
}

std::vector<CaptureLight> lights_of_metadata(const ExrMetadata& metadata, const std::filesystem::path& path) {
    const std::string name = "aftershade/lights";
    const auto text = metadata.text(name);
    const auto names = metadata.names();
    if (!text && std::find(names.begin(), names.end(), name) != names.end())
        throw Error(ErrorKind::capture, path.string() + ": attribute " + name + " is not a text");
    if (!text) return {};
    Diagnostics diagnostics;
    std::vector<CaptureLight> lights;
    if (const auto node = parse_document(*text, name, diagnostics)) lights = parse_lights(*node, diagnostics);
    if (!diagnostics.has_errors()) return lights;
    const Diagnostic& fault = diagnostics.all().front();
    throw Error(ErrorKind::capture,
                path.string() + ": attribute " + to_string(fault.place) + ": " + fault.message);
}

}  // namespace aftershade
