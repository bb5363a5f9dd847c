// Triangles of a scene, with what a ray needs to find them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace aftershade::scene {

/// An axis-aligned box; empty as made.
struct Bounds {
    glm::dvec3 low{1e300};
    glm::dvec3 high{-1e300};
    bool empty() const { return low.x > high.x; }
    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Bounds& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
};

/// Bounds of a box's corners after `matrix`.
Bounds transformed(const Bounds& bounds, const glm::dmat4& matrix);

struct Vertex {
    glm::dvec3 position{0};  ///< object space, m
    glm::dvec3 normal{0};    ///< unit length
    glm::dvec2 uv{0};
};

/// [value type]
struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
    /// Materials of the triangles, where the file has them: indices into the file's or the scene's; -1: none.
    std::vector<int> materials = {};
    /// Each vertex's direction of growing u in the normal's plane, unit length; w: the sign of the
    /// bitangent, w * cross(normal, tangent). Length 0: none. Empty without a normal map.
    std::vector<glm::dvec4> tangents = {};
    /// The texture coordinates of the vertices in further channels: channel 1 first. Vertex::uv is channel 0.
    std::vector<std::vector<glm::dvec2>> more_uvs = {};
    Bounds bounds() const;
    glm::dvec2 uv(int channel, std::uint32_t vertex) const {
        return channel == 0 ? vertices[vertex].uv : more_uvs[std::size_t(channel) - 1][vertex];
    }
    /// A copy of a vertex with its texture coordinates, at the end; without its tangent.
    std::uint32_t copy_vertex(std::uint32_t vertex);
};

/// One node of a bounding volume hierarchy in depth-first order, without a stack: a ray that misses the box
/// continues at `skip`; one that hits it tries the `count` items from `first` (a leaf), or continues at the
/// next node (count 0).
struct BvhNode {
    Bounds bounds;
    std::uint32_t skip = 0;  ///< index of the next node that is not below this one; node count at the end
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct Bvh {
    std::vector<BvhNode> nodes;        ///< empty for no items
    std::vector<std::uint32_t> items;  ///< indices into what was given, as the leaves order them
};

/// Splits at the median of the longest side of the centres' bounds; at most `leaf_size` items a leaf. The
/// same boxes give the same tree.
Bvh build_bvh(std::span<const Bounds> items, int leaf_size);

/// A grid over [-width/2, width/2] x [-height/2, height/2] of the xy plane, raised along +z by the sum of
/// amplitude_m * cos(2 pi (x, y) . cycles_per_m + phase_rad); `segments` squares a side, each two triangles;
/// exact normals; uv as a plane's.
struct Wave {
    double amplitude_m = 0;
    glm::dvec2 cycles_per_m{0};
    double phase_rad = 0;
};
Mesh make_height_field(const glm::dvec2& size_m, std::span<const Wave> waves, int segments);

/// The triangles of every node of the default scene (else of all scenes) of a .gltf or .glb file, in world
/// space; flat normals where the file has none; texture coordinates set 0. Materials, skins, animations and
/// cameras are left, and triangles without an area. Throws Error(ErrorKind::usage) that begins with the path:
/// not readable, no triangles, more than 4 million of them, indices out of range, values that are not finite.
Mesh read_gltf(const std::filesystem::path& path);

}  // namespace aftershade::scene
