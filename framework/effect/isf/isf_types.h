// What a file of the Interactive Shader Format (isf.video) says: GLSL behind a comment with JSON.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/base/text.h"
#include "framework/document/document.h"

namespace aftershade {

/// What a filter gets: encoded 0 to 1, as its author saw it, or scene-linear light. Alpha is straight in
/// both.
enum class IsfSpace { display, linear };

struct IsfInput {
    enum class Type { image, number, boolean, choice, color, point, event, audio };
    std::string name;  ///< its GLSL name
    Type type = Type::number;
    std::string label;
    std::optional<Node> default_value, min, max, identity;  ///< of the kind that the type takes
    std::vector<int> values;                                ///< choice: what the shader sees ...
    std::vector<std::string> labels;                        ///< ... and what people read, as many
    Place place;
};

struct IsfPass {
    std::string target;  ///< "": the picture
    bool is_persistent = false;
    bool is_float = false;
    /// Formulas of its sides, with $WIDTH, $HEIGHT and $<input>; "": those of the picture.
    std::string side[2];
    Place side_place[2];
    std::string doc;
    Place place;
};

/// A picture beside the file.
struct IsfImport {
    std::string name, path;
    std::string label;  ///< what people read
    Place place;
};

inline constexpr int kCubeFaces = 6;
/// The import that holds a face of a cube map: +x, -x, +y, -y, +z, -z.
inline std::string name_of_face(const std::string& cube, int face) {
    return "isf_face_" + std::to_string(face) + "_" + cube;
}

struct IsfFile {
    std::filesystem::path path;
    std::string text;          ///< of the file, which is the fragment shader
    std::string written_text;  ///< the same, byte for byte
    std::string vertex_file;   ///< beside it: the same name with .vs; "" for none
    std::string vertex_text, written_vertex_text;
    std::string summary, credit;
    std::vector<IsfInput> inputs;
    std::vector<IsfPass> passes;  ///< at least one; the last one's is the picture
    std::vector<IsfImport> imports;
    std::vector<std::string> cubes;  ///< maps whose faces are imports
    Place place;                     ///< of the JSON
};

inline constexpr std::size_t kMaxIsfPasses = 64;
inline constexpr std::size_t kMaxIsfInputs = 256;

/// Whether the path is of such a file, by its ending.
inline bool is_isf_path(const std::filesystem::path& path) {
    return lower_case(path.extension().string()) == ".fs";
}
/// The same, or of a vertex shader.
inline bool is_isf_shader(const std::filesystem::path& path) {
    return is_isf_path(path) || lower_case(path.extension().string()) == ".vs";
}

}  // namespace aftershade
