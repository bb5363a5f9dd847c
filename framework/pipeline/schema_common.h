// Pieces that the schemas share.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "framework/core/param.h"

namespace aftershade::schema {

using json = nlohmann::ordered_json;

inline constexpr const char* kDraft = "https://json-schema.org/draft/2020-12/schema";
inline constexpr const char* kSnakeCase = "^[a-z][a-z0-9_]*$";

/// An object with these members and no others.
json object(json properties, std::vector<std::string> required = {});
json array_of(json items, int min = 0, int max = -1);
json one_of(const std::vector<std::string>& words);
json text();
/// A number with limits; `unit` adds strings such as "85 mm" in any unit that converts to it.
json quantity(const ParamSpec& spec);
/// A literal of the parameter's type.
json literal(const ParamSpec& spec);
/// Head of a document: "$schema" of the schema itself, title, and "aftershade": 1 among the properties.
json document(const std::string& title, json properties, std::vector<std::string> required);

}  // namespace aftershade::schema
