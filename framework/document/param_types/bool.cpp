#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace bool_type {

class BoolType final : public AbstractParamType {
public:
    constexpr BoolType() : AbstractParamType({.name = "bool", .glsl_type = "bool", .is_integer = true}) {}

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        declaration.keys.push_back(
            grammar::optional("ocio", grammar::choice({"inverse"}),
                              "The part of the effect's OpenColorIO transform that it says."));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        if (const Node* const part = reader.node.find("ocio")) spec.ocio = part->string;
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        if (node.kind != Node::Kind::boolean) return reader.wrong_kind(node, "true or false");
        return node.boolean;
    }

    schema::json literal_schema(const ParamSpec&, const schema::LiteralParts&) const override {
        return {{"type", "boolean"}};
    }

    std::vector<double> numbers(const ParamSpec&, const ParamValue& value) const override {
        return {std::get<bool>(value) ? 1.0 : 0.0};
    }

    ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) const override {
        return numbers.at(0) != 0;
    }

    std::vector<SweepValue> sweep(const ParamSpec&) const override {
        return {{"false", false}, {"true", true}};
    }
};

constexpr BoolType kType;

}  // namespace bool_type

constinit const ParamType ParamType::bool_{bool_type::kType};

}  // namespace aftershade
