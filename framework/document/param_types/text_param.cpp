// A name that no manifest can list: of an OpenColorIO config, or one that native code looks up.
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace text_type {

void declare(grammar::Block& declaration, const grammar::Block&) {
    declaration.keys.push_back(grammar::optional(
        "ocio", grammar::choice({"display", "view", "looks", "source", "destination", "correction"}),
        "The part of the effect's OpenColorIO transform that it says; none for native code to read."));
}

void read_declaration(const SpecReader& reader, ParamSpec& spec) {
    if (const Node* const part = reader.node.find("ocio")) spec.ocio = part->string;
}

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    if (!node.is_string()) return reader.wrong_kind(node, "text, or \"\"");
    return node.string;
}

schema::json literal(const ParamSpec&, const schema::LiteralParts&) {
    return schema::text();
}

std::string type_text(const ParamSpec& spec) {
    return spec.ocio.empty() ? "text" : "name in the OpenColorIO config";
}

schema::json describe(const ParamSpec& spec) {
    return spec.ocio.empty() ? schema::json::object() : schema::json{{"ocio", spec.ocio}};
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
