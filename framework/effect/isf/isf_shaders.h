// The shaders of an ISF file's effect, around the file's own text. Internal to framework/effect/isf.
#pragma once

#include <string>
#include <vector>

#include "framework/effect/isf/isf_names.h"
#include "framework/effect/isf/isf_text.h"

namespace aftershade {

/// Something that the shader samples.
struct IsfImage {
    std::string isf_name = {}, name = {};
    const IsfInput* input = nullptr;  ///< of an image input
    const IsfPass* target = nullptr;  ///< the first pass that writes it
    bool is_file = false;             ///< an import or sound
    bool is_optional = false;
    bool has_one_name = false;  ///< its sampler is `name` in each pass
    std::string role = {};
};

/// [refers to what the caller keeps]
struct IsfShaders {
    const IsfFile& file;
    const IsfWords& words;
    const IsfTexts& texts;
    const IsfNames& names;
    const std::vector<IsfImage>& images;

    /// `stage`: "fragment" or "vertex", whose file has that name.
    std::string text(const std::string& stage, const std::string& file_name) const;

private:
    std::string texel(const IsfImage& image, std::size_t index) const;
    std::string image_names(const IsfImage& image, std::size_t index) const;
    std::vector<std::string> symbols() const;
};

}  // namespace aftershade
