// Alpha, further sets of texture coordinates and KHR_texture_transform of glTF, against closed forms.
#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "framework/scene/triangulate.h"
#include "framework/scene/visibility.h"
#include "tests/scene/alpha_file.h"

namespace aftershade::scene {
namespace {

using namespace test;

constexpr int kSide = 8;

/// Texels of 1 px in the picture of the quad: alpha grows with x, red with y.
glm::ivec4 graded(int x, int y) {
    return {30 * y, 100, 50, 32 * x};
}

Capture graded_capture(const std::string& mode, const std::string& scene = "") {
    const std::string material =
        R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0,
            "baseColorFactor": [1, 1, 1, 0.8]})" +
        mode;
    const std::string png = rgba_png(kSide, kSide, graded);
    return capture_of(textured_quad(material, {.pictures = {png}}).text(), kSide, scene);
}

/// By alpha, the light behind the quad and its own.
double expected_red(double alpha, int y) {
    const double own = decode_srgb(30 * y / 255.0) * 0.5;
    return alpha * own + (1 - alpha) * 0.25;
}

const std::string kAround = R"("ambient": 0.5, "background": 0.25,)";

TEST(GltfAlpha, OfBlendIsTheOpacityTimesTheTexturesAlpha) {
    const Capture capture = graded_capture(R"(, "alphaMode": "BLEND")", kAround);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            EXPECT_NEAR(pixel_of(capture, "color", x, y).x, expected_red(0.8 * 32 * x / 255.0, y), 1e-5)
                << x << " " << y;
}

TEST(GltfAlpha, OfMaskCutsHolesWhereItIsBelowTheCutoff) {
    // 0.8 * 32 x / 255 is 0.4 at x = 4, less than a hundredth above.
    const Capture capture = graded_capture(R"(, "alphaMode": "MASK", "alphaCutoff": 0.4)", kAround);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            EXPECT_NEAR(pixel_of(capture, "color", x, y).x, expected_red(x >= 4 ? 1 : 0, y), 1e-5)
                << x << " " << y;
            EXPECT_EQ(std::isinf(capture.images.at("depth").at(x, y, 0)), x < 4) << x << " " << y;
            EXPECT_EQ(capture.images.at("object_id").uint_at(x, y, 0), x >= 4 ? 1u : 0u) << x << " " << y;
        }
    const Capture by_default = graded_capture(R"(, "alphaMode": "MASK")", kAround);
    EXPECT_TRUE(std::isinf(by_default.images.at("depth").at(4, 3, 0))) << "0.4016 is below 0.5";
    EXPECT_FALSE(std::isinf(by_default.images.at("depth").at(5, 3, 0))) << "0.502 is not";
}

TEST(GltfAlpha, OfATextureThatIsOpaqueBlendsNothing) {
    const auto blends = [](int alpha) {
        const TemporaryFolder folder;
        const std::string png = rgba_png(2, 2, [&](int, int) { return glm::ivec4(90, 90, 90, alpha); });
        const std::string material =
            R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "BLEND")";
        write_text(folder / "model.gltf", textured_quad(material, {.pictures = {png}}).text());
        return quad_scene(folder.path(), 2).has_transparency();
    };
    EXPECT_FALSE(blends(255));
    EXPECT_TRUE(blends(254));
}

TEST(GltfAlpha, OfOpaqueAndOfFactorsAloneNeedNoTexture) {
    const Capture opaque = graded_capture("", kAround);
    EXPECT_NEAR(pixel_of(opaque, "color", 0, 3).x, expected_red(1, 3), 1e-5);
    const auto of = [&](const std::string& mode) {
        const std::string material =
            R"("pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.4, 0.4, 0.3], "metallicFactor": 0}, )" +
            mode;
        const std::string unused = png_of({0, 0, 0});
        return pixel_of(capture_of(textured_quad(material, {.pictures = {unused}}).text(), 2, kAround),
                        "color", 0, 0)
            .x;
    };
    EXPECT_NEAR(of(R"("alphaMode": "BLEND")"), 0.3 * 0.4 * 0.5 + 0.7 * 0.25, 1e-6);
    EXPECT_NEAR(of(R"("alphaMode": "MASK", "alphaCutoff": 0.3)"), 0.4 * 0.5, 1e-6);
    EXPECT_NEAR(of(R"("alphaMode": "MASK", "alphaCutoff": 0.31)"), 0.25, 1e-6);
    EXPECT_NEAR(of(R"("alphaMode": "MASK", "alphaCutoff": 0)"), 0.4 * 0.5, 1e-6);
}

/// Colour and alpha of a texel, by a hash of its place.
glm::ivec4 speckled(int x, int y) {
    const unsigned hash = unsigned(x * 7919 + y * 104729) * 2654435761u;
    return {hash >> 24, hash >> 16 & 255, hash >> 8 & 255, hash >> 5 & 255};
}

Capture speckled_capture(int texels, const std::string& mode, const std::function<glm::ivec4(int, int)>& of) {
    const std::string material =
        R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0})" + mode;
    return capture_of(textured_quad(material, {.pictures = {rgba_png(texels, texels, of)}}).text(), kSide,
                      kAround);
}

TEST(GltfAlpha, OfBlendWeighsTheColoursOfAPixelsTexels) {
    constexpr int kBlock = 8;
    const Capture capture = speckled_capture(kSide * kBlock, R"(, "alphaMode": "BLEND")", speckled);
    for (int i = 0; i < kSide * kSide; ++i) {
        glm::dvec3 light(0);
        for (int k = 0; k < kBlock * kBlock; ++k) {
            const glm::ivec4 texel =
                speckled(i % kSide * kBlock + k % kBlock, i / kSide * kBlock + k / kBlock);
            const double alpha = texel.w / 255.0;
            for (int c = 0; c < 3; ++c)
                light[c] += alpha * decode_srgb(texel[c] / 255.0) * 0.5 + (1 - alpha) * 0.25;
        }
        expect_near(pixel_of(capture, "color", i % kSide, i / kSide), light / double(kBlock * kBlock), 0.003);
    }
}

/// Red leaves with green behind their outlines: near, where four texels are blended, and far away.
TEST(GltfAlpha, OfBlendAndMaskHideTheColoursOfTexelsWithoutAlpha) {
    const auto leaf = [](int x, int y) {
        return (x + y) % 2 == 0 ? glm::ivec4(255, 0, 0, 255) : glm::ivec4(0, 255, 0, 0);
    };
    for (const char* mode : {R"(, "alphaMode": "BLEND")", R"(, "alphaMode": "MASK", "alphaCutoff": 0.4)"})
        for (const int texels : {2, 4, 64}) {
            const Capture capture = speckled_capture(texels, mode, leaf);
            for (int i = 0; i < kSide * kSide; ++i) {
                const auto albedo = pixel_of(capture, "albedo", i % kSide, i / kSide);
                EXPECT_LT(albedo.y, 0.001) << mode << texels;
                if (texels == 64) EXPECT_GT(albedo.x, 0.99) << mode;
            }
        }
    const Capture opaque = speckled_capture(64, "", leaf);
    EXPECT_NEAR(pixel_of(opaque, "albedo", 3, 3).y, 0.5, 0.003) << "alpha is ignored there";
}

/// The materials of a mesh are collected once, not once for each of its objects.
TEST(GltfAlpha, OfCopiesIsThatOfTheirMeshUnlessTheyHaveAMaterial) {
    const auto geometry_s = [](std::size_t copies) {
        Scene scene;
        scene.materials.resize(3);
        scene.materials[1].blends = true;
        Mesh& mesh = scene.meshes.emplace_back();
        mesh.vertices.resize(3);
        mesh.triangles.resize(20'000, {0, 1, 2});
        mesh.materials.resize(mesh.triangles.size(), 1);
        scene.objects.resize(copies);
        for (Object& object : scene.objects) object.shape = {ShapeKind::mesh, {}, 0};
        for (std::size_t i = 0; i < copies; ++i) scene.objects[i].has_mesh_materials = i % 3 != 2;
        const std::clock_t start = std::clock();
        const Geometry geometry(scene);
        const double time_s = double(std::clock() - start) / CLOCKS_PER_SEC;
        for (std::size_t i = 0; i < copies; ++i)
            EXPECT_EQ(geometry.alpha_of(i).is_mixed, scene.objects[i].has_mesh_materials) << i;
        return time_s;
    };
    EXPECT_LT(geometry_s(10'000), 4 * geometry_s(1) + 0.05);
}

/// The quad of alpha 0 in its left half and `right` in the other, between the sun and a floor that the camera
/// sees.
Scene shadow_scene(const std::filesystem::path& folder, const std::string& mode, int right,
                   const std::string& light) {
    const std::string material =
        R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}, )" + mode;
    const std::string png =
        rgba_png(2, 1, [&](int x, int) { return glm::ivec4(255, 255, 255, x == 0 ? 0 : right); });
    write_text(folder / "model.gltf",
               textured_quad(material, {.sampler = R"("magFilter": 9728)", .pictures = {png}}).text());
    write_text(folder / "scene.json", R"({ "aftershade": 1, "size": [8, 8],
        "camera": { "position": [0.5, 0.5, -1], "target": [0.5, 0.5, -3], "focal_length": "72 mm" },
        "materials": { "white": { "albedo": 1, "specular": 0 } },
        "meshes": { "model": { "file": "model.gltf" } }, )" +
                                          light + R"(
        "objects": [ { "shape": "plane", "size": [9, 9], "position": [0.5, 0.5, -3], "material": "white" },
                     { "shape": "mesh", "mesh": "model" } ] })");
    Diagnostics diagnostics;
    auto scene = read_scene(folder / "scene.json", diagnostics);
    if (!scene) throw std::runtime_error(faults_of(diagnostics));
    return std::move(*scene);
}

TEST(GltfAlpha, LetsShadowRaysThrough) {
    const std::string sun =
        R"("lights": [ { "type": "directional", "position": [0, 0, 1], "intensity": 2 } ],)";
    for (const auto& [mode, alpha, share] : {std::tuple(R"("alphaMode": "MASK")", 255, 0.0),
                                             {R"("alphaMode": "MASK")", 100, 1.0},
                                             {R"("alphaMode": "BLEND")", 51, 0.8},
                                             {R"("alphaMode": "OPAQUE")", 51, 0.0}}) {
        const TemporaryFolder folder;
        const Scene scene = shadow_scene(folder.path(), mode, alpha, sun);
        const Capture capture = SceneRenderer(scene, 8, 8, 1).render_capture(1);
        const bool is_opaque = std::string(mode).find("OPAQUE") != std::string::npos;
        EXPECT_NEAR(pixel_of(capture, "irradiance", 1, 4).x, (is_opaque ? 0 : 2) / std::numbers::pi, 1e-6)
            << mode;
        EXPECT_NEAR(pixel_of(capture, "irradiance", 6, 4).x, share * 2 / std::numbers::pi, 1e-6) << mode;
    }
}

TEST(GltfAlpha, LetsAmbientRaysThrough) {
    const std::string sky = R"("ambient": 1, "ambient_rays": 64,)";
    const auto mean = [&](const std::string& mode, int alpha) {
        const TemporaryFolder folder;
        const Scene scene = shadow_scene(folder.path(), mode, alpha, sky);
        const Capture capture = SceneRenderer(scene, 8, 8, 1).render_capture(1);
        double sum = 0;
        for (int i = 0; i < 64; ++i) sum += pixel_of(capture, "irradiance", i % 8, i / 8).x;
        return sum / 64;
    };
    const double whole = 1 - mean(R"("alphaMode": "OPAQUE")", 255);
    EXPECT_GT(whole, 0.01);
    EXPECT_NEAR(1 - mean(R"("alphaMode": "MASK")", 255), whole / 2, 0.1 * whole);
    EXPECT_NEAR(1 - mean(R"("alphaMode": "BLEND")", 102), 0.4 * whole / 2, 0.05 * whole);
}

TEST(GltfAlpha, OfEachRendererIsTheSame) {
    // Memoised light, lists and light at every sample against rays through pixels.
    for (const char* mode : {R"(, "alphaMode": "BLEND")", R"(, "alphaMode": "MASK", "alphaCutoff": 0.4)"}) {
        const TemporaryFolder folder;
        write_text(folder / "model.gltf", graded_quad(mode).text());
        const Scene scene = triangulated(quad_scene(folder.path(), 16, kAround));
        const SceneRenderer renderer(scene, 16, 16, 1);
        TruthSettings truth;
        truth.kinds = {.lens = true, .shutter = true, .antialias = true};
        truth.samples = 64;
        truth.method = TruthMethod::interleaved;
        const Image expected = renderer.render_truth(1, truth);
        VisibilitySettings settings;
        settings.samples = 64;
        for (const auto& [visibility, transparency, limit] :
             {std::tuple(Visibility::supersampled, Transparency::sorted, 1e-6),
              {Visibility::memoised, Transparency::lists, 0.02},
              {Visibility::memoised, Transparency::stochastic, 0.08},
              {Visibility::supersampled, Transparency::stochastic, 0.08}}) {
            settings.visibility = visibility;
            settings.transparency.transparency = transparency;
            const Image found = render_visibility(renderer, 1, settings, {}, nullptr).color;
            double worst = 0;
            for (std::size_t i = 0; i < expected.floats().size(); ++i)
                worst = std::max(worst, double(std::abs(expected.floats()[i] - found.floats()[i])));
            EXPECT_LT(worst, limit) << mode << int(visibility) << int(transparency);
        }
    }
}

/// Emission alone, by a texture whose info has these members.
Capture emitted(const std::string& info, const std::string& set_1 = "") {
    const std::string material =
        R"("emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0)" + info + "}";
    const std::string png = png_of(4, 4, [](int x, int y) { return glm::ivec3(60 * x, 60 * y, 0); });
    File file =
        textured_quad(material, {.sampler = R"("magFilter": 9728)", .more_uvs = set_1, .pictures = {png}});
    return capture_of(file.text(), 4);
}

glm::dvec3 texel_of(int x, int y) {
    return {decode_srgb(60 * x / 255.0), decode_srgb(60 * y / 255.0), 0};
}

void expect_emitted(const Capture& capture, const std::function<glm::ivec2(int, int)>& texel) {
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const glm::ivec2 at = texel(x, y);
            expect_near(pixel_of(capture, "emission", x, y), texel_of(at.x, at.y), 1e-6);
        }
}

std::string transform(const std::string& members) {
    return R"(, "extensions": {"KHR_texture_transform": {)" + members + "}}";
}

TEST(GltfTextureTransforms, AreThoseOfTheExtensionsExamples) {
    expect_emitted(emitted(""), [](int x, int y) { return glm::ivec2(x, y); });
    // "The lower left quadrant of the source image, rotated clockwise 90 degrees".
    expect_emitted(emitted(transform(R"("offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5])")),
                   [](int x, int y) { return glm::ivec2(y / 2, 3 - x / 2); });
    // "Inverts the T axis".
    expect_emitted(emitted(transform(R"("offset": [0, 1], "scale": [1, -1])")),
                   [](int x, int y) { return glm::ivec2(x, 3 - y); });
    expect_emitted(emitted(transform(R"("offset": [0.25, 0.5])")),
                   [](int x, int y) { return glm::ivec2((x + 1) % 4, (y + 2) % 4); });
}

TEST(GltfTextureTransforms, AndSetsOfTextureCoordinatesBelongToOneTextureAlone) {
    // Set 1 lies the other way round along u.
    expect_emitted(emitted(R"(, "texCoord": 1)", "mirrored"),
                   [](int x, int y) { return glm::ivec2(3 - x, y); });
    expect_emitted(emitted(transform(R"("texCoord": 1, "offset": [0, 0.25])"), "mirrored"),
                   [](int x, int y) { return glm::ivec2(3 - x, (y + 1) % 4); });
    expect_emitted(emitted(R"(, "texCoord": 1)" + transform(R"("texCoord": 0)"), "mirrored"),
                   [](int x, int y) { return glm::ivec2(x, y); });
}

TEST(GltfTextureTransforms, AreFilteredOverTheirOwnPixels) {
    const std::string png = png_of(64, 64, [](int x, int y) { return glm::ivec3((x + y) % 2 * 255); });
    const std::string material =
        R"("pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0)" +
        transform(R"("scale": [11.3, 9.7], "rotation": 0.3)") + "}}";
    const Capture capture = capture_of(textured_quad(material, {.pictures = {png}}).text(), 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_NEAR(pixel_of(capture, "albedo", x, y).x, 0.5, 0.005) << x << " " << y;
}

TEST(GltfTextureTransforms, OfANormalMapTurnItsTangents) {
    // A quarter turn: the map's +u is the square's -y, as the quad's v grows down.
    const glm::ivec3 texel(200, 160, 230);
    const glm::dvec3 tilted = glm::normalize(glm::dvec3(texel) / 127.5 - 1.0);
    const std::string material =
        R"("normalTexture": {"index": 0)" + transform(R"("rotation": 1.57079632679)") + "}";
    const Capture capture = capture_of(textured_quad(material, {.pictures = {png_of(texel)}}).text(), 4);
    expect_near(pixel_of(capture, "normal", 2, 1), {tilted.y, -tilted.x, tilted.z}, 1e-6);
}

TEST(GltfTextureTransforms, OfACaptureInTextureSpaceAreOfItsTriangle) {
    const std::string material =
        R"("pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0)" +
        transform(R"("offset": [0.25, 0])") + "}}";
    const TemporaryFolder folder;
    const std::string png = png_of(4, 4, [](int x, int y) { return glm::ivec3(60 * x, 60 * y, 0); });
    write_text(folder / "model.gltf", textured_quad(material, {.pictures = {png}}).text());
    const Scene scene = quad_scene(folder.path(), 4);
    const Capture capture = SceneRenderer(scene, 4, 4, 1).render_texture_space(1, 0, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            expect_near(pixel_of(capture, "albedo", x, y), texel_of((x + 1) % 4, y), 1e-5);
}

}  // namespace
}  // namespace aftershade::scene
