// glTF files with alpha, for the tests of alpha on the CPU and by GL.
#pragma once

#include <functional>
#include <string>

#include "framework/image/srgb.h"
#include "tests/scene/textured_file.h"

namespace aftershade::scene::test {

/// A PNG of 8 bits with alpha.
inline std::string rgba_png(int width, int height, const std::function<glm::ivec4(int x, int y)>& texels) {
    Image image(width, height, 4);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) image.at(x, y, c) = float(texels(x, y)[c]) / 255.0f;
    return encode_png("a PNG", image);
}

/// The quad with a base colour whose alpha grows with u, in the material's `mode`.
inline File graded_quad(const std::string& mode) {
    const std::string material =
        R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0})" + mode;
    const std::string png = rgba_png(8, 8, [](int x, int y) { return glm::ivec4(30 * y, 100, 50, 32 * x); });
    return textured_quad(material, {.pictures = {png}});
}

/// A card whose alpha grows to the right, in `mode`, by a turned and scaled texture and by set 1 for its
/// light; it stands before a floor and a wall, on which the sun casts its shadow.
inline Scene alpha_scene(const std::filesystem::path& folder, const std::string& mode) {
    const std::string material =
        R"("pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0,
            "extensions": {"KHR_texture_transform": {"scale": [2, 3], "rotation": 0.4, "offset": [0.1, 0.2]}}}},
           "emissiveFactor": [0.2, 0.1, 0], "emissiveTexture": {"index": 0, "texCoord": 1},
           "normalTexture": {"index": 1, "texCoord": 1})" +
        mode;
    const std::string color =
        rgba_png(8, 8, [](int x, int y) { return glm::ivec4(90 + 20 * y, 220 - 10 * x, 150, 36 * x); });
    const std::string bumps =
        png_of(4, 4, [](int x, int y) { return glm::ivec3(100 + 18 * x, 150 - 14 * y, 220); });
    write_text(folder / "model.gltf",
               textured_quad(material, {.more_uvs = "mirrored", .pictures = {color, bumps}}).text());
    write_text(folder / "scene.json", R"({ "aftershade": 1, "size": [64, 36], "background": [0.1, 0.2, 0.3],
        "camera": { "position": [0.2, 0.9, 3], "target": [0.1, 0.4, 0], "focal_length": "40 mm",
                    "focus_distance": "3 m", "f_number": 4 },
        "shutter": { "angle": 180 }, "ambient": 0.2,
        "materials": { "white": { "albedo": 0.8 } }, "meshes": { "model": { "file": "model.gltf" } },
        "lights": [ { "type": "directional", "position": [1, 2, 3], "intensity": 3 } ],
        "objects": [
          { "shape": "plane", "size": [6, 6], "rotation": [-90, 0, 0], "material": "white" },
          { "shape": "plane", "size": [6, 3], "position": [0, 1.5, -1], "material": "white" },
          { "shape": "mesh", "mesh": "model", "rotation": [0, 25, 0],
            "position": { "keys": { "0": [-0.6, 0, 0], "2": [-0.4, 0.1, 0.1] } } } ] })");
    Diagnostics diagnostics;
    auto scene = read_scene(folder / "scene.json", diagnostics);
    if (!scene) throw std::runtime_error(faults_of(diagnostics));
    return std::move(*scene);
}

inline const std::string kBlend = R"(, "alphaMode": "BLEND")",
                         kMask = R"(, "alphaMode": "MASK", "alphaCutoff": 0.5)";

}  // namespace aftershade::scene::test
