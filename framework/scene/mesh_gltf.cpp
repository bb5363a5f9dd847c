#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/path_bounds.h"
#include "framework/scene/gltf_bytes.h"
#include "framework/scene/mesh.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
// Linked as Debian's library: the implementation is not compiled here.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace aftershade::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxTriangles = 4'000'000;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
    throw Error(ErrorKind::usage, path.string() + ": " + what);
}

// What tinygltf opens besides the file itself: buffers, and images before it hands them on.

bool file_exists(const std::string& path, void*) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

std::string same_path(const std::string& path, void*) {
    return path;
}

/// `folder` is the mesh's own: what it names may not bring other files into a scene.
bool read_whole_file(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                     void* folder) {
    std::string fault = out_of_bounds(path, *static_cast<const std::string*>(folder));
    const std::string text = fault.empty() ? read_regular_file(path, kMaxGltfBytes, fault) : "";
    if (!fault.empty()) fault = path + " " + fault;
    bytes->assign(text.begin(), text.end());
    if (!fault.empty() && error) *error += fault;
    return fault.empty();
}

bool refuse_to_write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

/// From 2.9 on the loader asks for a file's size first; read_whole_file() bounds it.
[[maybe_unused]] bool file_size(std::size_t* bytes, std::string* error, const std::string& path, void*) {
    std::error_code fault;
    *bytes = std::size_t(fs::file_size(path, fault));
    if (fault && error) *error += fault.message();
    return !fault;
}

/// A template, for what this version of tinygltf does not have.
template <typename Callbacks>
Callbacks callbacks_in(std::string& folder) {
    Callbacks callbacks{};
    callbacks.FileExists = file_exists;
    callbacks.ExpandFilePath = same_path;
    callbacks.ReadWholeFile = read_whole_file;
    callbacks.WriteWholeFile = refuse_to_write;
    if constexpr (requires { callbacks.GetFileSizeInBytes; }) callbacks.GetFileSizeInBytes = file_size;
    callbacks.user_data = &folder;
    return callbacks;
}

bool leave_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                 void*) {
    return true;
}

/// One line, as our messages are.
std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.substr(0, 400);
}

/// Extensions that change how the geometry is stored or placed, and that are not read.
void check_extensions(const fs::path& path, const tinygltf::Model& model) {
    for (const std::string& name : model.extensionsRequired) {
        const bool harmless = name == "KHR_mesh_quantization" || name == "KHR_lights_punctual" ||
                              name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
                              name.starts_with("EXT_texture_");
        if (!harmless)
            fail(path, fmt::format("needs the extension '{}', which is not read: export without it", name));
    }
}

tinygltf::Model load_model(const fs::path& path) {
    std::string fault;
    const std::string text = read_regular_file(path, kMaxGltfBytes, fault);
    const std::span bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size());
    if (fault.empty()) fault = check_gltf_bytes(bytes);
    if (!fault.empty()) fail(path, fault);
    const bool binary = is_binary_gltf(bytes);

    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(leave_image, nullptr);
    std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
    loader.SetFsCallbacks(callbacks_in<tinygltf::FsCallbacks>(folder));
    const unsigned size = unsigned(bytes.size());
    tinygltf::Model model;
    std::string error;
    std::string warning;
    bool read = false;
    try {
        read = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, folder)
                      : loader.LoadASCIIFromString(&model, &error, &warning, text.data(), size, folder);
    } catch (const std::exception& exception) {
        error += exception.what();
    }
    if (!read) fail(path, "cannot be read as glTF: " + one_line(error));
    if (!model.asset.version.starts_with("2."))
        fail(path, fmt::format("is glTF of version '{}', 2.0 is read", model.asset.version));
    check_extensions(path, model);
    return model;
}

/// One accessor whose bytes are known to lie in their buffer.
class Values {
public:
    Values(const fs::path& path, const tinygltf::Model& model, int index, std::string what,
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
    [[noreturn]] void fault(const std::string& text) const { fail(path_, what_ + ": " + text); }

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

    const fs::path& path_;
    std::string what_;
    std::span<const unsigned char> bytes_;
    std::size_t stride_ = 0;
    std::size_t count_ = 0;
    int component_ = 0;
    bool normalized_ = false;
};

class MeshReader {
public:
    MeshReader(const fs::path& path, const tinygltf::Model& model) : path_(path), model_(model) {}

    Mesh read() {
        visited_.resize(model_.nodes.size());
        for (const int node : roots()) add_tree(node);
        if (mesh_.triangles.empty()) fail(path_, "has no triangles in its scene");
        return std::move(mesh_);
    }

private:
    struct Placed {
        int node;
        glm::dmat4 world_from_parent;
    };

    std::vector<int> roots() const {
        if (model_.defaultScene != -1) {
            if (model_.defaultScene < 0 || std::size_t(model_.defaultScene) >= model_.scenes.size())
                fail(path_, fmt::format("its default scene {} is not there, the file has {}",
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
                fail(path_,
                     fmt::format("node {} is not there, the file has {}", placed.node, model_.nodes.size()));
            if (visited_[std::size_t(placed.node)])
                fail(path_, fmt::format("node {} stands in two places; nodes form trees", placed.node));
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
            fail(path_, fmt::format("{} of node {} has {} numbers, not {}", key, node, values.size(), count));
        if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
            fail(path_, fmt::format("{} of node {} is not finite", key, node));
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
            if (!(glm::length(rotation) > 0)) fail(path_, fmt::format("rotation of node {} is zero", index));
            placed *= glm::mat4_cast(glm::normalize(rotation));
        }
        if (has_numbers(index, "scale", node.scale, 3))
            for (int axis = 0; axis < 3; ++axis) placed[axis] *= node.scale[std::size_t(axis)];
        return placed;
    }

    void add_mesh(int index, const glm::dmat4& world_from_node) {
        if (index < 0 || std::size_t(index) >= model_.meshes.size())
            fail(path_, fmt::format("mesh {} is not there, the file has {}", index, model_.meshes.size()));
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

    std::optional<Values> attribute(const tinygltf::Primitive& primitive, const std::string& place,
                                    const char* name, int type) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return std::nullopt;
        return Values(path_, model_, found->second, place + " " + name, {type});
    }

    void add_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                       const glm::dmat4& world_from_node) {
        const auto positions = attribute(primitive, place, "POSITION", TINYGLTF_TYPE_VEC3);
        if (!positions) fail(path_, place + " has no POSITION");
        const auto normals = attribute(primitive, place, "NORMAL", TINYGLTF_TYPE_VEC3);
        const auto uvs = attribute(primitive, place, "TEXCOORD_0", TINYGLTF_TYPE_VEC2);
        for (const auto* values : {&normals, &uvs})
            if (*values && (*values)->count() != positions->count())
                fail(path_,
                     fmt::format("{} has {} positions, but {} {}", place, positions->count(),
                                 (*values)->count(), values == &normals ? "normals" : "texture coordinates"));
        std::vector<Vertex> vertices(positions->count());
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const glm::dvec4 point = world_from_node * glm::dvec4(positions->vec3(i), 1);
            vertices[i].position = glm::dvec3(point);
            // Values of the file are finite, but what a chain of nodes makes of them may not be.
            if (!std::isfinite(glm::dot(vertices[i].position, vertices[i].position)))
                fail(path_, fmt::format("{} position {} is not finite where its node puts it", place, i));
            if (uvs) vertices[i].uv = uvs->vec2(i);
        }
        const glm::dmat3 linear(world_from_node);
        if (normals) place_normals(*normals, linear, vertices);
        auto triangles = triangles_of(primitive, place, vertices.size());
        if (glm::determinant(linear) < 0)
            for (auto& triangle : triangles) std::swap(triangle[1], triangle[2]);
        append(vertices, triangles, normals.has_value());
    }

    /// By the cofactors, which are the inverse transpose times the determinant and exist without an inverse.
    static void place_normals(const Values& normals, const glm::dmat3& linear,
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
        const Values values(path_, model_, primitive.indices, place + " indices", {TINYGLTF_TYPE_SCALAR});
        indices.resize(values.count());
        for (std::size_t i = 0; i < indices.size(); ++i) {
            indices[i] = values.index(i);
            if (indices[i] >= vertex_count)
                fail(path_, fmt::format("{} index {} is {}, out of range of its {} vertices", place, i,
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
            fail(path_,
                 fmt::format("{} has {} indices, which is not a multiple of 3", place, indices.size()));
        const std::size_t count =
            list ? indices.size() / 3 : indices.size() - std::min<std::size_t>(indices.size(), 2);
        if (count > kMaxTriangles - mesh_.triangles.size())
            fail(path_, fmt::format("has more than {} triangles: decimate it", kMaxTriangles));
        Triangles triangles(count);
        for (std::size_t i = 0; i < count; ++i) {
            if (list) triangles[i] = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
            else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN)
                triangles[i] = {indices[i + 1], indices[i + 2], indices[0]};
            else triangles[i] = {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]};
        }
        return triangles;
    }

    /// Adds the triangles that have an area, and the vertices that they use.
    void append(std::vector<Vertex>& vertices, const Triangles& triangles, bool has_normals) {
        std::vector<std::uint32_t> placed(vertices.size(), kNone);
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
                    if (flat) mesh_.vertices.back().normal = cross / length;
                }
                corners[corner] = placed[vertex];
            }
            mesh_.triangles.push_back(corners);
        }
    }

    const fs::path& path_;
    const tinygltf::Model& model_;
    Mesh mesh_;
    std::vector<bool> visited_;
};

}  // namespace

Mesh read_gltf(const fs::path& path) {
    const tinygltf::Model model = load_model(path);
    return MeshReader(path, model).read();
}

}  // namespace aftershade::scene
