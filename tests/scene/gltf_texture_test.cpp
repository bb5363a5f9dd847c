// Materials and textures of glTF files, in captures whose values have closed forms.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "framework/image/srgb.h"
#include "tests/scene/textured_file.h"

namespace aftershade::scene {
namespace {

using namespace test;

/// Other bytes at each texel.
glm::ivec3 any_texel(int x, int y) {
    return {(37 * x + 11 * y) % 256, (5 * x + 91 * y + 40) % 256, (x * y * 13 + 7) % 256};
}

glm::dvec3 light_of(const glm::ivec3& texel) {
    return {decode_srgb(texel.x / 255.0), decode_srgb(texel.y / 255.0), decode_srgb(texel.z / 255.0)};
}

void expect_texels(const Capture& capture, const std::function<glm::ivec3(int, int)>& texels) {
    const Image& albedo = capture.images.at("albedo");
    for (int y = 0; y < albedo.height(); ++y)
        for (int x = 0; x < albedo.width(); ++x)
            expect_near(pixel_of(capture, "albedo", x, y), light_of(texels(x, y)), 1e-5);
}

TEST(GltfTextures, OfOneTexelAPixelGiveTheirTexels) {
    const std::string png = png_of(8, 8, any_texel);
    const std::string data = R"({"uri": "data:image/png;base64,)" + base64(png) + R"("})";
    expect_texels(capture_of(textured_quad(kPainted, {.images = data}).text(), 8), any_texel);
    expect_texels(capture_of(textured_quad(kPainted, {.pictures = {png}}).text(), 8), any_texel);
    expect_texels(capture_of(textured_quad(kPainted, {.pictures = {png}}).binary(), 8), any_texel);
    const TemporaryFolder folder;
    write_text(folder / "a picture.png", png);
    write_text(folder / "model.gltf",
               textured_quad(kPainted, {.images = R"({"uri": "a%20picture.png"})"}).text());
    const Scene scene = quad_scene(folder.path(), 8);
    expect_texels(SceneRenderer(scene, 8, 8, 1).render_capture(1), any_texel);
}

TEST(GltfTextures, AreReadFromJpeg) {
    const std::string jpeg =
        read_text(std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "tests/fuzz/corpus/jpeg/two_halves.jpg");
    const Capture capture = capture_of(textured_quad(kPainted, {.pictures = {jpeg}}).text(), 2);
    // As Pillow wrote them, at quality 95.
    expect_near(pixel_of(capture, "albedo", 0, 0), light_of({200, 40, 20}), 0.03);
    expect_near(pixel_of(capture, "albedo", 1, 0), light_of({20, 60, 180}), 0.03);
}

TEST(GltfTextures, RepeatMirrorOrEndAtTheirEdges) {
    // 3 texels a side, and 9 pixels over three times the picture.
    const std::string png = png_of(3, 3, any_texel);
    const auto repeated = [](int at) { return at % 3; };
    const auto mirrored = [](int at) { return at / 3 % 2 == 1 ? at % 3 : 2 - at % 3; };
    const auto clamped = [](int at) { return std::clamp(at - 3, 0, 2); };
    const auto of = [&](int wrap_s, int wrap_t) {
        const std::string sampler =
            fmt::format(R"("wrapS": {}, "wrapT": {}, "magFilter": 9728)", wrap_s, wrap_t);
        return capture_of(
            textured_quad(kPainted,
                          {.sampler = sampler, .uv_low = {-1, -1}, .uv_high = {2, 2}, .pictures = {png}})
                .text(),
            9);
    };
    expect_texels(of(10497, 33071), [&](int x, int y) { return any_texel(repeated(x), clamped(y)); });
    expect_texels(of(33648, 10497), [&](int x, int y) { return any_texel(mirrored(x), repeated(y)); });
    expect_texels(of(33071, 33648), [&](int x, int y) { return any_texel(clamped(x), mirrored(y)); });
}

TEST(GltfTextures, AreBlendedBetweenTexelsUnlessTheSamplerSaysNearest) {
    const std::string png = png_of(2, 1, [](int x, int) { return glm::ivec3(255 * x); });
    const auto at = [&](const std::string& sampler, int x) {
        const Capture capture =
            capture_of(textured_quad(kPainted, {.sampler = sampler, .pictures = {png}}).text(), 8);
        return pixel_of(capture, "albedo", x, 3).x;
    };
    EXPECT_NEAR(at("", 3), 0.375, 1e-6) << "7/16 of the picture, an eighth of a texel before its middle";
    EXPECT_NEAR(at(R"("magFilter": 9728)", 3), 0, 1e-6);
    EXPECT_NEAR(at(R"("magFilter": 9728)", 4), 1, 1e-6);
}

TEST(GltfTextures, FromFarAwayAreTheirMeanWithoutMoire) {
    const std::string png = png_of(64, 64, [](int x, int y) { return glm::ivec3((x + y) % 2 * 255); });
    const Capture capture =
        capture_of(textured_quad(kPainted, {.uv_high = {11.3, 9.7}, .pictures = {png}}).text(), 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_NEAR(pixel_of(capture, "albedo", x, y).x, 0.5, 0.005) << x << " " << y;
    // Tilted, a pixel's part of it is up to seven times as long as wide.
    const Capture tilted =
        capture_of(textured_quad(kPainted, {.uv_high = {2.1, 1.9}, .pictures = {png}}).text(), 64, "",
                   R"(, "rotation": [-80, 0, 0], "position": [0, 0.4, 0])");
    int seen = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            if (tilted.images.at("object_id").uint_at(x, y, 0) != 0) {
                ++seen;
                EXPECT_NEAR(pixel_of(tilted, "albedo", x, y).x, 0.5, 0.005) << x << " " << y;
            }
    EXPECT_GT(seen, 200);
}

const std::string kSun =
    R"("lights": [ { "type": "directional", "position": [1, 2, 3], "intensity": 2, "shadows": false } ],)";
const glm::dvec3 kToSun = glm::normalize(glm::dvec3(1, 2, 3));

TEST(NormalMaps, ThatAreFlatChangeNoBit) {
    const Textured flat{.normals = {0.1f, 0, 1, 0, 0.2f, 1, 0.3f, 0, 1, 0, 0, 1},
                        .pictures = {png_of({128, 128, 255})}};
    const Capture with = capture_of(textured_quad(kBumpy, flat).text(), 8, kSun);
    const Capture without = capture_of(textured_quad(R"("alphaMode": "OPAQUE")", flat).text(), 8, kSun);
    for (const auto& [role, image] : with.images)
        if (image.type() == ComponentType::float32)
            EXPECT_TRUE(std::ranges::equal(image.floats(), without.images.at(role).floats())) << role.name();
}

glm::dvec3 normal_of(const glm::ivec3& texel) {
    return glm::normalize(glm::dvec3(texel) / 127.5 - 1.0);
}

TEST(NormalMaps, ThatAreTiltedShadeAsTheTiltedPlaneDoes) {
    const glm::ivec3 texel(200, 160, 230);
    const glm::dvec3 tilted = normal_of(texel);
    const std::vector<float> corner = {float(tilted.x), float(tilted.y), float(tilted.z)};
    std::vector<float> normals;
    for (int i = 0; i < 4; ++i) normals.insert(normals.end(), corner.begin(), corner.end());
    const Capture mapped = capture_of(textured_quad(kBumpy, {.pictures = {png_of(texel)}}).text(), 4, kSun);
    const Capture plane = capture_of(
        textured_quad(R"("alphaMode": "OPAQUE")", {.normals = normals, .pictures = {png_of(texel)}}).text(),
        4, kSun);
    for (const char* role : {"normal", "irradiance", "specular", "color"})
        expect_near(pixel_of(mapped, role, 2, 1), pixel_of(plane, role, 2, 1), 1e-6);
    const double expected = 2 * glm::dot(tilted, kToSun) / std::numbers::pi;
    EXPECT_NEAR(pixel_of(mapped, "irradiance", 2, 1).x, expected, 1e-6);
}

TEST(NormalMaps, TurnWithTheObjectAndItsTexture) {
    const glm::ivec3 texel(200, 160, 230);
    const glm::dvec3 tilted = normal_of(texel);
    const auto normal = [&](const Textured& textured, const std::string& object = "") {
        return pixel_of(capture_of(textured_quad(kBumpy, textured).text(), 4, kSun, object), "normal", 2, 1);
    };
    const std::vector<std::string> pictures = {png_of(texel)};
    expect_near(normal({.uv_low = {1, 0}, .uv_high = {0, 1}, .pictures = pictures}),
                {-tilted.x, tilted.y, tilted.z}, 1e-6);
    expect_near(normal({.uv_low = {0, 1}, .uv_high = {1, 0}, .pictures = pictures}),
                {tilted.x, -tilted.y, tilted.z}, 1e-6);
    expect_near(normal({.pictures = pictures}, R"(, "rotation": [0, 0, 90], "position": [1, 0, 0])"),
                {-tilted.y, tilted.x, tilted.z}, 1e-6);
    // The file's own tangents: u along +y, so that the bitangent is -x; and a mirrored one.
    const std::vector<float> along_y = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1},
                             mirrored = {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1};
    expect_near(normal({.tangents = along_y, .pictures = pictures}), {-tilted.y, tilted.x, tilted.z}, 1e-6);
    expect_near(normal({.tangents = mirrored, .pictures = pictures}), {tilted.y, tilted.x, tilted.z}, 1e-6);
    // A back has the reversed normal: here the square is turned about y and seen from behind.
    const glm::dvec3 behind =
        normal({.pictures = pictures}, R"(, "rotation": [0, 180, 0], "position": [1, 0, 0])");
    expect_near(behind, {tilted.x, -tilted.y, tilted.z}, 1e-6);
}

TEST(NormalMaps, HaveASteepnessThatTheFileScales) {
    const glm::ivec3 texel(200, 160, 230);
    const glm::dvec3 raw = glm::dvec3(texel) / 127.5 - 1.0;
    const Capture capture = capture_of(
        textured_quad(R"("normalTexture": {"index": 0, "scale": 0.5})", {.pictures = {png_of(texel)}}).text(),
        4, kSun);
    expect_near(pixel_of(capture, "normal", 2, 1), glm::normalize(raw * glm::dvec3(0.5, 0.5, 1)), 1e-6);
}

TEST(Tangents, OfACornerWithTwoMirroredHalvesAreTwo) {
    File file;
    // u grows from x = 0 to both sides; the middle corners are shared.
    const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0}, 3);
    const int uvs = file.floats({0, 1, 1, 1, 0, 0, 1, 1}, 2);
    const int normals = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    file.primitive(fmt::format(R"("POSITION": {}, "TEXCOORD_0": {}, "NORMAL": {})", positions, uvs, normals),
                   file.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}), kTriangles, 0);
    const int view = file.view(png_of({128, 128, 255}));
    file.more = fmt::format(R"(, "images": [{{"bufferView": {}, "mimeType": "image/png"}}],
        "textures": [{{"source": 0}}], "materials": [{{{}}}])",
                            view, kBumpy);
    const TemporaryFolder folder;
    write_text(folder / "model.gltf", file.text());
    const Mesh mesh = read_gltf_model(folder / "model.gltf").mesh;
    ASSERT_EQ(mesh.vertices.size(), 6u);
    ASSERT_EQ(mesh.tangents.size(), 6u);
    for (std::size_t i = 0; i < 2; ++i)
        for (const std::uint32_t vertex : mesh.triangles[i])
            EXPECT_EQ(mesh.tangents[vertex], i == 0 ? glm::dvec4(1, 0, 0, 1) : glm::dvec4(-1, 0, 0, -1));
}

TEST(Tangents, OfASurfaceOfRevolutionLieAlongItsCircles) {
    const Mesh mesh = read_gltf_model(scenes_folder() / "meshes/urn.glb").mesh;
    ASSERT_EQ(mesh.tangents.size(), mesh.vertices.size());
    double worst = 0, worst_at_seam = 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vertex& vertex = mesh.vertices[i];
        // u grows to the right as seen from outside, which is from +z to +x.
        const glm::dvec3 around = glm::normalize(glm::dvec3(vertex.position.z, 0, -vertex.position.x));
        const double off_deg =
            glm::degrees(std::acos(std::min(glm::dot(around, glm::dvec3(mesh.tangents[i])), 1.0)));
        const bool at_seam = vertex.uv.x < 1e-6 || vertex.uv.x > 1 - 1e-6;
        (at_seam ? worst_at_seam : worst) = std::max(at_seam ? worst_at_seam : worst, off_deg);
        EXPECT_EQ(mesh.tangents[i].w, 1);
    }
    EXPECT_LT(worst, 0.001);
    EXPECT_LT(worst_at_seam, 3.1) << "where the texture ends, the triangles of one side alone count";
}

TEST(GltfMaterials, OfMetalReflectTheirColourAndNothingElse) {
    // Against the highlight of a scene's material with that reflectance.
    const std::string lamp =
        R"("lights": [ { "type": "point", "position": [0.5, 0.6, 1], "intensity": 2, "shadows": false } ],)";
    const std::string material =
        R"("pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.6, 0.6, 1], "metallicFactor": 1, "roughnessFactor": 0.4})";
    const std::string model = textured_quad(material, {.pictures = {png_of({0, 0, 0})}}).text();
    const Capture own = capture_of(model, 8, lamp);
    const Capture expected = capture_of(
        model, 8, lamp + R"("materials": { "mirror": { "albedo": 0, "specular": 0.6, "roughness": 0.4 } },)",
        R"(, "material": "mirror")");
    for (int x = 0; x < 8; ++x) {
        expect_near(pixel_of(own, "color", x, 3), pixel_of(expected, "color", x, 3), 1e-6);
        EXPECT_EQ(pixel_of(own, "albedo", x, 3), glm::dvec3(0));
    }
    EXPECT_GT(pixel_of(own, "specular", 4, 3).x, 0.1);
}

TEST(GltfMaterials, HaveRoughnessInGreenAndMetalInBlue) {
    const std::string material =
        R"("pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.4, 0.2, 1], "roughnessFactor": 0.9,
            "metallicFactor": 0.5, "metallicRoughnessTexture": {"index": 0}})";
    const TemporaryFolder folder;
    write_text(folder / "model.gltf", textured_quad(material, {.pictures = {png_of({9, 51, 102})}}).text());
    const GltfModel model = read_gltf_model(folder / "model.gltf");
    const Finish finish = finish_at(model.materials.at(0), {.uv = {0.5, 0.5}});
    EXPECT_NEAR(finish.roughness, 0.9 * 0.2, 1e-12);
    expect_near(finish.albedo, glm::dvec3(0.8, 0.4, 0.2) * (1 - 0.5 * 0.4), 1e-12);
    expect_near(finish.reflectance, glm::mix(glm::dvec3(0.04), glm::dvec3(0.8, 0.4, 0.2), 0.5 * 0.4), 1e-12);
}

TEST(GltfMaterials, EmitTheirTextureTimesItsFactor) {
    const std::string material = R"("emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 0})";
    const Capture capture =
        capture_of(textured_quad(material, {.pictures = {png_of({200, 100, 50})}}).text(), 4);
    expect_near(pixel_of(capture, "emission", 1, 1), light_of({200, 100, 50}) * glm::dvec3(1, 0.5, 0), 1e-6);
}

TEST(GltfMaterials, HideTheAmbientLightAloneByTheirOcclusion) {
    const std::string material = R"("occlusionTexture": {"index": 0, "strength": 0.5})";
    const std::string model = textured_quad(material, {.pictures = {png_of({51, 255, 255})}}).text();
    const Capture ambient = capture_of(model, 4, R"("ambient": 0.5,)");
    expect_near(pixel_of(ambient, "irradiance", 1, 1), glm::dvec3(0.5 * (1 - 0.5 * 0.8)), 1e-6);
    const Capture lit = capture_of(model, 4, kSun);
    EXPECT_NEAR(pixel_of(lit, "irradiance", 1, 1).x, 2 * kToSun.z / std::numbers::pi, 1e-6);
}

TEST(GltfMaterials, BelongToTrianglesAndYieldToTheObjectsOwn) {
    File file;
    const auto attributes = [&](float x) {
        std::vector<float> positions = {0, 0, 0, 0.5f, 0, 0, 0.5f, 1, 0, 0, 1, 0};
        for (std::size_t i = 0; i < positions.size(); i += 3) positions[i] += x;
        return fmt::format(R"("POSITION": {})", file.floats(positions, 3));
    };
    const int indices = file.indices<std::uint8_t>({0, 1, 2, 0, 2, 3});
    file.primitive(attributes(0), indices, kTriangles, 1);
    file.primitive(attributes(0.5f), indices);
    // An image that is not there matters only to those who draw it.
    file.more = R"(, "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
        {"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 0}}],
        "textures": [{"source": 0}], "images": [{"uri": "missing.png"}])";
    const Capture painted = capture_of(
        file.text(), 8, R"("materials": { "red": { "albedo": [0.7, 0, 0] } },)", R"(, "material": "red")");
    for (const int x : {1, 6}) expect_near(pixel_of(painted, "albedo", x, 4), {0.7, 0, 0}, 1e-6);
    file.more = R"(, "materials": [{},
        {"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 0}}])";
    const Capture own = capture_of(file.text(), 8);
    expect_near(pixel_of(own, "albedo", 1, 4), {0.1, 0.2, 0.3}, 1e-6);
    expect_near(pixel_of(own, "albedo", 6, 4), glm::dvec3(0.8), 1e-6);
}

TEST(GltfTextures, OfACaptureInTextureSpaceAreOfTheirTriangle) {
    const TemporaryFolder folder;
    write_text(folder / "model.gltf",
               textured_quad(kPainted, {.pictures = {png_of(8, 8, any_texel)}}).text());
    const Scene scene = quad_scene(folder.path(), 8);
    expect_texels(SceneRenderer(scene, 8, 8, 1).render_texture_space(1, 0, 8), any_texel);
}

}  // namespace
}  // namespace aftershade::scene
