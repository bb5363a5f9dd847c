// The values of glTF's accessors; for the sources of this folder.
#pragma once

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/scene/gltf_document.h"

namespace aftershade::scene {

/// One accessor whose bytes are known to lie in their buffer.
class GltfValues {
public:
    GltfValues(const std::filesystem::path& path, const tinygltf::Model& model, int index, std::string what,
               std::initializer_list<int> types)
        : path_(path), what_(std::move(what)) {
        const auto& accessor = element(model.accessors, index, "accessor");
        if (std::find(types.begin(), types.end(), accessor.type) == types.end())
            fault(fmt::format("accessor {} has the wrong type for it", index));
        if (accessor.sparse.isSparse)
            fault(fmt::format("accessor {} is sparse, which is not read: export without it", index));
        const auto& view = element(model.bufferViews, accessor.bufferView, "bufferView");
        const auto& buffer = element(model.buffers, view.buffer, "buffer");
        component_ = accessor.componentType;
        normalized_ = accessor.normalized;
        count_ = accessor.count;
        const int component_bytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(component_));
        const int components = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
        const int stride = accessor.ByteStride(view);
        if (component_bytes <= 0 || components <= 0 || stride < component_bytes * components)
            fault(fmt::format("accessor {} has a component type or a stride that cannot be", index));
        stride_ = std::size_t(stride);
        const std::size_t value_bytes = std::size_t(component_bytes * components);
        if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
            fault(fmt::format("bufferView {} ends outside its buffer of {} bytes", accessor.bufferView,
                              buffer.data.size()));
        const std::size_t limit = view.byteLength;
        const bool fits =
            count_ == 0 || (accessor.byteOffset <= limit && limit - accessor.byteOffset >= value_bytes &&
                            (limit - accessor.byteOffset - value_bytes) / stride_ >= count_ - 1);
        if (!fits)
            fault(fmt::format("the {} values of accessor {} end outside its bufferView of {} bytes", count_,
                              index, limit));
        bytes_ = std::span(buffer.data).subspan(view.byteOffset, limit);
        bytes_ = bytes_.subspan(std::min(accessor.byteOffset, limit));
    }

    std::size_t count() const { return count_; }

    std::uint32_t index(std::size_t i) const {
        switch (component_) {
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return read<std::uint8_t>(i, 0);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read<std::uint16_t>(i, 0);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read<std::uint32_t>(i, 0);
            default:
                fault(
                    fmt::format("component type {} is not allowed for indices (use an unsigned integer type)",
                                component_));
        }
    }

    /// Finite.
    double number(std::size_t i, int component) const {
        switch (component_) {
            case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled<std::int8_t>(i, component);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return scaled<std::uint8_t>(i, component);
            case TINYGLTF_COMPONENT_TYPE_SHORT: return scaled<std::int16_t>(i, component);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return scaled<std::uint16_t>(i, component);
            case TINYGLTF_COMPONENT_TYPE_FLOAT: break;
            default:
                fault(fmt::format("component type {} is not allowed for vertices (use floats)", component_));
        }
        const double value = read<float>(i, component);
        if (!std::isfinite(value)) fault(fmt::format("value {} is not finite", i));
        return value;
    }

    glm::dvec2 vec2(std::size_t i) const { return {number(i, 0), number(i, 1)}; }
    glm::dvec3 vec3(std::size_t i) const { return {number(i, 0), number(i, 1), number(i, 2)}; }

private:
    [[noreturn]] void fault(const std::string& text) const { fail_gltf(path_, what_ + ": " + text); }

    template <class T>
    const T& element(const std::vector<T>& all, int index, const char* kind) const {
        if (index < 0 || std::size_t(index) >= all.size())
            fault(fmt::format("{} {} is not there, the file has {}", kind, index, all.size()));
        return all[std::size_t(index)];
    }

    template <class T>
    T read(std::size_t i, int component) const {
        T value;
        std::memcpy(&value, &bytes_[i * stride_ + std::size_t(component) * sizeof(T)], sizeof(T));
        return value;
    }

    /// glTF 2.0, 3.11: the lowest signed value stands for -1 too.
    template <class T>
    double scaled(std::size_t i, int component) const {
        const double value = read<T>(i, component);
        return normalized_ ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
    }

    const std::filesystem::path& path_;
    std::string what_;
    std::span<const unsigned char> bytes_;
    std::size_t stride_ = 0;
    std::size_t count_ = 0;
    int component_ = 0;
    bool normalized_ = false;
};

}  // namespace aftershade::scene
