// Which stored channels make up a role.
#pragma once

#include <string>
#include <vector>

namespace aftershade {

/// Per layer that is added up, per component; "" for an optional channel that is absent.
using FoundChannels = std::vector<std::vector<std::string>>;

}  // namespace aftershade
