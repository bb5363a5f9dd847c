// glTF files with textures, and captures of them, for the tests of textures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "framework/file/png_file.h"
#include "framework/scene/gltf_model.h"
#include "framework/scene/scene_renderer.h"
#include "tests/scene/gltf_file.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene::test {

using Texels = std::function<glm::ivec3(int x, int y)>;

/// A PNG of 8 bits.
inline std::string png_of(int width, int height, const Texels& texels) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = float(texels(x, y)[c]) / 255.0f;
    return encode_png("a PNG", image);
}

inline std::string png_of(const glm::ivec3& texel) {
    return png_of(2, 2, [&](int, int) { return texel; });
}

/// Where a quad's image lies, and the rest of what a test varies.
struct Textured {
    std::string images = {};   ///< the root's "images"; empty: each of `pictures` is in a bufferView
    std::string sampler = {};  ///< its members
    glm::dvec2 uv_low{0}, uv_high{1};
    std::vector<float> normals = {};   ///< three for each corner
    std::vector<float> tangents = {};  ///< four for each corner
    std::string more_uvs = {};         ///< "mirrored": set 1, with u the other way round; else none
    std::vector<std::string> pictures = {};
};

/// The square from (0, 0, 0) to (1, 1, 0), seen from +z, v down, with a material of these members.
inline File textured_quad(const std::string& material, const Textured& textured) {
    File file;
    const glm::vec2 low(textured.uv_low), high(textured.uv_high);
    std::string attributes =
        fmt::format(R"("POSITION": {}, "TEXCOORD_0": {})", file.floats(kSquare, 3),
                    file.floats({low.x, high.y, high.x, high.y, high.x, low.y, low.x, low.y}, 2));
    const std::vector<float> up = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    attributes +=
        fmt::format(R"(, "NORMAL": {})", file.floats(textured.normals.empty() ? up : textured.normals, 3));
    if (!textured.tangents.empty())
        attributes += fmt::format(R"(, "TANGENT": {})", file.floats(textured.tangents, 4));
    if (textured.more_uvs == "mirrored")
        attributes +=
            fmt::format(R"(, "TEXCOORD_1": {})",
                        file.floats({high.x, high.y, low.x, high.y, low.x, low.y, high.x, low.y}, 2));
    file.primitive(attributes, file.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}), kTriangles, 0);
    std::string images = textured.images, textures;
    for (std::size_t i = 0; i < std::max(textured.pictures.size(), std::size_t(1)); ++i) {
        if (textured.images.empty() && i < textured.pictures.size())
            images += fmt::format(R"({}{{"bufferView": {}, "mimeType": "image/png"}})", i > 0 ? ", " : "",
                                  file.view(textured.pictures[i]));
        textures += fmt::format(R"({}{{"source": {}, "sampler": 0}})", i > 0 ? ", " : "", i);
    }
    file.more = fmt::format(
        R"(, "images": [{}], "textures": [{}], "samplers": [{{{}}}], "materials": [{{"name": "paint", {}}}])",
        images, textures, textured.sampler, material);
    return file;
}

/// A base colour alone, without highlights.
inline const std::string kPainted =
    R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0})";

/// A normal map alone.
inline const std::string kBumpy = R"("normalTexture": {"index": 0})";

/// The scene of model.gltf in the folder, seen straight on by a camera whose picture the quad fills exactly.
inline Scene quad_scene(const std::filesystem::path& folder, int side_px, const std::string& more = "",
                        const std::string& object = "") {
    write_text(folder / "scene.json", fmt::format(R"({{ "aftershade": 1, "size": [{0}, {0}], {1}
        "camera": {{ "position": [0.5, 0.5, 1], "target": [0.5, 0.5, 0], "focal_length": "36 mm", "focus_distance": "1 m" }},
        "meshes": {{ "model": {{ "file": "model.gltf" }} }},
        "objects": [ {{ "shape": "mesh", "mesh": "model"{2} }} ] }})",
                                                  side_px, more, object));
    Diagnostics diagnostics;
    auto scene = read_scene(folder / "scene.json", diagnostics);
    if (!scene) throw std::runtime_error(faults_of(diagnostics));
    return std::move(*scene);
}

/// What the quad's scene gives with these bytes as model.gltf.
inline Capture capture_of(const std::string& model, int side_px, const std::string& more = "",
                          const std::string& object = "") {
    const TemporaryFolder folder;
    write_text(folder / "model.gltf", model);
    const Scene scene = quad_scene(folder.path(), side_px, more, object);
    return SceneRenderer(scene, side_px, side_px, 1).render_capture(1);
}

inline glm::dvec3 pixel_of(const Capture& capture, const std::string& role, int x, int y) {
    const Image& image = capture.images.at(role);
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

}  // namespace aftershade::scene::test
