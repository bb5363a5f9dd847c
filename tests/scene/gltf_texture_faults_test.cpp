// Faults of glTF files' materials: each names the file, the thing and what to do.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "tests/scene/textured_file.h"

namespace aftershade::scene {
namespace {

using namespace test;

std::string texture_fault_of(const std::string& model) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "model");
    write_text(folder / "outside.png", png_of({1, 2, 3}));
    write_text(folder / "model/empty.png", "");
    write_text(folder / "model/picture.webp", "RIFF    WEBP");
    write_text(folder / "model/model.gltf", model);
    try {
        read_gltf_model(folder / "model/model.gltf");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        const std::string text = error.what();
        EXPECT_TRUE(text.starts_with((folder / "model/model.gltf").string() + ": ")) << text;
        return text;
    }
    return "none";
}

struct TextureFault {
    const char* material;
    const char* images;  ///< "" for a good one
    const char* error;
};

const TextureFault kTextureFaults[] = {
    {R"("normalTexture": {"index": 7})", "",
     "material 0 'paint': normalTexture is texture 7, the file has 1"},
    {R"("normalTexture": {"index": 0})", R"({"uri": "not%20there.png"})",
     "/not there.png: no such file (put it there, or give the object a \"material\" of the scene)"},
    {R"("normalTexture": {"index": 0, "scale": 1e300})", "",
     "normalTexture.scale is 1e+300, not -1000 to 1000"},
    {R"("normalTexture": {"index": 0})", R"({"uri": "../outside.png"})", "leads out of the folder"},
    {R"("normalTexture": {"index": 0})", R"({"uri": "picture.webp"})",
     "image 0: neither PNG nor JPEG; save it as one of these"},
    {R"("normalTexture": {"index": 0})", R"({"uri": "data:image/png;base64,iVBORw0KGgoAAAA="})",
     "image 0: not a PNG file that can be read"},
    {R"("normalTexture": {"index": 0})", R"({"bufferView": 99, "mimeType": "image/png"})", "bufferView"},
    {R"("pbrMetallicRoughness": {"metallicFactor": 1.5})", "",
     "material 0 'paint': metallicFactor is 1.5, not 0 to 1"},
    {R"("emissiveFactor": [1, -1, 1])", "", "emissiveFactor is -1, not 0 to 1"},
};

TEST(GltfTextureFaults, AreToldWithTheirPlace) {
    for (const TextureFault& fault : kTextureFaults) {
        Textured textured{.images = fault.images, .pictures = {png_of({1, 2, 3})}};
        const std::string text = texture_fault_of(textured_quad(fault.material, textured).text());
        EXPECT_NE(text.find(fault.error), std::string::npos) << text << "\n  against " << fault.error;
    }
}

TEST(GltfTextureFaults, OfATextureWithoutAnImageOrASamplerAreToldToo) {
    File file = textured_quad(kBumpy, {.pictures = {png_of({1, 2, 3})}});
    const std::string good = file.more;
    const auto with = [&](const std::string& textures) {
        file.more = good;
        const std::string old = R"([{"source": 0, "sampler": 0}])";
        file.more.replace(file.more.find(old), old.size(), textures);
        return texture_fault_of(file.text());
    };
    EXPECT_NE(with(R"([{"sampler": 0}])").find("texture 0 has no image of PNG or JPEG"), std::string::npos);
    EXPECT_NE(with(R"([{"source": 4}])").find("texture 0 is of image 4, the file has 1"), std::string::npos);
    EXPECT_NE(with(R"([{"source": 0, "sampler": 3}])").find("has sampler 3, the file has 1"),
              std::string::npos);
}

TEST(GltfTextureFaults, OfTransformsAndAlphaNameTheirPlace) {
    const auto fault = [](const std::string& material) {
        return texture_fault_of(textured_quad(material, {.pictures = {png_of({1, 2, 3})}}).text());
    };
    const auto with = [](const std::string& transform) {
        return R"("normalTexture": {"index": 0, "extensions": {"KHR_texture_transform": {)" + transform +
               "}}}";
    };
    for (const auto& [material, text] :
         {std::pair(with(R"("scale": [2])"), "normalTexture.KHR_texture_transform.scale is not two numbers"),
          {with(R"("offset": [2, "x"])"), "normalTexture.KHR_texture_transform.offset is not a number from"},
          {with(R"("rotation": 1e30)"), "normalTexture.KHR_texture_transform.rotation is not a number from"},
          {with(R"("texCoord": -1)"), "normalTexture has texture coordinates set -1, not 0 or more"},
          {with(R"("texCoord": 1.7)"),
           "normalTexture.KHR_texture_transform.texCoord is 1.7, not a whole number"},
          {R"("alphaMode": "BLENDED")", "alphaMode is 'BLENDED', not OPAQUE, MASK or BLEND"},
          {R"("alphaMode": "MASK", "alphaCutoff": -1)", "alphaCutoff is -1, not 0 or more"},
          {R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 2]})",
           "the alpha of baseColorFactor is 2, not 0 to 1"}})
        EXPECT_NE(fault(material).find(text), std::string::npos) << fault(material) << "\n  against " << text;
}

TEST(GltfTextureFaults, OfASetThatAPrimitiveLacksAreWarnings) {
    const TemporaryFolder folder;
    const std::string material = R"("emissiveTexture": {"index": 0, "texCoord": 3})";
    File file = textured_quad(material, {.pictures = {png_of({1, 2, 3})}});
    file.nodes = R"({"mesh": 0}, {"mesh": 0, "translation": [2, 0, 0]})";
    file.scenes = R"("scene": 0, "scenes": [{"nodes": [0, 1]}])";
    write_text(folder / "model.gltf", file.text());
    const GltfModel model = read_gltf_model(folder / "model.gltf");
    EXPECT_EQ(model.mesh.triangles.size(), 4u);
    ASSERT_EQ(model.warnings.size(), 1u) << "one for all nodes of the mesh";
    EXPECT_NE(
        model.warnings[0].find("mesh 0 primitive 0 has no TEXCOORD_3, which a texture of its material needs"),
        std::string::npos)
        << model.warnings[0];
}

}  // namespace
}  // namespace aftershade::scene
