// Between the API's values and those of documents.
#include <cmath>
#include <utility>

#include "framework/document/param_type.h"
#include "framework/host/failures.h"
#include "framework/host/look_data.h"

namespace aftershade::host {

namespace {

Node node_of_kind(Node::Kind kind, const std::string& name) {
    Node node;
    node.kind = kind;
    node.place.file = name;
    return node;
}

class NodeMaker {
public:
    NodeMaker(const std::string& name, Diagnostics& faults) : name_(name), faults_(faults) {}

    std::optional<Node> operator()(bool value) const {
        Node node = node_of_kind(Node::Kind::boolean, name_);
        node.boolean = value;
        return node;
    }
    std::optional<Node> operator()(std::int64_t value) const {
        Node node = node_of_kind(Node::Kind::integer, name_);
        node.integer = value;
        node.number = double(value);
        return node;
    }
    std::optional<Node> operator()(double value) const {
        if (!std::isfinite(value)) {
            faults_.error({name_}, name_ + ": the number is not finite");
            return std::nullopt;
        }
        Node node = node_of_kind(Node::Kind::number, name_);
        node.number = value;
        return node;
    }
    std::optional<Node> operator()(const std::string& value) const {
        Node node = node_of_kind(Node::Kind::string, name_);
        node.string = value;
        return node;
    }
    std::optional<Node> operator()(const std::vector<double>& values) const {
        Node node = node_of_kind(Node::Kind::array, name_);
        for (const double value : values) {
            auto item = (*this)(value);
            if (!item) return std::nullopt;
            node.items.push_back(std::move(*item));
        }
        return node;
    }
    std::optional<Node> operator()(const Json& value) const {
        if (!parse_document(value.text, name_, faults_)) return std::nullopt;
        // Whole, at the place of the call: a line of this text would be taken for a line of a file.
        return parse_command_value(value.text, {name_});
    }

private:
    const std::string& name_;
    Diagnostics& faults_;
};

}  // namespace

std::optional<Node> node_of(const Value& value, const std::string& name, Diagnostics& faults) {
    return std::visit(NodeMaker(name, faults), value);
}

Value value_of(const ParamSpec& spec, const ParamValue& value) {
    if (const auto* boolean = std::get_if<bool>(&value)) return *boolean;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return *integer;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return *numbers;
    return Json{format_value(spec, value)};
}

Value value_of(const ParamSpec& spec, const ValueSource& source) {
    if (const auto* value = std::get_if<ParamValue>(&source)) return value_of(spec, *value);
    return Json{format_source(source)};
}

ParamInfo info_of(const ParamSpec& spec) {
    ParamInfo info;
    info.name = spec.name;
    info.type = param_type_name(spec.type);
    info.unit = spec.unit;
    info.doc = spec.doc;
    if (spec.type->has_default) info.default_value = value_of(spec, spec.default_value);
    info.min = spec.min;
    info.max = spec.max;
    info.ui_range = spec.ui_range;
    info.values = spec.values;
    info.from = spec.from;
    if (spec.identity) info.identity = value_of(spec, *spec.identity);
    if (spec.type->has_columns)
        for (const ParamSpec& column : spec.columns) info.columns.push_back(info_of(column));
    return info;
}

}  // namespace aftershade::host
