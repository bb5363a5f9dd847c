// Parameters from text, for the tests that read them.
#pragma once

#include <string>

#include "framework/document/grammar_form.h"
#include "framework/document/param.h"
#include "framework/document/param_grammar.h"
#include "tests/documents.h"

namespace aftershade::test {

/// As a manifest's entry of "params" is checked and read.
inline std::optional<ParamSpec> parse_param_spec(const std::string& name, const Node& node,
                                                 Diagnostics& diagnostics,
                                                 std::span<const ParamType> types = core_param_types()) {
    const int errors_before = diagnostics.error_count();
    grammar::check_block(node, param_block(types), {name, name}, diagnostics);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return read_param_spec(name, node, diagnostics, types);
}

/// The parameter "p"; the test fails where the declaration has faults.
inline ParamSpec spec_of(const std::string& declaration, const std::string& name = "p",
                         std::span<const ParamType> types = core_param_types()) {
    Diagnostics diagnostics;
    const auto spec = parse_param_spec(name, parsed(declaration), diagnostics, types);
    EXPECT_EQ(lines_of(diagnostics), Lines{}) << declaration;
    return spec.value_or(ParamSpec{});
}

inline Lines spec_faults(const std::string& declaration,
                         std::span<const ParamType> types = core_param_types()) {
    return faults_of(declaration, [&](const Node& node, Diagnostics& diagnostics) {
        EXPECT_FALSE(parse_param_spec("p", node, diagnostics, types).has_value());
    });
}

/// The fault of a key that only numbers have.
inline std::string only_numbers_have(const std::string& key) {
    return "error: parameter 'p' has no key '" + key +
           "'; it is a key of type 'float', 'int', 'angle', 'color', 'vec2', 'vec3', 'vec4' or 'curve'";
}

/// The fault of a key that only block types have.
inline std::string only_block_types_have(const std::string& key) {
    return "error: parameter 'p' has no key '" + key +
           "'; it is a key of type 'float', 'int', 'bool', 'enum', 'angle', 'color', 'vec2', 'vec3' or "
           "'vec4'";
}

inline ParamValue value_of(const ParamSpec& spec, const std::string& value) {
    Diagnostics diagnostics;
    const auto read = parse_param_value(spec, parsed(value), "p", diagnostics);
    EXPECT_EQ(lines_of(diagnostics), Lines{}) << value;
    return read.value_or(ParamValue{});
}

inline Lines value_faults(const ParamSpec& spec, const std::string& value, const std::string& label = "p") {
    return faults_of(value, [&](const Node& node, Diagnostics& diagnostics) {
        EXPECT_FALSE(parse_param_value(spec, node, label, diagnostics).has_value());
    });
}

}  // namespace aftershade::test
