// A word that the host reads: a name in an OpenColorIO config, which no manifest can list.
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace text_type {

void declare(grammar::Block& declaration, const grammar::Block&) {
    declaration.keys.push_back(grammar::required(
        "ocio", grammar::choice({"display", "view", "looks", "source", "destination", "correction"}),
        "The part of the effect's OpenColorIO transform that it says."));
}

void read_declaration(const SpecReader& reader, ParamSpec& spec) {
    spec.ocio = reader.node.find("ocio")->string;
}

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    if (!node.is_string()) return reader.wrong_kind(node, "a name of the OpenColorIO config, or \"\"");
    return node.string;
}

schema::json literal(const ParamSpec&, const schema::LiteralParts&) {
    return schema::text();
}

std::string type_text(const ParamSpec&) {
    return "name in the OpenColorIO config";
}

schema::json describe(const ParamSpec& spec) {
    return {{"ocio", spec.ocio}};
}

constexpr ParamTypeTraits type() {
    ParamTypeTraits traits;
    traits.name = "text";
    traits.home = ParamHome::host;
    traits.declare = declare;
    traits.read_declaration = read_declaration;
    traits.parse = parse;
    traits.schema = literal;
    traits.type_text = type_text;
    traits.describe = describe;
    return traits;
}

}  // namespace text_type

constinit const ParamTypeTraits kTextParam = text_type::type();

}  // namespace aftershade
