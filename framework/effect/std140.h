// Lays values out as GLSL's std140 does (OpenGL 4.5 core specification, section 7.6.2.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace aftershade {

class Std140Writer {
public:
    void add(float value) { add_scalar(value); }
    void add(std::int32_t value) { add_scalar(value); }
    void add(std::uint32_t value) { add_scalar(value); }
    /// vec2 aligns to 8 bytes, vec3 and vec4 to 16.
    void add(std::span<const float> vector) {
        align(vector.size() == 2 ? 8 : 16);
        for (const float value : vector) append(value);
    }
    /// Padded to 16 bytes, as a block's size is.
    std::vector<std::byte> finish() {
        align(16);
        return bytes_;
    }

private:
    template <typename T>
    void add_scalar(T value) {
        align(sizeof(T));
        append(value);
    }
    template <typename T>
    void append(T value) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
    }
    void align(std::size_t to) { bytes_.resize((bytes_.size() + to - 1) / to * to); }
    std::vector<std::byte> bytes_;
};

}  // namespace aftershade
