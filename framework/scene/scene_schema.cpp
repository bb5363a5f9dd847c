#include "framework/scene/scene_schema.h"

#include "framework/document/grammar_schema.h"
#include "framework/document/grammar_table.h"
#include "framework/scene/fields.h"

namespace aftershade::scene {

namespace {

constexpr const char* kHead =
    R"(<!-- Made by `aftershade docs` from framework/scene/fields.cpp; do not edit. -->
# Scene documents

This page has every key of a `scene.json` for `aftershade render`. The document is JSON with `//` comments; a
key that is not listed is an error. `aftershade schema scene` prints the same as a JSON Schema.

A value with a unit is a number in that unit, or a string in any unit that converts to it: `50` or `"5 cm"`
for mm. Each number of a vector may have a unit, and the range applies to each. If *animated* is yes, the value
may be `{ "keys": { "1": ..., "12.5": ... }, "interpolation": ... }`: values by frame, between which it is)";

}  // namespace

std::string scene_schema() {
    return grammar::schema_text("Aftershade scene", scene_block());
}

std::string scene_reference() {
    std::string text = kHead;
    const auto& names = grammar::interpolation_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i ? ", `" : "\n`") + names[i] + (i ? "`" : "` (the default)");
    return text + ".\n" + grammar::reference_of(scene_block());
}

}  // namespace aftershade::scene
