// Pieces that the JSON Schemas of documents share.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/document/param.h"

namespace aftershade::schema {

using json = nlohmann::ordered_json;

inline constexpr const char* kDraft = "https://json-schema.org/draft/2020-12/schema";
inline constexpr const char* kSnakeCase = "^[a-z][a-z0-9_]*$";

/// An object with these members and no others.
json object(json properties, const std::vector<std::string>& required = {});
/// Members of any snake_case name, each as `value`.
json named(const json& value);
json array_of(json items, int min = 0, int max = -1);
json one_of(const std::vector<std::string>& words);
json text();
json snake_case();
/// {"anyOf": [...]}
json any_of(std::vector<json> forms);

/// As a ParamSpec's unit: strings in every unit.
inline constexpr const char* kAnyUnit = "*";
/// A number with limits; the spec's unit adds strings such as "85 mm" in any unit that converts to it.
json quantity(const ParamSpec& spec);

enum class Variables { no, yes, in_braces };
/// {"var": "name"}: refers to what define_variable() puts among "$defs". Ids of effects have no capitals.
json variable();
void define_variable(json& definitions);
/// A literal of the parameter's type. With variables, one may stand for it and for any part of it.
json literal(const ParamSpec& spec, Variables variables = Variables::no);

/// The pieces of literals in one kind of document.
class LiteralParts {
public:
    explicit LiteralParts(Variables variables) : variables_(variables) {}
    Variables variables() const { return variables_; }
    /// A variable may stand for the part where there are variables.
    json part(json form) const;
    /// Schema of the parameter, or the column, that is part of another.
    json literal(const ParamSpec& spec) const;
    /// A table's row: the cells, and by one key which objects it is for.
    json keyed_row(json cells) const;
    static json one_key();

private:
    Variables variables_;
};

/// Id of an object, ids and ranges of ids, or a Cryptomatte name.
json object_key();
/// Head of a document: "$schema" of the schema itself, title, and "aftershade": 1 among the properties.
json document(const std::string& title, const json& properties, std::vector<std::string> required);

}  // namespace aftershade::schema
