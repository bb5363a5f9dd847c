// The shaders of an ISF file as GLSL 4.50 takes them beside the host's own text. Internal to
// framework/effect.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "framework/effect/isf/isf_types.h"

namespace aftershade {

/// Files are written for GLSL 1.20 to 3.30 and for other hosts. Names that are words of GLSL 4.50 or of our
/// host, and images named like a swizzle, get a prefix wherever they stand for the author's thing; variables
/// of ISF that a file declares itself are taken out. Every line stays where it is.
class IsfTexts {
public:
    explicit IsfTexts(const IsfFile& file);

    std::string fragment() const { return rewritten(file_.text, true); }
    std::string vertex() const { return rewritten(file_.vertex_text, false); }
    /// An input, a target or an import as the shaders have it.
    std::string name(const std::string& isf_name) const;
    /// What stands for the image in IMG_THIS_PIXEL(); "": its name.
    std::string name_here(const std::string& isf_name) const;
    /// Whether IMG_THIS_PIXEL() and its like are all that the fragment shader does with the image.
    bool is_read_by_pixel(const std::string& isf_name) const;
    /// The fragment shader's own output as an expression; "": it writes gl_FragColor.
    std::string output() const;

    /// Whether the vertex shader places its corners, or gives them other coordinates, itself.
    bool moves_corners() const;
    /// Whether the fragment shader leaves pixels out, which are 0 then.
    bool discards() const;

    /// Whether the word stands in the texts behind a prefix.
    bool is_renamed(const std::string& word) const;
    /// A variable that ISF has in its shaders: RENDERSIZE.
    static bool is_of_isf(std::string_view word);

private:
    friend class IsfRewriter;
    bool redefines_pixels() const;
    std::string rewritten(const std::string& text, bool is_fragment) const;

    const IsfFile& file_;
    std::set<std::string> things_;  // inputs, targets and imports
    std::set<std::string> own_things_;
    std::set<std::string> read_here_;  // images by IMG_THIS_PIXEL(), among other ways
    std::set<std::string> macros_;
};

}  // namespace aftershade
