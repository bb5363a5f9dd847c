#include "framework/scene/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string_view>
#include <tuple>
#include <utility>

#include "framework/base/error.h"
#include "framework/file/picture.h"

namespace aftershade::scene {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxScale = 1000;  // of a normal map
constexpr std::size_t kMaxTexels = std::size_t(1) << 27;

TextureWrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::mirror : TextureWrap::repeat;
}

class MaterialReader {
public:
    MaterialReader(const fs::path& path, const tinygltf::Model& model, std::vector<std::string>& warnings)
        : path_(path), model_(model), warnings_(warnings) {}

    Material read(std::size_t index) {
        const tinygltf::Material& source = model_.materials[index];
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        place_ = fmt::format("material {}{}", index, source.name.empty() ? "" : " '" + source.name + "'");
        Material material;
        material.name = source.name;
        material.albedo = material.albedo_2 = color("baseColorFactor", pbr.baseColorFactor, 4);
        material.metallic = share("metallicFactor", pbr.metallicFactor);
        material.roughness = share("roughnessFactor", pbr.roughnessFactor);
        material.emission = color("emissiveFactor", source.emissiveFactor, 3);
        MaterialMaps& maps = material.maps;
        maps.base_color = map("baseColorTexture", pbr.baseColorTexture, TexelValues::srgb);
        maps.metallic_roughness =
            map("metallicRoughnessTexture", pbr.metallicRoughnessTexture, TexelValues::linear);
        maps.emission = map("emissiveTexture", source.emissiveTexture, TexelValues::srgb);
        maps.occlusion = map("occlusionTexture", source.occlusionTexture, TexelValues::linear);
        maps.normal = map("normalTexture", source.normalTexture, TexelValues::normal);
        maps.occlusion_strength = share("occlusionTexture.strength", source.occlusionTexture.strength);
        maps.normal_scale = source.normalTexture.scale;
        if (!(std::abs(maps.normal_scale) <= kMaxScale))
            fault(fmt::format("normalTexture.scale is {}, not -{} to {}", maps.normal_scale, kMaxScale,
                              kMaxScale));
        if (!source.alphaMode.empty() && source.alphaMode != "OPAQUE")
            warn("alphaMode " + source.alphaMode + " is not drawn: the surface is opaque");
        return material;
    }

private:
    [[noreturn]] void fault(const std::string& text) const { fail_gltf(path_, place_ + ": " + text); }
    void warn(const std::string& text) { warnings_.push_back(path_.string() + ": " + place_ + ": " + text); }

    double share(const char* key, double value) const {
        if (!(value >= 0 && value <= 1)) fault(fmt::format("{} is {}, not 0 to 1", key, value));
        return value;
    }

    /// The first three of `count` numbers.
    glm::dvec3 color(const char* key, const std::vector<double>& values, std::size_t count) const {
        if (values.size() != count)
            fault(fmt::format("{} has {} numbers, not {}", key, values.size(), count));
        return {share(key, values[0]), share(key, values[1]), share(key, values[2])};
    }

    template <class Info>
    MaterialMaps::Map map(const std::string& key, const Info& info, TexelValues values) {
        if (info.index == -1) return nullptr;
        if (info.texCoord != 0) {
            warn(fmt::format("{} has texture coordinates set {} and is not drawn; put it on set 0", key,
                             info.texCoord));
            return nullptr;
        }
        if (info.extensions.contains("KHR_texture_transform"))
            warn(key + ": KHR_texture_transform is not applied; bake it into the texture coordinates");
        if (info.index < 0 || std::size_t(info.index) >= model_.textures.size())
            fault(fmt::format("{} is texture {}, the file has {}", key, info.index, model_.textures.size()));
        const tinygltf::Texture& texture = model_.textures[std::size_t(info.index)];
        const std::string place = fmt::format("{}, texture {}", key, info.index);
        if (texture.source == -1) fault(place + " has no image of PNG or JPEG; export one");
        if (texture.source < 0 || std::size_t(texture.source) >= model_.images.size())
            fault(fmt::format("{} is of image {}, the file has {}", place, texture.source,
                              model_.images.size()));
        return decoded(texture.source, values, sampling_of(place, texture.sampler));
    }

    TextureSampling sampling_of(const std::string& place, int index) const {
        if (index == -1) return {};
        if (index < 0 || std::size_t(index) >= model_.samplers.size())
            fault(fmt::format("{} has sampler {}, the file has {}", place, index, model_.samplers.size()));
        const tinygltf::Sampler& sampler = model_.samplers[std::size_t(index)];
        return {wrap_of(sampler.wrapS), wrap_of(sampler.wrapT),
                sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST};
    }

    MaterialMaps::Map decoded(int image, TexelValues values, const TextureSampling& sampling) {
        MaterialMaps::Map& made = made_[{image, values, sampling.wrap_u, sampling.wrap_v, sampling.nearest}];
        if (!made) {
            const Image& stored = stored_image(image);
            texels_ += std::size_t(stored.width()) * std::size_t(stored.height());
            if (texels_ > kMaxTexels)
                fault(fmt::format("the textures have more than {} texels; scale them down", kMaxTexels));
            made = std::make_shared<const SurfaceTexture>(stored, values, sampling);
        }
        return made;
    }

    const Image& stored_image(int index) {
        if (index == last_index_) return last_image_;
        const std::string name = fmt::format("{}: image {}", path_.string(), index);
        try {
            last_image_ = decode_picture(name, bytes_of(index));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::usage) throw;
            throw Error(ErrorKind::usage, error.what());
        }
        last_index_ = index;
        return last_image_;
    }

    /// tinygltf checks no bounds of a bufferView with an image, and not every version checks the indices.
    std::string_view bytes_of(int index) const {
        const tinygltf::Image& image = model_.images[std::size_t(index)];
        const auto text = [](const std::vector<unsigned char>& bytes, std::size_t at, std::size_t count) {
            return std::string_view(reinterpret_cast<const char*>(bytes.data()) + at, count);
        };
        const auto image_fault = [&](const std::string& what) {
            fail_gltf(path_, fmt::format("image {} {}", index, what));
        };
        if (image.bufferView == -1) {
            if (image.image.empty() && image.uri.starts_with("data:"))
                image_fault("is a data URI of a type that is not read; save it as image/png or image/jpeg");
            if (image.image.empty())
                image_fault(fmt::format("'{}': {}", image.uri, gltf_file_fault(path_, image.uri)));
            return text(image.image, 0, image.image.size());
        }
        if (image.bufferView < 0 || std::size_t(image.bufferView) >= model_.bufferViews.size())
            image_fault(fmt::format("is in bufferView {}, the file has {}", image.bufferView,
                                    model_.bufferViews.size()));
        const tinygltf::BufferView& view = model_.bufferViews[std::size_t(image.bufferView)];
        if (view.buffer < 0 || std::size_t(view.buffer) >= model_.buffers.size())
            image_fault(fmt::format("is in buffer {}, the file has {}", view.buffer, model_.buffers.size()));
        const std::vector<unsigned char>& bytes = model_.buffers[std::size_t(view.buffer)].data;
        if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
            image_fault(fmt::format("in bufferView {} ends outside its buffer of {} bytes", image.bufferView,
                                    bytes.size()));
        return text(bytes, view.byteOffset, view.byteLength);
    }

    using Key = std::tuple<int, TexelValues, TextureWrap, TextureWrap, bool>;

    const fs::path& path_;
    const tinygltf::Model& model_;
    std::vector<std::string>& warnings_;
    std::string place_;
    int last_index_ = -1;
    Image last_image_;  // one alone: as floats it has up to 16 bytes a texel
    std::map<Key, MaterialMaps::Map> made_;
    std::size_t texels_ = 0;
};

}  // namespace

std::vector<Material> gltf_materials(const fs::path& path, const tinygltf::Model& model,
                                     std::vector<std::string>& warnings) {
    MaterialReader reader(path, model, warnings);
    std::vector<Material> materials;
    std::vector<bool> is_used(model.materials.size());
    for (const tinygltf::Mesh& mesh : model.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            if (primitive.material >= 0 && std::size_t(primitive.material) < is_used.size())
                is_used[std::size_t(primitive.material)] = true;
    for (std::size_t i = 0; i < model.materials.size(); ++i)
        materials.push_back(is_used[i] ? reader.read(i) : Material());
    return materials;
}

}  // namespace aftershade::scene
