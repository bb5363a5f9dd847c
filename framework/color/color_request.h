// Requests to OpenColorIO, the reasons that refuse them, and the variable that names the config.
#pragma once

#include <compare>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace aftershade {

/// What OpenColorIO is to make. Words by their part, "" where nothing was said: of a config "display" and
/// "view", with "looks" that replace the view's own, or "destination", a space; and "source", a space. A
/// source or a destination of "" is linear light in Rec. 709's primaries. Of a file "correction", the id of
/// one in it. [value type]
struct ColorRequest {
    std::string function;  ///< the name that shaders call it by
    bool is_file = false;  ///< a file of a transform, else a config
    std::string path;      ///< a config's may be "": that of $OCIO, else the built-in one
    std::map<std::string, std::string> words;
    bool inverse = false;

    std::string word(const std::string& part) const {
        const auto found = words.find(part);
        return found == words.end() ? "" : found->second;
    }
    /// Whether it is a view of a display, else a conversion.
    bool is_view() const { return words.contains("view") || words.contains("display"); }
    auto operator<=>(const ColorRequest&) const = default;
};

/// Texels in a row of the table.
inline constexpr int kColorTableRow = 4096;

/// Why there is no such transform.
struct ColorFault {
    std::string part;  ///< whose word is at fault; "": the file
    std::string text;
};

/// What the words of a request may be.
struct ColorNames {
    std::string config;                                                   ///< "the built-in config"
    std::vector<std::pair<std::string, std::vector<std::string>>> views;  ///< by display, the usual one first
    std::vector<std::string> looks;
    std::vector<std::string> spaces;
    std::vector<std::pair<std::string, std::string>> roles;  ///< with their spaces
};
/// "ocio://default", by which OpenColorIO names the configs that it holds: not a path.
inline bool is_config_address(const std::string& path) {
    return path.starts_with("ocio://");
}

inline constexpr const char* kConfigVariable = "OCIO";
/// Set beside it, also for the processes that this one starts, where the user did not write the variable.
inline constexpr const char* kConfigIsOfOption = "AFTERSHADE_OCIO_IS_OF_OPTION";

/// For this process and those that it starts, as if the variable had named it. [not thread-safe]
inline void choose_config(const std::string& path) {
    setenv(kConfigVariable, path.c_str(), 1);
    setenv(kConfigIsOfOption, "1", 1);
}

}  // namespace aftershade
