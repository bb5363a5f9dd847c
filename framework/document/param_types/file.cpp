// The path of a file: a picture, a colour table or what OpenColorIO reads. What is in it the host reads.
#include <algorithm>
#include <filesystem>

#include "framework/base/text.h"
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace file_type {

struct KindWords {
    FileKind kind;
    const char* name;  ///< as manifests spell it
    const char* text;  ///< for people
};
constexpr KindWords kKinds[] = {
    {FileKind::image, "image", "file: EXR, PNG or JPEG"},
    {FileKind::lut, "lut", "file: .cube"},
    {FileKind::ocio_config, "ocio_config", "file: OpenColorIO config"},
    {FileKind::ocio_transform, "ocio_transform", "file: transform for OpenColorIO"}};

const KindWords& words_of(const ParamSpec& spec) {
    return *std::ranges::find(kKinds, spec.file_kind, &KindWords::kind);
}

class FileType final : public AbstractParamType {
public:
    constexpr FileType() : AbstractParamType({.name = "file", .home = ParamHome::file}) {}

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        declaration.keys.push_back(
            grammar::required("kind", grammar::choice({"image", "lut", "ocio_config", "ocio_transform"}),
                              "A picture, a table of colours, or a config or a transform of OpenColorIO."));
        declaration.keys.push_back(grammar::optional("space", grammar::choice({"srgb", "data"}),
                                                     "Encoding of a PNG's values.", "\"srgb\""));
        declaration.keys.push_back(grammar::optional("filter", grammar::choice({"nearest", "linear"}),
                                                     "Filter of `texture()` between texels.", "\"nearest\""));
        for (const char* kind : {"\"lut\"", "\"ocio_config\"", "\"ocio_transform\""})
            declaration.rules.push_back(
                grammar::when({.key = "kind",
                               .value = kind,
                               .absent = {"space", "filter"},
                               .fault = "only a file of kind image has a 'space' or a 'filter'"}));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        const std::string& kind_name = reader.node.find("kind")->string;
        for (const KindWords& words : kKinds)
            if (words.name == kind_name) spec.file_kind = words.kind;
        const Node* space = reader.node.find("space");
        spec.file_is_data = space && space->string == "data";
        const Node* filter = reader.node.find("filter");
        spec.file_is_linear = filter && filter->string == "linear";
    }

    /// A manifest's own files lie in its effect's folder.
    bool check_default(const ParamSpec& spec, const Node& node, const std::string& label,
                       Diagnostics& diagnostics) const override {
        const std::filesystem::path path = std::get<std::string>(spec.default_value);
        const std::filesystem::path normal = path.lexically_normal();
        if (path.empty() || (path.is_relative() && *normal.begin() != "..")) return true;
        diagnostics.error(node.place,
                          label + ".default: '" + path.string() + "' must lie in the effect's folder");
        return false;
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        if (!node.is_string()) return reader.wrong_kind(node, "the path of a file, or \"\" for none");
        return node.string;
    }

    schema::json literal_schema(const ParamSpec&, const schema::LiteralParts&) const override {
        return schema::text();
    }

    std::string type_text(const ParamSpec& spec) const override { return words_of(spec).text; }

    std::string default_text(const ParamSpec& spec) const override {
        const auto& path = std::get<std::string>(spec.default_value);
        if (!path.empty()) return json_string(path);
        return spec.file_kind == FileKind::ocio_config ? "the one of $OCIO, else the built-in one" : "none";
    }

    schema::json describe(const ParamSpec& spec) const override { return {{"kind", words_of(spec).name}}; }
};

constexpr FileType kType;

}  // namespace file_type

constinit const ParamType ParamType::file{file_type::kType};

}  // namespace aftershade
