#include "framework/capture/light.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/capture/capture_grammar.h"
#include "framework/document/grammar_reader.h"

namespace aftershade {

namespace {

template <std::size_t N>
std::array<double, N> numbers(const grammar::Reader& reader, std::string_view key) {
    std::array<double, N> result{};
    const std::vector<double> found = reader.components(key);
    std::copy_n(found.begin(), N, result.begin());
    return result;
}

std::array<double, 3> direction_of(const grammar::Reader& reader) {
    auto direction = numbers<3>(reader, "direction");
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    // One that has unit length already keeps its bits.
    if (std::abs(length - 1) > 1e-12)
        for (double& component : direction) component /= length > 0 ? length : 1;
    return direction;
}

}  // namespace

const std::vector<std::string>& light_kind_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> found;
        for (const grammar::Block& kind : capture_light_block().kinds) found.push_back(kind.name);
        return found;
    }();
    return names;
}

CaptureLight read_light(const grammar::Reader& reader) {
    using Kind = CaptureLight::Kind;
    CaptureLight light;
    const auto& kinds = light_kind_names();
    const auto kind = std::find(kinds.begin(), kinds.end(), reader.kind());
    light.name = reader.text("name");
    light.intensity = numbers<3>(reader, "intensity");
    if (kind == kinds.end()) return light;
    light.kind = Kind(kind - kinds.begin());
    if (light.kind != Kind::directional) light.position_m = numbers<3>(reader, "position");
    if (light.kind != Kind::point) light.direction = direction_of(reader);
    if (light.kind == Kind::area) light.size_m = numbers<2>(reader, "size");
    return light;
}

std::vector<CaptureLight> parse_lights(const Node& node, Diagnostics& diagnostics) {
    std::vector<CaptureLight> lights;
    if (!node.is_array())
        diagnostics.error(node.place, "lights are an array, not " + std::string(kind_name(node.kind)));
    for (const Node& item : node.items) {
        grammar::check(item, capture_light_block(), diagnostics);
        lights.push_back(read_light({item, capture_light_block()}));
    }
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
