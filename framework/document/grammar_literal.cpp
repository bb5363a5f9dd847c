// Values of parameters' types: numbers with units, vectors, and both by frame.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "framework/document/grammar_form.h"
#include "framework/document/units.h"

namespace aftershade::grammar {

using schema::json;

namespace {

/// As parse_number() reads them.
constexpr const char* kFrameNumber = R"(^[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$)";

class Literal : public FormType {
public:
    Literal(ParamSpec spec, LiteralForms forms) : spec_(std::move(spec)), forms_(std::move(forms)) {}

    bool takes(Node::Kind kind) const override {
        if (kind == Node::Kind::object) return forms_.animated || !is_block_type(spec_.type);
        if (kind == Node::Kind::boolean) return spec_.type == ParamType::bool_;
        const bool vector = is_block_type(spec_.type) && component_count(spec_.type) > 1;
        if (kind == Node::Kind::array) return vector || !is_block_type(spec_.type);
        return kind != Node::Kind::null && (!vector || forms_.uniform);
    }

    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (is_block_type(spec_.type)) read(node, spot.path, diagnostics);
        else parse_param_value(spec_, node, spot.path, diagnostics);
    }

    json schema(SchemaScope& scope) const override {
        std::vector<json> forms = literals(scope.variables);
        if (forms_.animated) forms.push_back(by_frame(forms));
        return forms.size() == 1 ? forms[0] : schema::any_of(std::move(forms));
    }

    Words words() const override {
        std::string type{param_type_name(spec_.type)};
        for (std::size_t i = 0; i < spec_.values.size(); ++i) type += (i ? ", " : ": ") + spec_.values[i];
        if (forms_.whole) type += " of whole numbers";
        if (forms_.uniform) type += ", or one number";
        return {.type = type,
                .unit = spec_.unit,
                .range = range_text(spec_),
                .animated = forms_.animated,
                .noun = "a value of type " + std::string(param_type_name(spec_.type)),
                .nouns = "values of type " + std::string(param_type_name(spec_.type))};
    }

    std::optional<Keyed> keyed(const Node& node) const override {
        if (!is_block_type(spec_.type)) return std::nullopt;
        Diagnostics faults;
        return read(node, "", faults);
    }

    std::optional<ParamValue> value(const Node& node) const override {
        Diagnostics faults;
        return parse_param_value(spec_, node, "", faults);
    }

    std::vector<std::string> choices() const override { return spec_.values; }

private:
    /// A value that is the same in every frame, or one key's.
    std::vector<json> literals(schema::Variables variables) const {
        json one = schema::literal(spec_, variables);
        if (forms_.whole) one["items"]["type"] = "integer";
        if (!forms_.never.empty()) one["not"] = {{"enum", forms_.never}};
        if (forms_.has_length)
            one["not"] = {{"const", std::vector<int>(std::size_t(component_count(spec_.type)), 0)}};
        std::vector<json> forms = {std::move(one)};
        if (forms_.uniform) forms.push_back(schema::quantity(spec_));
        return forms;
    }

    static json by_frame(const std::vector<json>& literals) {
        const json keys = {{"type", "object"},
                           {"patternProperties",
                            {{kFrameNumber, literals.size() == 1 ? literals[0] : schema::any_of(literals)}}},
                           {"additionalProperties", false},
                           {"minProperties", 1}};
        return schema::object({{"keys", keys}, {"interpolation", schema::one_of(interpolation_names())}},
                              {"keys"});
    }

    std::optional<std::vector<double>> numbers(const Node& node, const std::string& label,
                                               Diagnostics& diagnostics) const {
        const std::size_t count = std::size_t(component_count(spec_.type));
        if (forms_.uniform && !node.is_array()) {
            ParamSpec scalar = spec_;
            scalar.type = ParamType::float_;
            const auto value = parse_param_value(scalar, node, label, diagnostics);
            if (!value) return std::nullopt;
            return std::vector<double>(count, std::get<double>(*value));
        }
        if (forms_.uniform && node.items.size() != count) {
            diagnostics.error(node.place, label + ": expected an array of " + std::to_string(count) +
                                              " numbers, or one number for all");
            return std::nullopt;
        }
        const auto value = parse_param_value(spec_, node, label, diagnostics);
        if (!value) return std::nullopt;
        return numbers_of(spec_, *value);
    }

    std::optional<std::vector<double>> constant(const Node& node, const std::string& label,
                                                Diagnostics& diagnostics) const {
        const auto values = numbers(node, label, diagnostics);
        if (!values) return std::nullopt;
        const auto fault = [&](const std::string& text) {
            diagnostics.error(node.place, label + ": " + text);
            return std::nullopt;
        };
        for (const double value : *values) {
            if (forms_.whole && value != std::floor(value))
                return fault(format_number(value) + " is not a whole number");
            if (std::find(forms_.never.begin(), forms_.never.end(), value) != forms_.never.end())
                return fault(format_number(value) + " has no meaning. " + spec_.doc);
        }
        if (forms_.has_length &&
            std::inner_product(values->begin(), values->end(), values->begin(), 0.0) == 0)
            return fault("has no length");
        return values;
    }

    std::optional<Keyed> keys(const Node& node, const std::string& label, Diagnostics& diagnostics) const {
        ObjectReader reader(node, "the value of " + spec_.name, diagnostics);
        std::vector<std::pair<double, std::vector<double>>> found;
        if (const Node* members = reader.object("keys", ObjectReader::Presence::required)) {
            for (const Member& member : members->members) {
                const auto frame = parse_number(member.key);
                if (!frame) {
                    diagnostics.error(
                        member.key_place,
                        "a key is a frame number such as \"12\" or \"1.5\", not '" + member.key + "'");
                    continue;
                }
                if (const auto one = constant(member.value, label, diagnostics))
                    found.emplace_back(*frame, *one);
            }
            if (members->members.empty()) diagnostics.error(members->place, "there is no key");
        }
        Keyed result;
        const auto& names = interpolation_names();
        if (const auto name = reader.choice("interpolation", names))
            result.interpolation = std::size_t(std::find(names.begin(), names.end(), *name) - names.begin());
        reader.finish();
        std::sort(found.begin(), found.end());
        for (std::size_t i = 1; i < found.size(); ++i)
            if (found[i].first == found[i - 1].first)
                diagnostics.error(node.place, "frame " + format_number(found[i].first) + " has two keys");
        for (auto& [frame, values] : found) {
            result.frames.push_back(frame);
            result.values.push_back(std::move(values));
        }
        return result;
    }

    /// nullopt after a fault.
    std::optional<Keyed> read(const Node& node, const std::string& label, Diagnostics& diagnostics) const {
        const int errors_before = diagnostics.error_count();
        std::optional<Keyed> result;
        if (forms_.animated && node.is_object()) {
            result = keys(node, label, diagnostics);
        } else if (forms_.still && node.is_object()) {
            diagnostics.error(node.place, label + " does not take keys: it is the same in every frame");
        } else if (const auto values = constant(node, label, diagnostics)) {
            result = Keyed{{0}, {*values}, 0};
        }
        return diagnostics.error_count() > errors_before ? std::nullopt : result;
    }

    ParamSpec spec_;
    LiteralForms forms_;
};

}  // namespace

const std::vector<std::string>& interpolation_names() {
    static const std::vector<std::string> names = {"linear", "step", "smooth"};
    return names;
}

Form literal(ParamSpec spec, LiteralForms forms) {
    return make_form<Literal>(std::move(spec), std::move(forms));
}

Key field(const ParamSpec& spec, LiteralForms forms, bool is_required) {
    Key key = optional(spec.name, literal(spec, std::move(forms)), spec.doc,
                       format_value(spec, spec.default_value));
    key.required = is_required;
    return key;
}

}  // namespace aftershade::grammar
