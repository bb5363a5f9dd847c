// JSON Schema of the passes of manifests, and what the sections of effects and modules share. Internal to
// framework/pipeline.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "framework/core/schema_pieces.h"

namespace aftershade::schema_of_effect {

using schema::json;

inline const json kText = {{"type", "string"}};
inline const json kName = {{"type", "string"}, {"minLength", 1}};
inline const json kFlag = {{"type", "boolean"}};
inline const json kNumber = {{"type", "number"}};

json integer(int min, int max);
/// A number, or the name of an int parameter.
json count(int min, int max);
/// A value of every channel, or four of them.
json texel();
/// For "not": two of the keys.
json at_most_one(const std::vector<std::string>& keys);
/// What else holds for an object whose `key` is `value`.
json where(const std::string& key, const std::string& value, json then);
/// No such keys.
json without(const std::vector<std::string>& keys);
/// Conditions.
json when();
/// One channel of a texture.
json channel();
json grid_scale();
json per();

/// Passes and groups of them, at least so many: refers to what define_passes() puts among "$defs".
json passes(int least);
void define_passes(json& document);
json tile_list();

}  // namespace aftershade::schema_of_effect
