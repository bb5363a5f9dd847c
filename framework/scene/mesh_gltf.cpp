#include "framework/scene/gltf_document.h"
#include "framework/scene/gltf_materials.h"
#include "framework/scene/gltf_model.h"
#include "framework/scene/gltf_values.h"
#include "framework/scene/mesh.h"
#include "framework/scene/tangents.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace aftershade::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxTriangles = 4'000'000;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class MeshReader {
public:
    /// Triangles have the indices of their materials unless `materials` is null.
    MeshReader(const fs::path& path, const tinygltf::Model& model, const GltfMaterials* materials)
        : path_(path), model_(model), materials_(materials) {
        std::size_t most = 0;
        if (materials)
            for (const auto& channels : materials->channels) most = std::max(most, channels.size());
        mesh_.more_uvs.resize(most);
    }

    Mesh read() {
        visited_.resize(model_.nodes.size());
        for (const int node : roots()) add_tree(node);
        if (mesh_.triangles.empty()) fail_gltf(path_, "has no triangles in its scene");
        if (!mesh_.tangents.empty()) mesh_.tangents.resize(mesh_.vertices.size(), glm::dvec4(0));
        return std::move(mesh_);
    }
    const std::vector<std::string>& warnings() const { return warnings_; }

private:
    struct Placed {
        int node;
        glm::dmat4 world_from_parent;
    };

    std::vector<int> roots() const {
        if (model_.defaultScene != -1) {
            if (model_.defaultScene < 0 || std::size_t(model_.defaultScene) >= model_.scenes.size())
                fail_gltf(path_, fmt::format("its default scene {} is not there, the file has {}",
                                             model_.defaultScene, model_.scenes.size()));
            return model_.scenes[std::size_t(model_.defaultScene)].nodes;
        }
        std::vector<int> nodes;
        for (const tinygltf::Scene& scene : model_.scenes)
            for (const int node : scene.nodes)
                if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
        return nodes;
    }

    void add_tree(int root) {
        std::vector<Placed> open{{root, glm::dmat4(1)}};
        while (!open.empty()) {
            const Placed placed = open.back();
            open.pop_back();
            if (placed.node < 0 || std::size_t(placed.node) >= model_.nodes.size())
                fail_gltf(path_, fmt::format("node {} is not there, the file has {}", placed.node,
                                             model_.nodes.size()));
            if (visited_[std::size_t(placed.node)])
                fail_gltf(path_, fmt::format("node {} stands in two places; nodes form trees", placed.node));
            visited_[std::size_t(placed.node)] = true;
            const tinygltf::Node& node = model_.nodes[std::size_t(placed.node)];
            const glm::dmat4 world_from_node = placed.world_from_parent * parent_from_node(placed.node);
            if (node.mesh != -1) add_mesh(node.mesh, world_from_node);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                open.push_back({*child, world_from_node});
        }
    }

    /// Checks that there are none or `count` numbers, all finite.
    bool has_numbers(int node, const char* key, const std::vector<double>& values, std::size_t count) const {
        if (values.empty()) return false;
        if (values.size() != count)
            fail_gltf(path_,
                      fmt::format("{} of node {} has {} numbers, not {}", key, node, values.size(), count));
        if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
            fail_gltf(path_, fmt::format("{} of node {} is not finite", key, node));
        return true;
    }

    glm::dmat4 parent_from_node(int index) const {
        const tinygltf::Node& node = model_.nodes[std::size_t(index)];
        if (has_numbers(index, "matrix", node.matrix, 16)) return glm::make_mat4(node.matrix.data());
        glm::dmat4 placed(1);
        if (has_numbers(index, "translation", node.translation, 3))
            placed[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1);
        if (has_numbers(index, "rotation", node.rotation, 4)) {
            const auto& q = node.rotation;  // x, y, z, w
            const glm::dquat rotation(q[3], q[0], q[1], q[2]);
            if (!(glm::length(rotation) > 0))
                fail_gltf(path_, fmt::format("rotation of node {} is zero", index));
            placed *= glm::mat4_cast(glm::normalize(rotation));
        }
        if (has_numbers(index, "scale", node.scale, 3))
            for (int axis = 0; axis < 3; ++axis) placed[axis] *= node.scale[std::size_t(axis)];
        return placed;
    }

    void add_mesh(int index, const glm::dmat4& world_from_node) {
        if (index < 0 || std::size_t(index) >= model_.meshes.size())
            fail_gltf(path_,
                      fmt::format("mesh {} is not there, the file has {}", index, model_.meshes.size()));
        const auto& primitives = model_.meshes[std::size_t(index)].primitives;
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const int mode = primitives[i].mode;
            const bool has_triangles = mode == TINYGLTF_MODE_TRIANGLES ||
                                       mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                                       mode == TINYGLTF_MODE_TRIANGLE_FAN;
            if (has_triangles)
                add_primitive(primitives[i], fmt::format("mesh {} primitive {}", index, i), world_from_node);
        }
    }

    std::optional<GltfValues> attribute(const tinygltf::Primitive& primitive, const std::string& place,
                                        const char* name, int type) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return std::nullopt;
        return GltfValues(path_, model_, found->second, place + " " + name, {type});
    }

    void add_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                       const glm::dmat4& world_from_node) {
        const auto positions = attribute(primitive, place, "POSITION", TINYGLTF_TYPE_VEC3);
        if (!positions) fail_gltf(path_, place + " has no POSITION");
        const auto normals = attribute(primitive, place, "NORMAL", TINYGLTF_TYPE_VEC3);
        const auto uvs = attribute(primitive, place, "TEXCOORD_0", TINYGLTF_TYPE_VEC2);
        for (const auto* values : {&normals, &uvs})
            if (*values && (*values)->count() != positions->count())
                fail_gltf(path_, fmt::format("{} has {} positions, but {} {}", place, positions->count(),
                                             (*values)->count(),
                                             values == &normals ? "normals" : "texture coordinates"));
        std::vector<Vertex> vertices(positions->count());
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const glm::dvec4 point = world_from_node * glm::dvec4(positions->vec3(i), 1);
            vertices[i].position = glm::dvec3(point);
            // Values of the file are finite, but what a chain of nodes makes of them may not be.
            if (!std::isfinite(glm::dot(vertices[i].position, vertices[i].position)))
                fail_gltf(path_,
                          fmt::format("{} position {} is not finite where its node puts it", place, i));
            if (uvs) vertices[i].uv = uvs->vec2(i);
        }
        const glm::dmat3 linear(world_from_node);
        if (normals) place_normals(*normals, linear, vertices);
        auto triangles = triangles_of(primitive, place, vertices.size());
        if (glm::determinant(linear) < 0)
            for (auto& triangle : triangles) std::swap(triangle[1], triangle[2]);
        // glTF 2.0, 3.7.2.1: without normals, tangents are ignored.
        const auto tangents = normals && has_normal_map(primitive)
                                  ? attribute(primitive, place, "TANGENT", TINYGLTF_TYPE_VEC4)
                                  : std::nullopt;
        if (tangents && tangents->count() != positions->count())
            fail_gltf(path_, fmt::format("{} has {} positions, but {} tangents", place, positions->count(),
                                         tangents->count()));
        const std::size_t first = mesh_.triangles.size();
        const auto sources = append(vertices, triangles, normals.has_value());
        add_more_uvs(primitive, place, positions->count(), sources);
        if (materials_) mesh_.materials.resize(mesh_.triangles.size(), material_of(primitive, place));
        if (!has_normal_map(primitive)) return;
        if (tangents) place_tangents(*tangents, linear, sources);
        else make_tangents(mesh_, first, material_in(primitive)->maps.normal.channel);
    }

    /// The texture coordinates of the channels that the primitive's material has, for the mesh's last
    /// vertices.
    void add_more_uvs(const tinygltf::Primitive& primitive, const std::string& place, std::size_t count,
                      const std::vector<std::uint32_t>& sources) {
        for (std::size_t i = 0; i < mesh_.more_uvs.size(); ++i) {
            std::vector<glm::dvec2>& uvs = mesh_.more_uvs[i];
            uvs.resize(mesh_.vertices.size(), glm::dvec2(0));
            if (!material_in(primitive)) continue;
            const auto& channels = materials_->channels[std::size_t(primitive.material)];
            if (i >= channels.size()) continue;
            const UvChannel& channel = channels[i];
            const std::string name = fmt::format("TEXCOORD_{}", channel.set);
            const auto values = attribute(primitive, place, name.c_str(), TINYGLTF_TYPE_VEC2);
            if (!values) {
                std::string warning = fmt::format("{}: {} has no {}, which a texture of its material needs",
                                                  path_.string(), place, name);
                if (std::ranges::find(warnings_, warning) == warnings_.end())
                    warnings_.push_back(std::move(warning));
            } else if (values->count() != count)
                fail_gltf(path_, fmt::format("{} has {} positions, but {} values of {}", place, count,
                                             values->count(), name));
            const auto own = uvs.end() - std::ptrdiff_t(sources.size());
            for (std::size_t k = 0; k < sources.size(); ++k)
                own[std::ptrdiff_t(k)] =
                    channel.from_set * glm::dvec3(values ? values->vec2(sources[k]) : glm::dvec2(0), 1);
        }
    }

    /// Null without one.
    const Material* material_in(const tinygltf::Primitive& primitive) const {
        const int index = primitive.material;
        if (!materials_ || index < 0 || index >= int(materials_->materials.size())) return nullptr;
        return &materials_->materials[std::size_t(index)];
    }

    int material_of(const tinygltf::Primitive& primitive, const std::string& place) const {
        if (primitive.material < -1 || primitive.material >= int(materials_->materials.size()))
            fail_gltf(path_, fmt::format("{} has material {}, the file has {}", place, primitive.material,
                                         materials_->materials.size()));
        return primitive.material;
    }

    bool has_normal_map(const tinygltf::Primitive& primitive) const {
        const Material* material = material_in(primitive);
        return material && material->maps.normal;
    }

    /// `sources`: which of the primitive's vertices the mesh's last ones are.
    void place_tangents(const GltfValues& tangents, const glm::dmat3& linear,
                        const std::vector<std::uint32_t>& sources) {
        const double sign = glm::determinant(linear) < 0 ? -1 : 1;
        mesh_.tangents.resize(mesh_.vertices.size() - sources.size(), glm::dvec4(0));
        for (const std::uint32_t source : sources) {
            const glm::dvec3 along =
                linear * glm::dvec3(tangents.number(source, 0), tangents.number(source, 1),
                                    tangents.number(source, 2));
            const double length = glm::length(along);
            const bool usable = std::isfinite(length) && length > 0;
            mesh_.tangents.emplace_back(usable ? along / length : glm::dvec3(0),
                                        tangents.number(source, 3) < 0 ? -sign : sign);
        }
    }

    /// By the cofactors, which are the inverse transpose times the determinant and exist without an inverse.
    static void place_normals(const GltfValues& normals, const glm::dmat3& linear,
                              std::vector<Vertex>& vertices) {
        const double sign = glm::determinant(linear) < 0 ? -1 : 1;
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const glm::dvec3 normal = sign * (cofactors * normals.vec3(i));
            const double length = glm::length(normal);
            const bool usable = std::isfinite(length) && length > 0;
            vertices[i].normal = usable ? normal / length : glm::dvec3(0);
        }
    }

    using Triangles = std::vector<std::array<std::uint32_t, 3>>;

    std::vector<std::uint32_t> indices_of(const tinygltf::Primitive& primitive, const std::string& place,
                                          std::size_t vertex_count) const {
        std::vector<std::uint32_t> indices;
        if (primitive.indices == -1) {
            indices.resize(vertex_count);
            for (std::size_t i = 0; i < vertex_count; ++i) indices[i] = std::uint32_t(i);
            return indices;
        }
        const GltfValues values(path_, model_, primitive.indices, place + " indices", {TINYGLTF_TYPE_SCALAR});
        indices.resize(values.count());
        for (std::size_t i = 0; i < indices.size(); ++i) {
            indices[i] = values.index(i);
            if (indices[i] >= vertex_count)
                fail_gltf(path_, fmt::format("{} index {} is {}, out of range of its {} vertices", place, i,
                                             indices[i], vertex_count));
        }
        return indices;
    }

    /// glTF 2.0, 3.7.2.1, with the order of corners that it gives for strips and fans.
    Triangles triangles_of(const tinygltf::Primitive& primitive, const std::string& place,
                           std::size_t vertex_count) const {
        const auto indices = indices_of(primitive, place, vertex_count);
        const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
        if (list && indices.size() % 3 != 0)
            fail_gltf(path_,
                      fmt::format("{} has {} indices, which is not a multiple of 3", place, indices.size()));
        const std::size_t count =
            list ? indices.size() / 3 : indices.size() - std::min<std::size_t>(indices.size(), 2);
        if (count > kMaxTriangles - mesh_.triangles.size())
            fail_gltf(path_, fmt::format("has more than {} triangles: decimate it", kMaxTriangles));
        Triangles triangles(count);
        for (std::size_t i = 0; i < count; ++i) {
            if (list) triangles[i] = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
            else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN)
                triangles[i] = {indices[i + 1], indices[i + 2], indices[0]};
            else triangles[i] = {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]};
        }
        return triangles;
    }

    /// Adds the triangles that have an area, and the vertices that they use, which it returns.
    std::vector<std::uint32_t> append(std::vector<Vertex>& vertices, const Triangles& triangles,
                                      bool has_normals) {
        std::vector<std::uint32_t> placed(vertices.size(), kNone), sources;
        for (const auto& triangle : triangles) {
            const auto& [a, b, c] = triangle;
            const glm::dvec3 cross = glm::cross(vertices[b].position - vertices[a].position,
                                                vertices[c].position - vertices[a].position);
            const double length = glm::length(cross);
            if (!(length > 0) || !std::isfinite(length)) continue;
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = triangle[corner];
                // A normal of length zero says nothing: as if there were none.
                const bool flat = !has_normals || vertices[vertex].normal == glm::dvec3(0);
                if (flat || placed[vertex] == kNone) {
                    placed[vertex] = std::uint32_t(mesh_.vertices.size());
                    mesh_.vertices.push_back(vertices[vertex]);
                    sources.push_back(vertex);
                    if (flat) mesh_.vertices.back().normal = cross / length;
                }
                corners[corner] = placed[vertex];
            }
            mesh_.triangles.push_back(corners);
        }
        return sources;
    }

    const fs::path& path_;
    const tinygltf::Model& model_;
    const GltfMaterials* materials_;
    Mesh mesh_;
    std::vector<std::string> warnings_;
    std::vector<bool> visited_;
};

}  // namespace

Mesh read_gltf(const fs::path& path) {
    return MeshReader(path, load_gltf(path, false), nullptr).read();
}

GltfModel read_gltf_model(const fs::path& path) {
    const tinygltf::Model model = load_gltf(path, true);
    GltfMaterials materials = gltf_materials(path, model);
    MeshReader reader(path, model, &materials);
    GltfModel result;
    result.mesh = reader.read();
    result.warnings = reader.warnings();
    result.materials = std::move(materials.materials);
    return result;
}

}  // namespace aftershade::scene
