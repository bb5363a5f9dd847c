#include "framework/effect/isf/isf_params.h"

#include <algorithm>

#include "framework/effect/isf/isf_formula.h"
#include "framework/effect/isf/isf_nodes.h"

namespace aftershade {

namespace {

using Type = IsfInput::Type;

std::string doc_of(const IsfInput& input) {
    const std::string name = input.label.empty() ? input.name : input.label;
    if (input.type == Type::event) return name + ": an event, true in the frames where it happens.";
    if (input.type == Type::audio)
        return name + ": sound as a picture, samples or frequencies from left to right; silence by default.";
    if (input.type == Type::color) return name + ": red, green, blue and straight alpha, 0 to 1.";
    if (input.type == Type::point) return name + ": x to the right and y up, from the lower left corner.";
    return name + ".";
}

/// An enum shows its labels; a formula needs the number itself.
bool is_enum(const IsfFile& file, const IsfInput& input) {
    return input.type == Type::choice && input.values.size() > 1 && !is_in_a_formula(file, input.name);
}

std::size_t index_of(const IsfInput& input, const std::optional<Node>& value) {
    const auto found = value ? std::ranges::find(input.values, int(value->number)) : input.values.end();
    return found == input.values.end() ? 0 : std::size_t(found - input.values.begin());
}

/// The components of a value, or as many zeros.
std::vector<double> numbers_of(const std::optional<Node>& value, std::size_t count) {
    std::vector<double> numbers;
    if (value && value->is_array())
        for (const Node& item : value->items) numbers.push_back(item.number);
    else if (value) numbers.push_back(value->number);
    numbers.resize(count, 0.0);
    return numbers;
}

Node node_of(const Place& place, const std::vector<double>& numbers, bool is_integer) {
    std::vector<Node> items;
    for (const double number : numbers)
        items.push_back(number_node(place, is_integer ? double(int(number)) : number));
    return items.size() == 1 ? items.front() : list_node(place, std::move(items));
}

/// Hosts take a DEFAULT outside of MIN and MAX, so that these give way.
void add_numbers(const IsfInput& input, std::size_t count, Node& param) {
    const bool is_integer = input.type == Type::choice;
    std::vector<double> value = numbers_of(input.default_value, count);
    const auto limit = [&](const std::optional<Node>& written, bool is_min) -> std::optional<double> {
        if (!written) return std::nullopt;
        const std::vector<double> limits = numbers_of(written, count);
        return is_min ? std::ranges::min(limits) : std::ranges::max(limits);
    };
    std::optional<double> min = limit(input.min, true), max = limit(input.max, false);
    if (min && max && *min > *max) std::swap(min, max);
    if (!input.default_value)
        for (double& number : value)
            number = std::max(min.value_or(number), std::min(max.value_or(number), number));
    if (min) min = std::min(*min, std::ranges::min(value));
    if (max) max = std::max(*max, std::ranges::max(value));
    if (is_integer && !min && !max && !input.values.empty()) {
        min = std::min(std::ranges::min(input.values), int(value[0]));
        max = std::max(std::ranges::max(input.values), int(value[0]));
    }
    add_member(param, "default", node_of(input.place, value, is_integer));
    if (min) add_member(param, "min", number_node(input.place, is_integer ? double(int(*min)) : *min));
    if (max) add_member(param, "max", number_node(input.place, is_integer ? double(int(*max)) : *max));
    if (!min && !max && input.type == Type::number)
        add_member(param, "ui",
                   list_node(input.place, {number_node(input.place, 0), number_node(input.place, 1)}));
    if (!input.identity) return;
    const std::vector<double> identity = numbers_of(input.identity, count);
    if ((!min || std::ranges::min(identity) >= *min) && (!max || std::ranges::max(identity) <= *max))
        add_member(param, "identity", node_of(input.place, identity, is_integer));
}

}  // namespace

Node param_of_input(const IsfFile& file, const IsfInput& input) {
    const Place& at = input.place;
    const auto text = [&](const char* value) { return text_node(at, value); };
    Node param = object_node(at);
    switch (input.type) {
        case Type::number:
            add_member(param, "type", text("float"));
            add_numbers(input, 1, param);
            break;
        case Type::color:
            add_member(param, "type", text("vec4"));
            add_numbers(input, 4, param);
            break;
        case Type::point:
            add_member(param, "type", text("vec2"));
            add_numbers(input, 2, param);
            break;
        case Type::boolean:
        case Type::event:
            add_member(param, "type", text("bool"));
            add_member(param, "default",
                       bool_node(at, input.type == Type::boolean && input.default_value &&
                                         input.default_value->boolean));
            if (input.identity) add_member(param, "identity", bool_node(at, input.identity->boolean));
            break;
        case Type::choice:
            if (is_enum(file, input)) {
                const std::vector<std::string> names = names_of_labels(input.labels);
                std::vector<Node> values;
                for (const std::string& name : names) values.push_back(text_node(at, name));
                add_member(param, "type", text("enum"));
                add_member(param, "values", list_node(at, std::move(values)));
                std::vector<Node> numbers;
                for (const int value : input.values) numbers.push_back(number_node(at, value));
                add_member(param, "numbers", list_node(at, std::move(numbers)));
                add_member(param, "default", text_node(at, names[index_of(input, input.default_value)]));
                if (input.identity)
                    add_member(param, "identity", text_node(at, names[index_of(input, input.identity)]));
            } else {
                add_member(param, "type", text("int"));
                add_numbers(input, 1, param);
            }
            break;
        case Type::image:
        case Type::audio:
            add_member(param, "type", text("file"));
            add_member(param, "kind", text("image"));
            add_member(param, "space", text("data"));
            add_member(param, "filter", text("linear"));
            add_member(param, "default", text(""));
            break;
    }
    add_member(param, "doc", text_node(at, doc_of(input)));
    return param;
}

Node param_of_import(const IsfImport& import) {
    const auto text = [&](std::string value) { return text_node(import.place, std::move(value)); };
    return object_node(import.place, {{"type", text("file")},
                                      {"kind", text("image")},
                                      {"space", text("data")},
                                      {"filter", text("linear")},
                                      {"default", text(import.path)},
                                      {"doc", text(import.label + ": a picture of the filter's own.")}});
}

std::string global_of_input(const IsfFile& file, const IsfInput& input, const std::string& param,
                            const std::string& glsl_name) {
    const std::string value = "param." + param;
    switch (input.type) {
        case Type::number: return "float " + glsl_name + " = " + value + ";\n";
        case Type::boolean:
        case Type::event: return "bool " + glsl_name + " = " + value + ";\n";
        case Type::color: return "vec4 " + glsl_name + " = " + value + ";\n";
        case Type::point: return "vec2 " + glsl_name + " = " + value + ";\n";
        case Type::image:
        case Type::audio: return "";
        case Type::choice: break;
    }
    if (!is_enum(file, input)) return "int " + glsl_name + " = " + value + ";\n";
    std::string values;
    bool are_indices = true;
    for (std::size_t i = 0; i < input.values.size(); ++i) {
        values += (i > 0 ? ", " : "") + std::to_string(input.values[i]);
        are_indices &= input.values[i] == int(i);
    }
    return "int " + glsl_name + " = " + (are_indices ? value : "int[](" + values + ")[" + value + "]") +
           ";\n";
}

}  // namespace aftershade
