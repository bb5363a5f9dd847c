// Which stored channels make up a role.
#pragma once

#include <string>
#include <vector>

namespace aftershade {

/// Per layer that is added up, per component; "" for an optional channel that is absent.
using FoundChannels = std::vector<std::vector<std::string>>;

/// Those that a file has, of all layers.
inline std::vector<std::string> names_of(const FoundChannels& found) {
    std::vector<std::string> names;
    for (const auto& layer : found)
        for (const std::string& name : layer)
            if (!name.empty()) names.push_back(name);
    return names;
}

}  // namespace aftershade
