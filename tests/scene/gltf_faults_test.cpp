#include "framework/base/error.h"
#include "tests/scene/gltf_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aftershade::scene {
namespace {

using namespace test;

const std::filesystem::path kRoot = AFTERSHADE_SOURCE_DIR;

/// What the message says after the path; "" when the file is read.
std::string fault_of(const std::string& bytes) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "bad.gltf";
    write_text(path, bytes);
    try {
        read_gltf(path);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with(path.string() + ": ")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message.substr(std::min(message.size(), path.string().size() + 2));
    }
    return "";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string with_positions(std::vector<float> positions) {
    File file;
    file.primitive(fmt::format(R"("POSITION": {})", file.floats(positions, 3)));
    return file.text();
}

/// Four positions at 0, three indices at 48 or as given.
std::string with_indices(const std::vector<std::uint8_t>& indices) {
    File file;
    const int positions = file.floats(kSquare, 3);
    file.primitive(fmt::format(R"("POSITION": {})", positions), file.indices(indices));
    return file.text();
}

TEST(Gltf, RefusesBrokenFilesAndSaysWhatIsWrong) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::string good = with_indices({0, 1, 2});
    ASSERT_EQ(fault_of(good), "");
    struct Case {
        std::string bytes;
        const char* says;
    };
    const std::string mesh_node = R"("nodes": [{"mesh": 0}])";
    const std::vector<Case> cases = {
        {"", "cannot be read as glTF"},
        {"glTF", "cannot be read as glTF"},
        {"{\"asset\": ", "cannot be read as glTF"},
        {"[1, 2, 3]", "cannot be read as glTF"},
        {std::string(100'000, '['), "nests more than 200 levels"},
        {with(good, "\"2.0\"", "\"1.0\""), "is glTF of version '1.0'"},
        {with(good, R"("count": 3)", R"("count": 300)"),
         "the 300 values of accessor 1 end outside its bufferView"},
        {with(good, R"("count": 4)", R"("count": 5)"),
         "the 5 values of accessor 0 end outside its bufferView"},
        {with(good, R"("count": 4)", R"("count": 6148914691236517206)"), "end outside its bufferView"},
        {with(good, R"("byteLength": 48)", R"("byteLength": 4800)"),
         "bufferView 0 ends outside its buffer of 51"},
        {with(good, R"("byteOffset": 48)", R"("byteOffset": 18446744073709551615)"),
         "ends outside its buffer"},
        {with(good, R"("buffer": 0)", R"("buffer": 7)"), "buffer 7 is not there, the file has 1"},
        {with(good, R"("buffer": 0)", R"("buffer": -3)"), "buffer -3 is not there"},
        {with(good, R"("bufferView": 0)", R"("bufferView": 9)"), "bufferView 9 is not there, the file has 2"},
        {with(good, R"("POSITION": 0)", R"("POSITION": 5)"), "accessor 5 is not there, the file has 2"},
        {with(good, R"("POSITION": 0)", R"("NORMAL": 0)"), "mesh 0 primitive 0 has no POSITION"},
        {with(good, "VEC3", "VEC2"), "mesh 0 primitive 0 POSITION: accessor 0 has the wrong type"},
        {with(good, "5126", "5125"), "component type 5125 is not allowed for vertices"},
        {with(good, "5121", "5120"), "component type 5120 is not allowed for indices"},
        {with(good, R"("indices": 1)", R"("indices": 12)"), "cannot be read as glTF"},
        {with(good, R"("byteLength": 48)", R"("byteLength": 48, "byteStride": 8)"),
         "a stride that cannot be"},
        {with(good, R"("type": "VEC3")",
              R"("type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5126},
                 "values": {"bufferView": 0}})"),
         "component type 5126 is not allowed for indices"},
        {with(good, R"("type": "VEC3")",
              R"("type": "VEC3", "sparse": {"count": 5, "indices": {"bufferView": 1, "componentType": 5121},
                 "values": {"bufferView": 0}})"),
         "the 5 values of the sparse indices of accessor 0 end outside its bufferView"},
        {with(
             good, R"("type": "VEC3")",
             R"("type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": 15, "componentType": 5121},
                 "values": {"bufferView": 0}})"),
         "sparse index 0 is 63, out of range of 4 values"},
        {with(good, R"({"bufferView": 0, "componentType": 5126, "count": 4)",
              R"({"componentType": 5126, "count": 1099511627776)"),
         "accessor 0 has 1099511627776 values, more than 1073741824 bytes"},
        {with_indices({0, 1, 4}), "index 2 is 4, out of range of its 4 vertices"},
        {with_indices({0, 1}), "has 2 indices, which is not a multiple of 3"},
        {with_indices({0, 0, 0}), "has no triangles"},
        {with_positions({0, 0, 0, 1, 0, 0, 0, inf, 0}), "POSITION: value 2 is not finite"},
        {with_positions({0, nan, 0, 1, 0, 0, 0, 1, 0}), "POSITION: value 0 is not finite"},
        {with(good, R"("mode": 4)", R"("mode": 1)"), "has no triangles"},
        {with(good, mesh_node, R"("nodes": [{}])"), "has no triangles"},
        {with(good, mesh_node, R"("nodes": [{"mesh": 3}])"), "mesh 3 is not there, the file has 1"},
        {with(good, mesh_node, R"("nodes": [{"children": [0]}])"), "node 0 stands in two places"},
        {with(good, mesh_node, R"("nodes": [{"children": [8]}])"), "node 8 is not there, the file has 1"},
        {with(good, mesh_node, R"("nodes": [{"mesh": 0, "scale": [1, 2]}])"),
         "scale of node 0 has 2 numbers, not 3"},
        {with(good, mesh_node, R"("nodes": [{"mesh": 0, "rotation": [0, 0, 0, 0]}])"),
         "rotation of node 0 is zero"},
        {with(good, mesh_node, R"("nodes": [{"mesh": 0, "scale": [1e999, 1, 1]}])"),
         "cannot be read as glTF"},
        {with(good, mesh_node, R"("nodes": [{"mesh": 0, "scale": [1e300, 1e300, 1]}])"),
         "is not finite where"},
        {with(good, R"("scene": 0)", R"("scene": 2)"), "its default scene 2 is not there, the file has 1"},
        {with(good, R"("asset")", R"("extensionsRequired": ["KHR_draco_mesh_compression"], "asset")"),
         "needs the extension 'KHR_draco_mesh_compression'"},
        {with(good, "data:application/octet-stream;base64,", "missing.bin#"),
         "File not found : missing.bin#"},
        {with(good, "base64,", "base64,AAAA"), "cannot be read as glTF: Failed to decode"},
    };
    for (const Case& test : cases) {
        const std::string fault = fault_of(test.bytes);
        EXPECT_NE(fault.find(test.says), std::string::npos) << fault << "\nshould say: " << test.says;
    }
}

TEST(Gltf, RefusesNormalsAndCoordinatesThatAreNotFinite) {
    const float inf = std::numeric_limits<float>::infinity();
    for (const char* name : {"NORMAL", "TEXCOORD_0"}) {
        File file;
        const int positions = file.floats(kSquare, 3);
        const bool normal = std::string(name) == "NORMAL";
        const int values = file.floats(normal ? std::vector<float>{0, 0, 1, 0, 0, 1, 0, inf, 1, 0, 0, 1}
                                              : std::vector<float>{0, 0, 1, 0, 0, inf, 1, 1},
                                       normal ? 3 : 2);
        file.primitive(fmt::format(R"("POSITION": {}, "{}": {})", positions, name, values),
                       file.indices<std::uint8_t>({0, 1, 2}));
        EXPECT_EQ(fault_of(file.text()), fmt::format("mesh 0 primitive 0 {}: value 2 is not finite", name));
    }
}

TEST(Gltf, RefusesABinaryChunkThatEndsOutsideTheFile) {
    std::string file = tilted_triangle().binary();
    // Both lengths agree with each other; 8 bytes too few are what tinygltf itself lets pass.
    for (int cut = 0; cut < 3; ++cut) {
        file = file.substr(0, file.size() - 4);
        file.replace(8, 4, little_endian_32(file.size()));
        EXPECT_TRUE(fault_of(file).starts_with("is cut short inside its binary chunk")) << fault_of(file);
    }
    file.replace(12, 4, little_endian_32(file.size()));
    EXPECT_EQ(fault_of(file), "is cut short inside its JSON chunk");
}

TEST(Gltf, RefusesABufferBesideTheFileOfAnotherSize) {
    const TemporaryFolder folder;
    const File file = tilted_triangle();
    write_text(folder / "data.bin", file.buffer().substr(1));
    write_text(folder / "mesh.gltf", file.json("data.bin"));
    EXPECT_THROW(read_gltf(folder / "mesh.gltf"), Error);
}

TEST(Gltf, RefusesNormalsAndCoordinatesThatAreNotOneForEachPosition) {
    File file;
    const int positions = file.floats(kSquare, 3);
    const int three = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    file.primitive(fmt::format(R"("POSITION": {}, "NORMAL": {})", positions, three),
                   file.indices<std::uint8_t>({0, 1, 2}));
    EXPECT_EQ(fault_of(file.text()), "mesh 0 primitive 0 has 4 positions, but 3 normals");
}

TEST(Gltf, RefusesMoreThanFourMillionTriangles) {
    File file;
    const int positions = file.floats(kSquare, 3);
    const std::vector<std::uint8_t> indices(4'000'003, 1);
    file.primitive(fmt::format(R"("POSITION": {})", positions), file.indices(indices), kStrip);
    EXPECT_EQ(fault_of(file.binary()), "has more than 4000000 triangles: decimate it");
}

TEST(Gltf, RefusesWhatIsNoFile) {
    const TemporaryFolder folder;
    for (const auto& path : {folder / "missing.glb", folder.path()}) {
        try {
            read_gltf(path);
            ADD_FAILURE() << path;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            EXPECT_TRUE(std::string(error.what()).starts_with(path.string() + ": ")) << error.what();
        }
    }
}

/// Reads it or refuses it with our own error; what it reads is whole.
bool survives(const std::filesystem::path& path, const std::string& bytes) {
    write_text(path, bytes);
    try {
        const Mesh mesh = read_gltf(path);
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle) EXPECT_LT(vertex, mesh.vertices.size());
        for (const Vertex& vertex : mesh.vertices) {
            EXPECT_TRUE(std::isfinite(glm::length(vertex.position)));
            EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-9);
        }
        return true;
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(path.string() + ": ")) << error.what();
        return false;
    }
}

TEST(Gltf, RefusesAFileCutShortAnywhere) {
    const TemporaryFolder folder;
    const std::string whole = read_text(kRoot / "scenes/meshes/bat.glb");
    ASSERT_TRUE(survives(folder / "mesh.glb", whole));
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 200)
        EXPECT_FALSE(survives(folder / "mesh.glb", whole.substr(0, size))) << size;
}

TEST(Gltf, SurvivesDamagedBytes) {
    const TemporaryFolder folder;
    std::mt19937 random(5);
    const std::string text = tilted_triangle().text();
    const std::string binary = read_text(kRoot / "scenes/meshes/bat.glb");
    for (const std::string& whole : {text, binary})
        for (int i = 0; i < 1500; ++i) {
            std::string damaged = whole;
            for (unsigned k = 0; k <= random() % 4; ++k) {
                // Mostly in the JSON, which both begin with.
                const std::size_t limit =
                    random() % 4 == 0 ? whole.size() : std::min<std::size_t>(whole.size(), 1200);
                const std::size_t at = random() % limit;
                damaged[at] = random() % 2 == 0 ? char('0' + random() % 10) : char(random() % 256);
            }
            survives(folder / "mesh.glb", damaged);
        }
}

TEST(GltfFaults, OfManyValuesThatTheFileDoesNotHold) {
    File file;
    file.floats({0, 0, 0}, 3);
    file.primitive(fmt::format(R"("POSITION": {})", file.accessor(7, kFloat, 89'000'000, "VEC3")));
    EXPECT_EQ(fault_of(with(file.text(), R"("bufferView": 7, )", "")),
              "mesh 0 primitive 0 POSITION: accessor 1 has 89000000 values and no bufferView; the limit is "
              "12000000");
}

}  // namespace
}  // namespace aftershade::scene
