#include "framework/effect/isf/isf_shaders.h"

#include <utility>

#include "framework/document/glsl_text.h"
#include "framework/effect/isf/isf_params.h"

namespace aftershade {

std::string IsfShaders::text(const std::string& stage, const std::string& file_name) const {
    std::string shader = "#version 450 core\n#include <pass>\n";
    if (texts.moves_corners()) shader += "#define ISF_MOVED\n";
    shader += "#include <isf/" + stage + ".glsl>\n";
    if (!file.cubes.empty()) shader += "#include <isf/cube.glsl>\n";
    for (const IsfInput& input : file.inputs)
        shader += global_of_input(file, input, names.of(input.name), texts.name(input.name));
    shader += "#include <isf/" + stage + "_names.glsl>\n";
    for (std::size_t i = 0; i < images.size(); ++i) {
        shader += image_names(images[i], i);
        if (stage == "fragment") shader += texel(images[i], i);
    }
    for (const std::string& cube : file.cubes) {
        shader += "#define " + texts.name(cube);
        for (int face = 0; face < kCubeFaces; ++face)
            shader += (face == 0 ? " " : ", ") + texts.name(name_of_face(cube, face));
        shader += "\n";
    }
    if (const std::string output = texts.output(); stage == "fragment") {
        const std::string color = output.empty() ? "isf_data[0]" : "isf_color(" + output + ")";
        shader += "#define ISF_COLOR " + color + "\n";
    }
    // Where no file has these words, the host may put loads from images in the place of fetches, and
    // knows that a shader sees its own pixel alone.
    if (words.all.contains("texelFetch")) shader += "#define texelFetch isf_fetch\n";
    for (const std::string word : {"dFdy", "dFdyFine", "dFdyCoarse"})
        if (words.all.contains(word)) shader += "#define " + word + "(value) (-" + word + "(value))\n";
    for (const std::string& word : words.macros)
        if (!texts.is_renamed(word)) shader += "#undef " + word + "\n";
    for (const std::string& word : symbols()) shader += "#undef " + word + "\n";
    return shader + "#include \"" + file_name + "\"\n#include <isf/" + stage + "_main.glsl>\n";
}

std::string IsfShaders::image_names(const IsfImage& image, std::size_t index) const {
    const std::string number = "ISF_IMAGE_" + std::to_string(index), name = texts.name(image.isf_name);
    const std::string there = image.is_file ? "defined(HAS_" + upper_case(image.name) + ")"
                              : image.is_optional
                                  ? "defined(" + number + ") && defined(HAS_" + upper_case(image.name) + ")"
                                  : "defined(" + number + ")";
    std::string shader = "#if " + there + "\n#define " + name + " " + (image.is_file ? image.name : number) +
                         "\n#else\n#define " + name + " ISF_NOTHING\n#endif\n";
    // What hosts make of IMG_... some files have themselves.
    for (const auto& [suffix, meaning] : {std::pair(kImageWords[0], "vec4(0.0, 0.0, 1.0, 1.0)"),
                                          {kImageWords[1], "isf_size("},
                                          {kImageWords[2], "false"}})
        if (const std::string word = "_" + image.isf_name + suffix; words.all.contains(word))
            shader += "#define " + word + " " + meaning +
                      (std::string_view(meaning).ends_with('(') ? name + ")" : "") + "\n";
    return shader;
}

/// Text that fetches the pixel's own texel, for an image with the target's size, which needs no filter. The
/// fetch names the sampler itself, so that the host can replace it by a load from an image.
std::string IsfShaders::texel(const IsfImage& image, std::size_t index) const {
    const std::string here = texts.name_here(image.isf_name), number = std::to_string(index);
    if (here.empty()) return "";
    const std::string sampler = image.has_one_name ? image.name : "ISF_IMAGE_" + number;
    return "#ifdef ISF_HERE_" + number + "\nvec4 isf_texel_" + number + " = texelFetch(" + sampler +
           ", isf_pixel, 0);\n#define " + here + " isf_texel_" + number + "\n#else\n#define " + here + " " +
           texts.name(image.isf_name) + "\n#endif\n";
}

/// Preprocessor symbols of enums that are words of the file.
std::vector<std::string> IsfShaders::symbols() const {
    std::vector<std::string> symbols;
    for (const IsfInput& input : file.inputs)
        for (const std::string& label : names_of_labels(input.labels))
            if (const std::string symbol = upper_case(names.of(input.name)) + "_" + upper_case(label);
                words.all.contains(symbol))
                symbols.push_back(symbol);
    return symbols;
}

}  // namespace aftershade
