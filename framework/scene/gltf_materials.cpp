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
constexpr double kMaxTransform = 1e6;
constexpr std::size_t kMaxTexels = std::size_t(1) << 27;

TextureWrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::mirror : TextureWrap::repeat;
}

class MaterialReader {
public:
    MaterialReader(const fs::path& path, const tinygltf::Model& model) : path_(path), model_(model) {}

    Material read(std::size_t index) {
        const tinygltf::Material& source = model_.materials[index];
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        place_ = fmt::format("material {}{}", index, source.name.empty() ? "" : " '" + source.name + "'");
        channels_.clear();
        Material material;
        material.name = source.name;
        material.albedo = material.albedo_2 = color("baseColorFactor", pbr.baseColorFactor, 4);
        material.metallic = share("metallicFactor", pbr.metallicFactor);
        material.roughness = share("roughnessFactor", pbr.roughnessFactor);
        material.emission = color("emissiveFactor", source.emissiveFactor, 3);
        MaterialMaps& maps = material.maps;
        const bool by_alpha =
            source.alphaMode == "BLEND" || (source.alphaMode == "MASK" && source.alphaCutoff > 0);
        maps.base_color = map("baseColorTexture", pbr.baseColorTexture, TexelValues::srgb, by_alpha);
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
        read_alpha(source, material);
        return material;
    }
    /// The channels of the material that was read last, from channel 1 on.
    const std::vector<UvChannel>& channels() const { return channels_; }

private:
    [[noreturn]] void fault(const std::string& text) const { fail_gltf(path_, place_ + ": " + text); }

    /// glTF 2.0, 3.9.4.
    void read_alpha(const tinygltf::Material& source, Material& material) const {
        const double factor =
            share("the alpha of baseColorFactor", source.pbrMetallicRoughness.baseColorFactor[3]);
        if (source.alphaMode == "BLEND") {
            material.opacity = factor;
            // Exporters write BLEND for textures without alpha, too.
            const MaterialMap& color = material.maps.base_color;
            material.blends = color && !color.texture->is_opaque();
        } else if (source.alphaMode == "MASK") {
            if (!(source.alphaCutoff >= 0 && std::isfinite(source.alphaCutoff)))
                fault(fmt::format("alphaCutoff is {}, not 0 or more", source.alphaCutoff));
            // A little less, so that single and double precision choose alike where alpha is the cutoff.
            if (source.alphaCutoff > 0) material.alpha_cutoff = source.alphaCutoff / factor * (1 - 1e-6);
        } else if (!source.alphaMode.empty() && source.alphaMode != "OPAQUE") {
            fault("alphaMode is '" + source.alphaMode + "', not OPAQUE, MASK or BLEND");
        }
    }

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
    MaterialMaps::Map map(const std::string& key, const Info& info, TexelValues values,
                          bool by_alpha = false) {
        if (info.index == -1) return {};
        if (info.index < 0 || std::size_t(info.index) >= model_.textures.size())
            fault(fmt::format("{} is texture {}, the file has {}", key, info.index, model_.textures.size()));
        const tinygltf::Texture& texture = model_.textures[std::size_t(info.index)];
        const std::string place = fmt::format("{}, texture {}", key, info.index);
        if (texture.source == -1) fault(place + " has no image of PNG or JPEG; export one");
        if (texture.source < 0 || std::size_t(texture.source) >= model_.images.size())
            fault(fmt::format("{} is of image {}, the file has {}", place, texture.source,
                              model_.images.size()));
        UvChannel channel{info.texCoord};
        if (const auto found = info.extensions.find("KHR_texture_transform"); found != info.extensions.end())
            channel = transformed(key, channel, found->second);
        if (channel.set < 0)
            fault(fmt::format("{} has texture coordinates set {}, not 0 or more", key, channel.set));
        TextureSampling sampling = sampling_of(place, texture.sampler);
        sampling.by_alpha = by_alpha;
        return {decoded(texture.source, values, sampling), number_of(channel)};
    }

    int number_of(const UvChannel& channel) {
        if (channel == UvChannel()) return 0;
        const auto found = std::find(channels_.begin(), channels_.end(), channel);
        const int number = int(found - channels_.begin()) + 1;
        if (found == channels_.end()) channels_.push_back(channel);
        return number;
    }

    double number_in(const std::string& key, const tinygltf::Value& value) const {
        const double number = value.IsNumber() ? value.GetNumberAsDouble() : kMaxTransform * 2;
        if (!(std::abs(number) <= kMaxTransform))
            fault(fmt::format("{} is not a number from -{} to {}", key, kMaxTransform, kMaxTransform));
        return number;
    }

    glm::dvec2 pair_in(const std::string& key, const tinygltf::Value& value) const {
        if (!value.IsArray() || value.ArrayLen() != 2) fault(key + " is not two numbers");
        return {number_in(key, value.Get(0)), number_in(key, value.Get(1))};
    }

    /// Scale, then a turn from +u to -v, which is anticlockwise as the picture lies, then the offset.
    UvChannel transformed(const std::string& key, UvChannel channel, const tinygltf::Value& extension) const {
        const std::string place = key + ".KHR_texture_transform.";
        const glm::dvec2 scale =
            extension.Has("scale") ? pair_in(place + "scale", extension.Get("scale")) : glm::dvec2(1);
        const glm::dvec2 offset =
            extension.Has("offset") ? pair_in(place + "offset", extension.Get("offset")) : glm::dvec2(0);
        const double angle_rad =
            extension.Has("rotation") ? number_in(place + "rotation", extension.Get("rotation")) : 0;
        if (extension.Has("texCoord")) {
            const double set = number_in(place + "texCoord", extension.Get("texCoord"));
            if (set != std::floor(set))
                fault(fmt::format("{}texCoord is {}, not a whole number", place, set));
            channel.set = int(set);
        }
        const double c = std::cos(angle_rad), s = std::sin(angle_rad);
        channel.from_set = glm::dmat3x2(scale.x * glm::dvec2(c, -s), scale.y * glm::dvec2(s, c), offset);
        return channel;
    }

    TextureSampling sampling_of(const std::string& place, int index) const {
        if (index == -1) return {};
        if (index < 0 || std::size_t(index) >= model_.samplers.size())
            fault(fmt::format("{} has sampler {}, the file has {}", place, index, model_.samplers.size()));
        const tinygltf::Sampler& sampler = model_.samplers[std::size_t(index)];
        return {wrap_of(sampler.wrapS), wrap_of(sampler.wrapT),
                sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST};
    }

    std::shared_ptr<const SurfaceTexture> decoded(int image, TexelValues values,
                                                  const TextureSampling& sampling) {
        const auto made_of = [&](bool by_alpha) -> std::shared_ptr<const SurfaceTexture>& {
            return made_[{image, values, sampling.wrap_u, sampling.wrap_v, sampling.nearest, by_alpha}];
        };
        auto& made = made_of(sampling.by_alpha);
        // Where alpha is 1, all colours count alike.
        if (const auto& other = made_of(!sampling.by_alpha); !made && other && other->is_opaque())
            made = other;
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

    using Key = std::tuple<int, TexelValues, TextureWrap, TextureWrap, bool, bool>;

    const fs::path& path_;
    const tinygltf::Model& model_;
    std::string place_;
    std::vector<UvChannel> channels_;
    int last_index_ = -1;
    Image last_image_;  // one alone: as floats it has up to 16 bytes a texel
    std::map<Key, std::shared_ptr<const SurfaceTexture>> made_;
    std::size_t texels_ = 0;
};

}  // namespace

GltfMaterials gltf_materials(const fs::path& path, const tinygltf::Model& model) {
    MaterialReader reader(path, model);
    GltfMaterials result;
    std::vector<bool> is_used(model.materials.size());
    for (const tinygltf::Mesh& mesh : model.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            if (primitive.material >= 0 && std::size_t(primitive.material) < is_used.size())
                is_used[std::size_t(primitive.material)] = true;
    for (std::size_t i = 0; i < model.materials.size(); ++i) {
        result.materials.push_back(is_used[i] ? reader.read(i) : Material());
        result.channels.push_back(is_used[i] ? reader.channels() : std::vector<UvChannel>());
    }
    return result;
}

}  // namespace aftershade::scene
