// Lights of a capture, for effects that need them: capture.json's "lights", or the attribute
// aftershade/lights.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"

namespace aftershade::grammar {
class Reader;
}

namespace aftershade {

struct CaptureLight {
    enum class Kind { point, directional, area };

    Kind kind = Kind::point;
    std::string name;
    std::array<double, 3> position_m{};  ///< world; of an area light its centre; not of a directional one
    std::array<double, 3> direction{};   ///< unit length, the way the light shines; not of a point
    std::array<double, 2> size_m{};      ///< of an area light
    std::array<double, 3> intensity{};   ///< RGB: W/sr of a point, W/m^2 across a directional light,
                                         ///< W/(m^2 sr) of an area light
    bool operator==(const CaptureLight&) const = default;
};

/// "point", "directional", "area": in the order of CaptureLight::Kind, which is that of the grammar's kinds.
const std::vector<std::string>& light_kind_names();

/// An entry of "lights" of a capture.json, which has been checked.
CaptureLight read_light(const grammar::Reader& reader);
/// Checks and reads an array of such objects.
std::vector<CaptureLight> parse_lights(const Node& node, Diagnostics& diagnostics);
/// One line of JSON that parse_lights reads back as it was.
std::string format_lights(const std::vector<CaptureLight>& lights);

}  // namespace aftershade
