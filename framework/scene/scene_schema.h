// The schema and the page of scene documents, made from the declarations of their fields.
#pragma once

#include <string>

namespace aftershade::scene {

/// JSON Schema (draft 2020-12) of a scene.json. That names refer to something, that files exist and how two
/// values relate: only the program checks that.
std::string scene_schema();

/// docs/scene-reference.md: one table for each block of keys.
std::string scene_reference();

}  // namespace aftershade::scene
