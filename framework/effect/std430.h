// Where GLSL's std430 puts the members of a structure (OpenGL 4.5 core specification, section 7.6.2.2).
#pragma once

#include <algorithm>
#include <cstddef>

namespace aftershade {

/// Adds members one by one. Sizes and offsets are in bytes.
class Std430Struct {
public:
    /// A member of 1 to 4 components of 4 bytes each; its offset. vec2 aligns to 8, vec3 and vec4 to 16.
    std::size_t add_vector(int components) {
        const std::size_t size = 4 * std::size_t(components);
        return add(size, components == 3 ? 16 : size);
    }
    /// A member that is a structure (or the first element of an array of it).
    std::size_t add_struct(const Std430Struct& member) { return add(member.size(), member.alignment_); }
    /// To the next element of an array of it.
    std::size_t size() const { return rounded(end_, alignment_); }

private:
    static std::size_t rounded(std::size_t value, std::size_t to) { return (value + to - 1) / to * to; }
    std::size_t add(std::size_t size, std::size_t alignment) {
        const std::size_t offset = rounded(end_, alignment);
        end_ = offset + size;
        alignment_ = std::max(alignment_, alignment);
        return offset;
    }
    std::size_t end_ = 0;
    std::size_t alignment_ = 4;
};

}  // namespace aftershade
