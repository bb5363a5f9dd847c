#include "framework/image/light.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "framework/core/param.h"

namespace aftershade {

namespace {

using Presence = ObjectReader::Presence;

constexpr double kMinSize_m = 1e-6;

/// Numbers of a required key, or zeros after an error.
template <std::size_t N>
std::array<double, N> read_numbers(ObjectReader& reader, const std::string& key, const std::string& unit,
                                   std::optional<double> min, Diagnostics& diagnostics) {
    std::array<double, N> result{};
    const Node* node = reader.any(key, Presence::required);
    if (!node) return result;
    ParamSpec spec;
    spec.name = key;
    spec.type = N == 2 ? ParamType::vec2 : ParamType::vec3;
    spec.unit = unit;
    spec.min = min;
    if (const auto value = parse_param_value(spec, *node, "light." + key, diagnostics)) {
        const auto& numbers = std::get<std::vector<double>>(*value);
        std::copy_n(numbers.begin(), N, result.begin());
    }
    return result;
}

CaptureLight parse_light(const Node& node, Diagnostics& diagnostics) {
    CaptureLight light;
    ObjectReader reader(node, "the light", diagnostics);
    if (!reader.is_object()) return light;
    const auto kind = reader.choice("type", light_kind_names(), Presence::required);
    light.name = reader.text("name").value_or("");
    light.intensity = read_numbers<3>(reader, "intensity", "", 0.0, diagnostics);
    if (kind) {
        light.kind = *kind == "point"  ? CaptureLight::Kind::point
                     : *kind == "area" ? CaptureLight::Kind::area
                                       : CaptureLight::Kind::directional;
        if (light.kind != CaptureLight::Kind::directional)
            light.position_m = read_numbers<3>(reader, "position", "m", {}, diagnostics);
        if (light.kind != CaptureLight::Kind::point) {
            light.direction = read_numbers<3>(reader, "direction", "", {}, diagnostics);
            const auto [x, y, z] = light.direction;
            const double length = std::hypot(x, y, z);
            if (const Node* direction = node.find("direction"); direction && !(length > 0))
                diagnostics.error(direction->place, "light.direction: has no length");
            // One that has unit length already keeps its bits.
            if (std::abs(length - 1) > 1e-12)
                for (double& component : light.direction) component /= length > 0 ? length : 1;
        }
        if (light.kind == CaptureLight::Kind::area)
            light.size_m = read_numbers<2>(reader, "size", "m", kMinSize_m, diagnostics);
    }
    reader.finish();
    return light;
}

}  // namespace

const std::vector<std::string>& light_kind_names() {
    static const std::vector<std::string> names = {"point", "directional", "area"};
    return names;
}

std::vector<CaptureLight> parse_lights(const Node& node, Diagnostics& diagnostics) {
    std::vector<CaptureLight> lights;
    if (!node.is_array())
        diagnostics.error(node.place, "lights are an array, not " + std::string(kind_name(node.kind)));
    for (const Node& item : node.items) lights.push_back(parse_light(item, diagnostics));
    return lights;
}

std::string format_lights(const std::vector<CaptureLight>& lights) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const CaptureLight& light : lights) {
        nlohmann::ordered_json one = {{"type", light_kind_names()[std::size_t(light.kind)]}};
        if (!light.name.empty()) one["name"] = light.name;
        if (light.kind != CaptureLight::Kind::directional) one["position"] = light.position_m;
        if (light.kind != CaptureLight::Kind::point) one["direction"] = light.direction;
        if (light.kind == CaptureLight::Kind::area) one["size"] = light.size_m;
        one["intensity"] = light.intensity;
        list.push_back(std::move(one));
    }
    return list.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace aftershade
