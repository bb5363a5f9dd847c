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

/// One accessor whose bytes are known to lie in their buffers.
class GltfValues {
public:
    GltfValues(const std::filesystem::path& path, const tinygltf::Model& model, int index, std::string what,
               std::initializer_list<int> types);
    GltfValues(GltfValues&&) = default;  // the bytes of a copy would be those of the other

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

    struct Layout {
        std::string name;
        int view = -1;
        std::size_t offset = 0;
        std::size_t count = 0;
        std::size_t bytes = 0;   ///< of a value
        std::size_t stride = 0;  ///< 0: as the bufferView has it, or side by side
    };
    std::span<const unsigned char> range(const tinygltf::Model& model, Layout& layout) const;
    void replace_some(const tinygltf::Model& model, const tinygltf::Accessor& accessor, const Layout& all);

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
    std::vector<unsigned char> own_;  ///< of accessors that no bufferView has as they are
    std::span<const unsigned char> bytes_;
    std::size_t stride_ = 0;
    std::size_t count_ = 0;
    int component_ = 0;
    bool normalized_ = false;
};

}  // namespace aftershade::scene
