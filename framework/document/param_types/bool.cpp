#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace bool_type {

void declare(grammar::Block& declaration, const grammar::Block&) {
    declaration.keys.push_back(
        grammar::optional("ocio", grammar::choice({"inverse"}),
                          "The part of the effect's OpenColorIO transform that it says."));
}

void read_declaration(const SpecReader& reader, ParamSpec& spec) {
    if (const Node* const part = reader.node.find("ocio")) spec.ocio = part->string;
}

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    if (node.kind != Node::Kind::boolean) return reader.wrong_kind(node, "true or false");
    return node.boolean;
}

schema::json literal(const ParamSpec&, const schema::LiteralParts&) {
    return {{"type", "boolean"}};
}

std::vector<double> numbers(const ParamSpec&, const ParamValue& value) {
    return {std::get<bool>(value) ? 1.0 : 0.0};
}

ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) {
    return numbers.at(0) != 0;
}

std::vector<SweepValue> sweep(const ParamSpec&) {
    return {{"false", false}, {"true", true}};
}

constexpr ParamTypeTraits type() {
    ParamTypeTraits traits;
    traits.name = "bool";
    traits.glsl_type = "bool";
    traits.is_integer = true;
    traits.declare = declare;
    traits.read_declaration = read_declaration;
    traits.parse = parse;
    traits.schema = literal;
    traits.numbers = numbers;
    traits.of_numbers = of_numbers;
    traits.sweep = sweep;
    return traits;
}

}  // namespace bool_type

constinit const ParamTypeTraits kBoolParam = bool_type::type();

}  // namespace aftershade
