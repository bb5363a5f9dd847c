#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "framework/core/units.h"
#include "framework/scene/fields.h"

namespace aftershade::scene {

const Field& Block::field(const std::string& wanted) const {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.spec.name == wanted; });
    assert(found != fields.end());
    return *found;
}

const Block* find_block(std::span<const Block> blocks, const std::string& name) {
    const auto found =
        std::find_if(blocks.begin(), blocks.end(), [&](const Block& block) { return block.name == name; });
    return found == blocks.end() ? nullptr : &*found;
}

const std::vector<std::string>& interpolation_names() {
    static const std::vector<std::string> names = {"linear", "step", "smooth"};
    return names;
}

std::optional<std::vector<double>> FieldReader::read_numbers(const Field& field, const Node& node) {
    const std::string label = label_ + field.spec.name;
    if (field.uniform && !node.is_array()) {
        ParamSpec scalar = field.spec;
        scalar.type = ParamType::float_;
        const auto value = parse_param_value(scalar, node, label, diagnostics_);
        if (!value) return std::nullopt;
        return std::vector<double>(std::size_t(component_count(field.spec.type)), std::get<double>(*value));
    }
    const auto value = parse_param_value(field.spec, node, label, diagnostics_);
    if (!value) return std::nullopt;
    return numbers_of(field.spec, *value);
}

std::optional<std::vector<double>> FieldReader::read_value(const Field& field, const Node& node) {
    const auto values = read_numbers(field, node);
    if (!values) return std::nullopt;
    const auto fault = [&](const std::string& text) {
        diagnostics_.error(node.place, label_ + field.spec.name + ": " + text);
        return std::nullopt;
    };
    for (const double value : *values) {
        if (field.whole && value != std::floor(value))
            return fault(format_number(value) + " is not a whole number");
        if (std::find(field.never.begin(), field.never.end(), value) != field.never.end())
            return fault(format_number(value) + " has no meaning. " + field.spec.doc);
    }
    if (field.has_length && std::inner_product(values->begin(), values->end(), values->begin(), 0.0) == 0)
        return fault("has no length");
    return values;
}

std::optional<glm::dvec3> FieldReader::vec3(const Field& field, const Node& node) {
    const auto values = read_value(field, node);
    if (!values) return std::nullopt;
    return glm::dvec3((*values)[0], (*values)[1], (*values)[2]);
}

FieldReader::Keys FieldReader::read_keys(const Field& field, const Node& node) {
    Keys keys;
    ObjectReader reader(node, "the value of " + field.spec.name, diagnostics_);
    std::vector<std::pair<double, std::vector<double>>> found;
    if (const Node* members = reader.object("keys", ObjectReader::Presence::required)) {
        for (const Member& member : members->members) {
            const auto frame = parse_number(member.key);
            if (!frame) {
                diagnostics_.error(
                    member.key_place,
                    "a key is a frame number such as \"12\" or \"1.5\", not '" + member.key + "'");
                continue;
            }
            if (const auto value = read_value(field, member.value)) found.emplace_back(*frame, *value);
        }
        if (members->members.empty()) diagnostics_.error(members->place, "there is no key");
    }
    if (const auto name = reader.choice("interpolation", interpolation_names()))
        keys.interpolation = *name == "step"     ? Interpolation::step
                             : *name == "smooth" ? Interpolation::smooth
                                                 : Interpolation::linear;
    reader.finish();
    std::sort(found.begin(), found.end());
    for (std::size_t i = 1; i < found.size(); ++i)
        if (found[i].first == found[i - 1].first)
            diagnostics_.error(node.place, "frame " + format_number(found[i].first) + " has two keys");
    for (auto& [frame, value] : found) {
        keys.frames.push_back(frame);
        keys.values.push_back(std::move(value));
    }
    return keys;
}

FieldReader::Keys FieldReader::read(const Block& block, const std::string& name) {
    const Field& field = block.field(name);
    const auto presence =
        field.required ? ObjectReader::Presence::required : ObjectReader::Presence::optional;
    const Keys fallback{{0}, {numbers_of(field.spec, field.spec.default_value)}, Interpolation::linear};
    const Node* node = reader_.any(name, presence);
    if (!node) return fallback;
    if (field.animated && node->is_object()) {
        Keys keys = read_keys(field, *node);
        return keys.frames.empty() ? fallback : keys;
    }
    if (node->is_object()) {
        diagnostics_.error(node->place, label_ + name + " does not take keys: it is the same in every frame");
        return fallback;
    }
    const auto value = read_value(field, *node);
    return value ? Keys{{0}, {*value}, Interpolation::linear} : fallback;
}

Animated<double> FieldReader::animated_number(const Block& block, const std::string& name) {
    const Keys keys = read(block, name);
    std::vector<Animated<double>::Key> result;
    for (std::size_t i = 0; i < keys.frames.size(); ++i)
        result.push_back({keys.frames[i], keys.values[i][0]});
    return {std::move(result), keys.interpolation};
}

Animated<glm::dvec3> FieldReader::animated_vec3(const Block& block, const std::string& name) {
    const Keys keys = read(block, name);
    std::vector<Animated<glm::dvec3>::Key> result;
    for (std::size_t i = 0; i < keys.frames.size(); ++i)
        result.push_back({keys.frames[i], {keys.values[i][0], keys.values[i][1], keys.values[i][2]}});
    return {std::move(result), keys.interpolation};
}

glm::dvec2 FieldReader::vec2(const Block& block, const std::string& name) {
    const Keys keys = read(block, name);
    return {keys.values[0][0], keys.values[0][1]};
}

bool FieldReader::flag(const Block& block, const std::string& name) {
    return number(block, name) != 0;
}

std::string FieldReader::choice(const Block& block, const std::string& name) {
    return block.field(name).spec.values[std::size_t(number(block, name))];
}

}  // namespace aftershade::scene
