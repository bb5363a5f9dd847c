// glTF files put together by hand, and what tests ask of the meshes read from them.
#pragma once

#include "framework/scene/mesh.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aftershade::scene::test {

using aftershade::test::read_text;
using aftershade::test::TemporaryFolder;
using aftershade::test::write_text;

// Component types and modes as glTF 2.0 numbers them.
inline constexpr int kByte = 5120, kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125,
                     kFloat = 5126;
inline constexpr int kPoints = 0, kTriangles = 4, kStrip = 5, kFan = 6;

inline std::string base64(const std::string& bytes) {
    static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? (unsigned char)bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

template <class T>
inline std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string little_endian_32(std::size_t value) {
    const std::uint32_t word = std::uint32_t(value);
    return {reinterpret_cast<const char*>(&word), 4};
}

/// A glTF file put together by hand: one buffer, a bufferView for each accessor.
class File {
public:
    std::string nodes = R"({"mesh": 0})";
    std::string scenes = R"("scene": 0, "scenes": [{"nodes": [0]}])";
    std::string more;  ///< further members of the root, each after a comma

    int view(const std::string& bytes, int stride = 0) {
        while (buffer_.size() % 4 != 0) buffer_ += '\0';
        views_.push_back(fmt::format(R"({{"buffer": 0, "byteOffset": {}, "byteLength": {}{}}})",
                                     buffer_.size(), bytes.size(),
                                     stride ? fmt::format(R"(, "byteStride": {})", stride) : ""));
        buffer_ += bytes;
        return int(views_.size()) - 1;
    }
    int accessor(int view, int component, std::size_t count, const std::string& type,
                 const std::string& extra = "") {
        accessors_.push_back(
            fmt::format(R"({{"bufferView": {}, "componentType": {}, "count": {}, "type": "{}"{}}})", view,
                        component, count, type, extra));
        return int(accessors_.size()) - 1;
    }
    int floats(const std::vector<float>& values, int components) {
        return accessor(view(bytes_of(values)), kFloat, values.size() / std::size_t(components),
                        fmt::format("VEC{}", components));
    }
    template <class T>
    int indices(const std::vector<T>& values) {
        const int component = sizeof(T) == 1 ? kUnsignedByte : sizeof(T) == 2 ? kUnsignedShort : kUnsignedInt;
        return accessor(view(bytes_of(values)), component, values.size(), "SCALAR");
    }
    void primitive(const std::string& attributes, int indices = -1, int mode = kTriangles,
                   int material = -1) {
        primitives_ +=
            fmt::format(R"({}{{"attributes": {{{}}}, "mode": {}{}{}}})", primitives_.empty() ? "" : ", ",
                        attributes, mode, indices < 0 ? "" : fmt::format(R"(, "indices": {})", indices),
                        material < 0 ? "" : fmt::format(R"(, "material": {})", material));
    }

    std::string json(const std::string& uri) const {
        return fmt::format(
            R"({{"asset": {{"version": "2.0"}}, {}, "nodes": [{}], "meshes": [{{"primitives": [{}]}}],
"accessors": [{}], "bufferViews": [{}], "buffers": [{{"byteLength": {}{}}}]{}}})",
            scenes, nodes, primitives_, fmt::join(accessors_, ", "), fmt::join(views_, ", "), buffer_.size(),
            uri.empty() ? "" : fmt::format(R"(, "uri": "{}")", uri), more);
    }
    std::string text() const { return json("data:application/octet-stream;base64," + base64(buffer_)); }
    std::string binary() const {
        std::string json_chunk = json("");
        while (json_chunk.size() % 4 != 0) json_chunk += ' ';
        std::string data = buffer_;
        while (data.size() % 4 != 0) data += '\0';
        const std::string chunks = little_endian_32(json_chunk.size()) + "JSON" + json_chunk +
                                   little_endian_32(data.size()) + std::string("BIN\0", 4) + data;
        return "glTF" + little_endian_32(2) + little_endian_32(12 + chunks.size()) + chunks;
    }
    const std::string& buffer() const { return buffer_; }

private:
    std::string buffer_;
    std::vector<std::string> views_;
    std::vector<std::string> accessors_;
    std::string primitives_;
};

inline Mesh read_bytes(const std::string& bytes, const std::string& name = "mesh.gltf") {
    const TemporaryFolder folder;
    write_text(folder / name, bytes);
    return read_gltf(folder / name);
}

/// The corners' positions, triangle after triangle.
inline std::vector<glm::dvec3> corners_of(const Mesh& mesh) {
    std::vector<glm::dvec3> corners;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) corners.push_back(mesh.vertices[vertex].position);
    return corners;
}

inline glm::dvec3 face_normal(const Mesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return glm::normalize(glm::cross(mesh.vertices[b].position - mesh.vertices[a].position,
                                     mesh.vertices[c].position - mesh.vertices[a].position));
}

inline void expect_near(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-12) {
    EXPECT_LT(glm::length(actual - expected), tolerance)
        << actual.x << " " << actual.y << " " << actual.z << " against " << expected.x << " " << expected.y
        << " " << expected.z;
}

inline const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
/// The triangle (1,0,0) (0,1,0) (0,0,1) with its face's normal, in node 0's mesh.
inline File tilted_triangle() {
    File file;
    const int positions = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, 3);
    const int normals = file.floats({1, 1, 1, 1, 1, 1, 1, 1, 1}, 3);
    file.primitive(fmt::format(R"("POSITION": {}, "NORMAL": {})", positions, normals));
    return file;
}

}  // namespace aftershade::scene::test
