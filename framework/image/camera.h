// What is known of a capture's lens and sensor.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/document.h"

namespace aftershade {

/// A value that a camera may have, named as parameters' "from" names it.
struct CameraField {
    std::string name;  ///< "focus_distance"
    std::string unit;  ///< "" for a pure number
    double min = 0;
};

const std::vector<CameraField>& camera_fields();
const CameraField* find_camera_field(const std::string& name);

/// Values by field name, in the field's unit; a field that is absent is not known.
class Camera {
public:
    std::optional<double> get(const std::string& name) const;
    void set(const std::string& name, double value) { values_[name] = value; }
    /// Fills what is not known here from `other`.
    void complete_from(const Camera& other) { values_.insert(other.values_.begin(), other.values_.end()); }

private:
    std::map<std::string, double> values_;
};

/// Reads "camera": {"focal_length": "50 mm", ...}: numbers in the field's unit, or strings with a unit.
Camera parse_camera(const Node& node, Diagnostics& diagnostics);

}  // namespace aftershade
