// The known values of a capture's camera: lens, sensor and position.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/document/document.h"
#include "framework/document/param.h"

namespace aftershade::grammar {
class Reader;
}

namespace aftershade {

/// A number that a camera may have, named as parameters' "from" names it.
struct CameraField {
    std::string name;  ///< "focus_distance"
    std::string unit;  ///< "" for a pure number
    double min = 0;
    std::string doc;
};

const std::vector<CameraField>& camera_fields();
const CameraField* find_camera_field(const std::string& name);

/// Before the name of a field where parameters say what they are "from": "camera.focus_distance".
inline constexpr std::string_view kFromCamera = "camera.";
/// Allowed values of "from" for a parameter of this type: the lens model for an enum, the fields for every
/// other type.
std::vector<std::string> camera_sources(ParamType type);
/// Whether the field's numbers convert to the parameter's unit.
bool converts_to(const CameraField& field, const ParamSpec& spec);
/// For a `source` that is not among `known`: what an error says of it.
std::string unknown_source(const std::string& source, const std::vector<std::string>& known);
/// "thin", "pinhole".
const std::vector<std::string>& lens_model_names();

/// Row by row, acting on column vectors: clip = matrix * world.
using CameraMatrix = std::array<double, 16>;

/// Numbers by field name, in the field's unit; a field that is absent is not known.
class Camera {
public:
    std::optional<double> get(const std::string& name) const;
    /// `origin` names the source of the value, for `run --explain`: "capture.json", "attribute focus".
    void set(const std::string& name, double value, const std::string& origin = "") {
        values_[name] = value;
        origins_[name] = origin;
    }
    /// Origin of a known field, or of "lens_model".
    std::string origin(const std::string& name) const;
    void set_lens_model(const std::string& name, const std::string& origin);
    const std::map<std::string, double>& values() const { return values_; }
    /// Fills what is not known here from `other`.
    void complete_from(const Camera& other);

    std::string lens_model;                         ///< "thin" or "pinhole"; "" where not known
    std::optional<CameraMatrix> camera_from_world;  ///< view space: right-handed, looks along -z, y up, m
    std::optional<CameraMatrix>
        ndc_from_world;          ///< projective; x right and y up from -1 to 1 over the display window
    std::string matrices_found;  ///< conventions that the header's matrices were read by; for people
    std::string matrices_fault;  ///< why a matrix of the header was not taken; "" where each was
    /// The samples' offset from the pixels' centres, px, +y down; contained neither in velocity nor in the
    /// matrices.
    std::optional<std::array<double, 2>> jitter_px;

private:
    std::map<std::string, double> values_;
    std::map<std::string, std::string> origins_;
};

/// "camera" of a capture.json, which has been checked.
Camera read_camera(const grammar::Reader& reader);

}  // namespace aftershade
