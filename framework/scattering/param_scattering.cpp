#include "framework/scattering/param_scattering.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "framework/document/glsl_text.h"
#include "framework/document/grammar_form.h"
#include "framework/document/param_type.h"
#include "framework/document/table_keys.h"
#include "framework/scattering/scattering_grammar.h"

namespace aftershade {

namespace {

constexpr const char* kRowKey = "profile";

ParamSpec column(const std::string& name, ParamType type) {
    ParamSpec spec;
    spec.name = name;
    spec.type = type;
    spec.default_value = type == ParamType::int_ ? ParamValue(std::int64_t(0)) : ParamValue(0.0);
    if (type == ParamType::vec3) spec.default_value = std::vector<double>(3, 0.0);
    return spec;
}

TableValue::Row row_of(const ScatteringProfile& profile, std::size_t index) {
    const auto list = [](const Rgb& rgb) { return std::vector<double>(rgb.begin(), rgb.end()); };
    return {{double(index)},
            list(profile.fitted_d_mm()),
            list(profile.direct),
            list(profile.fitted_falloff_mm()),
            {profile.reach_mm()}};
}

const ScatteringValue& content_of(const ParamValue& value) {
    return *scattering_of(value);
}

}  // namespace

bool ScatteringValue::equals(const ValueContent& other) const {
    const auto& its = static_cast<const ScatteringValue&>(other);
    return usual == its.usual && rows == its.rows;
}

std::string ScatteringValue::text() const {
    const std::string profile = format_scattering_profile(usual);
    if (rows.empty()) return profile;
    std::string list;
    for (const auto& [key, own] : rows)
        list += (list.empty() ? "{" : ", {") + format_key(key) +
                ", \"profile\": " + format_scattering_profile(own) + "}";
    return "{\"default\": " + profile + ", \"rows\": [" + list + "]}";
}

const ScatteringValue* scattering_of(const ParamValue& value) {
    const auto* opaque = std::get_if<OpaqueValue>(&value);
    return opaque ? dynamic_cast<const ScatteringValue*>(&opaque->content()) : nullptr;
}

std::vector<ScatteringProfile> scattering_profiles_of(const ScatteringValue& value) {
    std::vector<ScatteringProfile> profiles = {value.usual};
    for (const auto& [key, profile] : value.rows)
        if (std::find(profiles.begin(), profiles.end(), profile) == profiles.end())
            profiles.push_back(profile);
    return profiles;
}

bool is_burley(const ScatteringValue& value) {
    const auto burley = [](const ScatteringProfile& profile) {
        return profile.type == ScatteringProfile::Type::burley;
    };
    const auto profiles = scattering_profiles_of(value);
    return std::all_of(profiles.begin(), profiles.end(), burley);
}

TableValue scattering_table(const ScatteringValue& value) {
    const std::vector<ScatteringProfile> profiles = scattering_profiles_of(value);
    const auto row = [&](const ScatteringProfile& profile) {
        return row_of(profile,
                      std::size_t(std::find(profiles.begin(), profiles.end(), profile) - profiles.begin()));
    };
    TableValue table;
    table.default_row = row(value.usual);
    for (const auto& [key, profile] : value.rows) table.rows.emplace_back(key, row(profile));
    return table;
}

namespace {

/// Reads one value.
class ScatteringValueReader {
public:
    explicit ScatteringValueReader(const ValueReader& reader)
        : label_(reader.label), diagnostics_(reader.diagnostics) {}

    std::optional<ParamValue> read(const Node& node) {
        // Of a value of the command line, which has no line, from where the program runs.
        if (node.place.line > 0) folder_ = std::filesystem::path(node.place.file).parent_path();
        const int errors_before = diagnostics_.error_count();
        if (node.is_object() && (node.find("rows") || node.find("default"))) by_object(node);
        else value_.usual = profile_at(&node, label_);
        if (diagnostics_.error_count() > errors_before) return std::nullopt;
        return OpaqueValue(std::make_shared<const ScatteringValue>(std::move(value_)));
    }

private:
    ScatteringProfile profile_at(const Node* at, const std::string& label) {
        std::optional<ScatteringProfile> profile;
        if (at) profile = parse_scattering_profile(*at, label, folder_, diagnostics_);
        return profile.value_or(ScatteringProfile{});
    }

    void by_object(const Node& node) {
        ObjectReader reader(node, label_, diagnostics_);
        value_.usual =
            profile_at(reader.any("default", ObjectReader::Presence::required), label_ + ".default");
        TableKeyReader keys(diagnostics_);
        if (const Node* rows = reader.array("rows"))
            for (std::size_t i = 0; i < rows->items.size(); ++i)
                read_row(rows->items[i], label_ + ".rows[" + std::to_string(i) + "]", keys);
        reader.finish();
        keys.check_overlaps();
        if (value_.rows.size() > kMaxScatteringRows)
            diagnostics_.error(node.place, label_ + ": " + std::to_string(value_.rows.size()) +
                                               " rows are more than " + std::to_string(kMaxScatteringRows));
    }

    void read_row(const Node& row, const std::string& label, TableKeyReader& keys) {
        ObjectReader reader(row, label, diagnostics_);
        if (!reader.is_object()) return;
        const Node* at = reader.any(std::string(kRowKey), ObjectReader::Presence::required);
        const ScatteringProfile profile = profile_at(at, label);
        for (const TableKey& key : keys.read_row(reader, row, label)) value_.rows.emplace_back(key, profile);
        reader.finish();
    }

    const std::string& label_;
    Diagnostics& diagnostics_;
    std::filesystem::path folder_;
    ScatteringValue value_;
};

constexpr std::string_view kScattering = R"(#define $upper_GAUSSIANS $gaussians
vec3 $sample($row row, int kind, float r) {
    float at = sqrt(clamp(r / row.reach, 0.0, 1.0)) * $last;
    int i = min(int(at), int($last) - 1), line = 4 * row.index + kind;
    return mix(texelFetch($curves, ivec2(i, line), 0).rgb, texelFetch($curves, ivec2(i + 1, line), 0).rgb, at - float(i));
}
vec3 $radial($row row, float r) { return r > row.reach ? vec3(0.0) : $sample(row, 0, r); }
vec3 $within($row row, float r) { return $sample(row, 1, r); }
vec3 $line($row row, float x) { return $sample(row, 2, x); }
vec3 $variance($row row, int k) { return texelFetch($curves, ivec2(2 * k, 4 * row.index + 3), 0).rgb; }
vec3 $weight($row row, int k) { return texelFetch($curves, ivec2(2 * k + 1, 4 * row.index + 3), 0).rgb; }
)";

class ScatteringTexture final : public AbstractParamTexture {
public:
    std::string_view label() const override { return ".curves"; }

    TexelSize size(const ParamValue& value) const override {
        return {kScatteringSamples, kScatteringRows * int(scattering_profiles_of(content_of(value)).size()),
                4};
    }

    std::vector<float> texels(const ParamSpec&, const ParamValue& value) const override {
        const std::vector<ScatteringProfile> profiles = scattering_profiles_of(content_of(value));
        constexpr std::size_t kRow = std::size_t(kScatteringSamples) * 4;
        std::vector<float> made(profiles.size() * kScatteringRows * kRow);
        const auto put = [&](std::size_t row, std::size_t column, const Rgb& rgb) {
            for (std::size_t c = 0; c < 3; ++c) made[row * kRow + column * 4 + c] = float(rgb[c]);
        };
        for (std::size_t i = 0; i < profiles.size(); ++i) {
            const ScatteringCurves curves = scattering_curves(profiles[i]);
            for (std::size_t k = 0; k < kScatteringSamples; ++k) {
                put(4 * i, k, curves.radial[k]);
                put(4 * i + 1, k, curves.within[k]);
                put(4 * i + 2, k, curves.line[k]);
            }
            const auto gaussians = profiles[i].as_gaussians();
            for (std::size_t k = 0; k < ScatteringProfile::kMaxGaussians; ++k) {
                put(4 * i + 3, 2 * k, k < gaussians.size() ? gaussians[k].variance_mm2 : Rgb{1, 1, 1});
                put(4 * i + 3, 2 * k + 1, k < gaussians.size() ? gaussians[k].weight : Rgb{});
            }
        }
        return made;
    }

    std::string glsl(const ParamSpec& spec, int binding) const override {
        return "layout(binding = " + std::to_string(binding) + ") uniform sampler2D " + spec.name +
               "_curves;\n";
    }
};

class ScatteringTable final : public AbstractParamTable {
public:
    std::size_t entries(const ParamValue& value) const override {
        return count_entries(content_of(value).rows);
    }

    TableValue rows(const ParamValue& value) const override { return scattering_table(content_of(value)); }

    std::string glsl(const ParamSpec& spec) const override {
        std::map<std::string, std::string> values = {
            {"upper_GAUSSIANS", upper_case(spec.name) + "_GAUSSIANS"},
            {"gaussians", std::to_string(ScatteringProfile::kMaxGaussians)},
            {"row", camel_case(spec.name) + "Row"},
            {"last", glsl_float(kScatteringSamples - 1)}};
        for (const char* part : {"curves", "sample", "radial", "within", "line", "variance", "weight"})
            values[part] = spec.name + "_" + part;
        return filled(kScattering, values);
    }
};

constexpr ScatteringTexture kTexture;
constexpr ScatteringTable kTable;

class ScatteringType final : public AbstractParamType {
public:
    constexpr ScatteringType()
        : AbstractParamType({.name = "scattering_profile",
                             .home = ParamHome::resource,
                             .texture = &kTexture,
                             .table = &kTable,
                             .has_defines = true}) {}

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        return ScatteringValueReader(reader).read(node);
    }

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        declaration.keys.push_back(grammar::optional("per_metre", grammar::text(),
                                                     "Parameter with the mm of the profile for each metre of "
                                                     "the capture: warn where by it the light of "
                                                     "no pixel goes 0.1 px far."));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        if (const Node* const per_metre = reader.node.find("per_metre")) spec.per_metre = per_metre->string;
        spec.columns = {column("index", ParamType::int_), column("d", ParamType::vec3),
                        column("direct", ParamType::vec3), column("falloff", ParamType::vec3),
                        column("reach", ParamType::float_)};
    }

    schema::json literal_schema(const ParamSpec&, const schema::LiteralParts& parts) const override {
        grammar::SchemaScope scope;
        scope.variables = parts.variables();
        const schema::json form = scope.of(scattering_object_block());
        const schema::json profile = parts.part(schema::any_of({schema::text(), form}));
        schema::json row = parts.keyed_row({{kRowKey, profile}});
        row["required"] = {kRowKey};
        schema::json rows = schema::object(
            {{"default", profile}, {"rows", parts.part(schema::array_of(parts.part(std::move(row))))}},
            {"default"});
        return schema::any_of({schema::text(), form, std::move(rows)});
    }

    std::string type_text(const ParamSpec&) const override { return "scattering profile, by object too"; }

    std::string defines(const ParamSpec& spec, const ParamValue& value) const override {
        return "#define " + upper_case(spec.name) + "_IS_BURLEY " +
               (is_burley(content_of(value)) ? "1\n" : "0\n");
    }

    /// d of the channel in which it goes farthest, of all profiles.
    double length_mm(const ParamValue& value) const override {
        double longest = 0;
        for (const ScatteringProfile& profile : scattering_profiles_of(content_of(value)))
            for (const double d_mm : profile.fitted_d_mm()) longest = std::max(longest, d_mm);
        return longest;
    }

    std::string content(const ParamValue& value) const override {
        std::string text;
        for (ScatteringProfile profile : scattering_profiles_of(content_of(value))) {
            profile.name.clear();
            text += "\n" + format_scattering_profile(profile);
        }
        return text;
    }
};

constexpr ScatteringType kType;

}  // namespace

constinit const ParamType kScatteringParam{kType};

}  // namespace aftershade
