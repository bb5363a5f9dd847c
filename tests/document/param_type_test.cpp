// A type is one class: everything that core does with parameters asks it, never which type it is. The
// type of this file is known to nobody else.
#include "framework/document/param_type.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>

#include "framework/base/text.h"
#include "framework/document/grammar_schema.h"
#include "framework/document/grammar_table.h"
#include "framework/document/param_grammar.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"
#include "tests/document/param_specs.h"

namespace aftershade {
namespace {

using test::Lines;
using test::value_faults;
using test::value_of;

// "16:9": a number for shaders, which documents write as a ratio.
namespace ratio {

class RatioType final : public AbstractParamType {
public:
    constexpr RatioType()
        : AbstractParamType({.name = "ratio", .glsl_type = "float", .is_continuous = true}) {}

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        const std::size_t colon = node.string.find(':');
        if (!node.is_string() || colon == std::string::npos) return reader.wrong_kind(node, "a ratio");
        const auto first = parse_number(node.string.substr(0, colon)),
                   second = parse_number(node.string.substr(colon + 1));
        if (!first || !second) return reader.fault(node, "'" + node.string + "' is no ratio");
        return *first / *second;
    }

    schema::json literal_schema(const ParamSpec&, const schema::LiteralParts&) const override {
        return {{"type", "string"}, {"pattern", ":"}};
    }

    std::string format(const ParamSpec&, const ParamValue& value) const override {
        return json_string(format_number(std::get<double>(value)) + ":1");
    }

    std::vector<double> numbers(const ParamSpec&, const ParamValue& value) const override {
        return {std::get<double>(value)};
    }

    ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) const override {
        return numbers.at(0);
    }

    std::vector<SweepValue> sweep(const ParamSpec&) const override {
        return {{"square", 1.0}, {"wide", 4.0}};
    }

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        declaration.keys.push_back(grammar::required("terms", grammar::integer(), "How many."));
    }
};

constexpr RatioType kType;

}  // namespace ratio

/// Core's types and that of this file.
std::vector<ParamType> types() {
    std::vector<ParamType> all(core_param_types().begin(), core_param_types().end());
    all.push_back(ratio::kType);
    return all;
}

ParamSpec spec_with_ratio(const std::string& declaration) {
    return test::spec_of(declaration, "p", types());
}

const std::string kRatio = R"({"type": "ratio", "terms": 2, "default": "16:9", "doc": "."})";

TEST(ParamType, OfOneClassReadsAndWritesItsValues) {
    const ParamSpec spec = spec_with_ratio(kRatio);
    EXPECT_EQ(param_type_name(spec.type), "ratio");
    EXPECT_EQ(spec.default_value, ParamValue(16.0 / 9));
    const ParamValue value = value_of(spec, "\"5:2\"");
    EXPECT_EQ(value, ParamValue(2.5));
    EXPECT_EQ(format_value(spec, value), "\"2.5:1\"");
    EXPECT_EQ(value_faults(spec, "3"), Lines{"doc.json:1:1: error: p: expected a ratio, not an integer"});
    EXPECT_EQ(interpolate(spec, 1.0, 3.0, 0.25), ParamValue(1.5));
    EXPECT_EQ(scale_pixels(spec, value, 0.5), value);
    EXPECT_EQ(sweep_values(spec).size(), 2u);
    EXPECT_EQ(schema::literal(spec).dump(), R"({"type":"string","pattern":":"})");
}

TEST(ParamType, OfOneClassMayBeAColumn) {
    const ParamSpec spec = spec_with_ratio(
        R"({"type": "table", "columns": {"shape": {"type": "ratio", "terms": 2, "default": "4:1", "doc": "."}},
            "doc": "."})");
    const ParamValue value = value_of(spec, R"({"rows": [{"object": 3, "shape": "3:2"}]})");
    EXPECT_EQ(std::get<TableValue>(value).rows[0].second[0], std::vector<double>{1.5});
    EXPECT_EQ(format_value(spec, value),
              R"({"default": {"shape": "4:1"}, "rows": [{"object": 3, "shape": "1.5:1"}]})");
}

TEST(ParamType, HasItsOwnKeysToItself) {
    const auto all = types();
    EXPECT_EQ(test::spec_faults(R"({"type": "int", "terms": 2, "default": 1, "doc": "."})", all),
              Lines{"doc.json:1:17: error: parameter 'p' has no key 'terms'; it is a key of type 'ratio'"});
    EXPECT_EQ(
        test::spec_faults(R"({"type": "ratio", "unit": "mm", "min": 1, "default": "1:1", "doc": "."})", all),
        (Lines{"doc.json:1:1: error: parameter 'p' has no 'terms'",
               "doc.json:1:19: " + test::only_numbers_have("unit"),
               "doc.json:1:33: " + test::only_numbers_have("min")}));
    EXPECT_EQ(test::spec_faults(kRatio).size(), 2u) << "where it is no type, 'type' and 'terms' are wrong";
}

TEST(ParamType, HasItsOwnKeysInCheckSchemaAndTable) {
    const auto all = types();
    const grammar::Block before = param_block(core_param_types()), after = param_block(all);
    EXPECT_EQ(grammar::table_of(before).find("terms"), std::string::npos);
    EXPECT_NE(grammar::table_of(after).find("| `terms` | ratio | int |"), std::string::npos)
        << grammar::table_of(after);
    EXPECT_EQ(grammar::schema_text("", before).find("terms"), std::string::npos);
    EXPECT_NE(grammar::schema_text("", after).find("terms"), std::string::npos);
    Diagnostics diagnostics;
    EXPECT_TRUE(grammar::check(test::parsed(kRatio), after, diagnostics));
    EXPECT_FALSE(grammar::check(test::parsed(kRatio), before, diagnostics));
}

TEST(ParamType, HasTraitsThatFit) {
    for (const ParamType type : types()) {
        const bool is_block = is_block_type(type);
        EXPECT_EQ(is_block, !type->glsl_type.empty()) << type->name;
        EXPECT_EQ(type->home == ParamHome::resource, is_param_texture(type) || is_param_buffer(type));
        EXPECT_TRUE(is_block || !(type->is_integer || type->is_continuous || type->is_choice)) << type->name;
        EXPECT_TRUE(!type->is_scalar || (type->has_range && component_count(type) == 1)) << type->name;
    }
}

TEST(ParamType, OfABlockGivesNumbersAndTakesThemBack) {
    for (const ParamType type : types()) {
        if (!is_block_type(type)) continue;
        ParamSpec spec;
        spec.type = type;
        spec.values = {"a", "b"};
        const std::vector<double> numbers(std::size_t(component_count(type)), 1);
        const ParamValue value = value_of_numbers(spec, numbers);
        EXPECT_EQ(numbers_of(spec, value), numbers) << type->name;
        EXPECT_EQ(interpolate(spec, value, value_of_numbers(spec, std::vector<double>(numbers.size(), 0)), 0),
                  value)
            << type->name;
    }
}

TEST(ParamType, OfANumberIsSweptOverItsLimits) {
    const ParamSpec spec =
        spec_with_ratio(R"({"type": "vec2", "default": [0, 0], "min": -1, "max": 2.5, "doc": "."})");
    const auto values = sweep_values(spec);
    ASSERT_EQ(values.size(), 2u);
    EXPECT_EQ(values[0].how, "at its min, [-1, -1]");
    EXPECT_EQ(values[1].value, (ParamValue(std::vector<double>{2.5, 2.5})));
    EXPECT_TRUE(
        sweep_values(spec_with_ratio(R"({"type": "curve", "default": [[0, 1]], "min": 0, "doc": "."})"))
            .empty());
}

}  // namespace
}  // namespace aftershade
