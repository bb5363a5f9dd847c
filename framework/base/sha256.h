// SHA-256 (FIPS 180-4): names that cannot be forged, for contents from elsewhere.
#pragma once

#include <string>
#include <string_view>

namespace aftershade {

/// 64 hexadecimal digits in lower case, as sha256sum prints them. [thread-safe]
std::string sha256(std::string_view bytes);

}  // namespace aftershade
