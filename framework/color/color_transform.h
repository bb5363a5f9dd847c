// Colour transforms of OpenColorIO as text for shaders and a table of its LUTs.
#pragma once

#include <compare>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>
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

    bool has(const std::string& part) const { return words.contains(part); }
    auto operator<=>(const ColorRequest&) const = default;
};

/// Texels in a row of the table.
inline constexpr int kColorTableRow = 4096;

struct ColorTransform {
    /// Of the sampler2D "<function>_table", which texelFetch alone reads, and of `vec3 function(vec3 rgb)`.
    std::string glsl;
    std::vector<float> texels;  ///< whole rows of kColorTableRow texels, RGBA
    std::vector<std::filesystem::path>
        files;  ///< the config and the LUTs, or the transform, that it was made of
};

/// Why there is no such transform.
struct ColorFault {
    std::string part;  ///< whose word is at fault; "": the file
    std::string text;
};

/// Reads its files again each time. [thread-safe]
std::variant<ColorTransform, ColorFault> make_color_transform(const ColorRequest& request);

/// What the words of a request may be.
struct ColorNames {
    std::string config;                                                   ///< "the built-in config"
    std::vector<std::pair<std::string, std::vector<std::string>>> views;  ///< by display, the usual one first
    std::vector<std::string> looks;
    std::vector<std::string> spaces;
    std::vector<std::pair<std::string, std::string>> roles;  ///< with their spaces
};
/// Of the config of that path, as in a request.
std::variant<ColorNames, ColorFault> color_names(const std::string& path);

/// "ocio://default", by which OpenColorIO names the configs that it holds: not a path.
bool is_config_address(const std::string& path);

/// Whether this program was built with OpenColorIO.
bool has_opencolorio();

}  // namespace aftershade
