// A name that no manifest can list: of an OpenColorIO config, or one that native code looks up.
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace text_type {

class TextType final : public AbstractParamType {
public:
    constexpr TextType() : AbstractParamType({.name = "text", .home = ParamHome::host}) {}

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        declaration.keys.push_back(grammar::optional(
            "ocio", grammar::choice({"display", "view", "looks", "source", "destination", "correction"}),
            "The part of the effect's OpenColorIO transform that it says; none for native code to read."));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        if (const Node* const part = reader.node.find("ocio")) spec.ocio = part->string;
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        if (!node.is_string()) return reader.wrong_kind(node, "text, or \"\"");
        return node.string;
    }

    schema::json literal_schema(const ParamSpec&, const schema::LiteralParts&) const override {
        return schema::text();
    }

    std::string type_text(const ParamSpec& spec) const override {
        return spec.ocio.empty() ? "text" : "name in the OpenColorIO config";
    }

    schema::json describe(const ParamSpec& spec) const override {
        return spec.ocio.empty() ? schema::json::object() : schema::json{{"ocio", spec.ocio}};
    }
};

constexpr TextType kType;

}  // namespace text_type

constinit const ParamType ParamType::text{text_type::kType};

}  // namespace aftershade
