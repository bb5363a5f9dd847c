// Names of files that a page chooses, which lie in the look's folder and nowhere else.
#pragma once

#include <filesystem>
#include <string>

#include "framework/serve/http_message.h"

namespace aftershade::serve {

/// The path of a new file or folder. Throws Refusal: 400 where the name would leave the folder or hide in it,
/// 409 where the path is taken. `thing` is "the look".
std::filesystem::path new_path(const std::filesystem::path& folder, const std::string& name,
                               const std::string& ending, const std::string& thing);

}  // namespace aftershade::serve
