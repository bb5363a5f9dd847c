#include "tests/scene/gltf_file.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aftershade::scene {
namespace {

using namespace test;

const std::vector<glm::dvec3> kSquareCorners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                                {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};

template <class T>
std::string indexed_square() {
    File file;
    const int positions = file.floats(kSquare, 3);
    file.primitive(fmt::format(R"("POSITION": {})", positions), file.indices<T>({0, 1, 2, 0, 2, 3}));
    return file.text();
}

TEST(Gltf, ReadsIndicesOfEachKind) {
    for (const std::string& text :
         {indexed_square<std::uint8_t>(), indexed_square<std::uint16_t>(), indexed_square<std::uint32_t>()})
        EXPECT_EQ(corners_of(read_bytes(text)), kSquareCorners);
}

TEST(Gltf, WithoutIndicesEveryThreePositionsAreATriangle) {
    File file;
    file.primitive(fmt::format(R"("POSITION": {})",
                               file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}, 3)));
    EXPECT_EQ(corners_of(read_bytes(file.text())), kSquareCorners);
}

TEST(Gltf, TurnsStripsAndFansIntoTrianglesThatFaceTheSameWay) {
    File file;
    // Zigzag for the strip; around for the fan.
    const int zigzag = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, 3);
    const int around = file.floats({5, 0, 0, 6, 0, 0, 6, 1, 0, 5, 1, 0}, 3);
    file.primitive(fmt::format(R"("POSITION": {})", zigzag), -1, kStrip);
    file.primitive(fmt::format(R"("POSITION": {})", around), -1, kFan);
    const Mesh mesh = read_bytes(file.text());
    ASSERT_EQ(mesh.triangles.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) expect_near(face_normal(mesh, i), {0, 0, 1});
    const auto corners = corners_of(mesh);
    EXPECT_EQ(corners[6], glm::dvec3(0, 1, 0));  // the strip's third triangle: 2, 3, 4
    EXPECT_EQ(corners[7], glm::dvec3(1, 1, 0));
    EXPECT_EQ(corners[8], glm::dvec3(0, 2, 0));
    EXPECT_EQ(corners[14], glm::dvec3(5, 0, 0));  // the fan's hub
}

TEST(Gltf, ReadsNormalisedAndInterleavedValues) {
    struct Packed {
        std::uint16_t position[3];
        std::uint16_t pad;
        std::int8_t normal[3];
        std::int8_t pad_2;
        std::uint8_t uv[2];
        std::uint16_t pad_3;
    };
    static_assert(sizeof(Packed) == 16);
    const std::vector<Packed> packed = {{{0, 0, 0}, 9, {0, 0, 127}, 9, {0, 255}, 9},
                                        {{65535, 0, 0}, 9, {0, -128, 0}, 9, {255, 51}, 9},
                                        {{0, 65535, 13107}, 9, {127, 0, 0}, 9, {102, 0}, 9}};
    File file;
    const int view = file.view(bytes_of(packed), 16);
    const int positions = file.accessor(view, kUnsignedShort, 3, "VEC3", R"(, "normalized": true)");
    const int normals = file.accessor(view, kByte, 3, "VEC3", R"(, "normalized": true, "byteOffset": 8)");
    const int uvs =
        file.accessor(view, kUnsignedByte, 3, "VEC2", R"(, "normalized": true, "byteOffset": 12)");
    file.primitive(fmt::format(R"("POSITION": {}, "NORMAL": {}, "TEXCOORD_0": {})", positions, normals, uvs));
    const Mesh mesh = read_bytes(file.text());
    ASSERT_EQ(mesh.vertices.size(), 3u);
    expect_near(mesh.vertices[1].position, {1, 0, 0});
    expect_near(mesh.vertices[2].position, {0, 1, 0.2});
    expect_near(mesh.vertices[0].normal, {0, 0, 1});
    expect_near(mesh.vertices[1].normal, {0, -1, 0});
    EXPECT_EQ(mesh.vertices[0].uv, glm::dvec2(0, 1));
    EXPECT_EQ(mesh.vertices[1].uv, glm::dvec2(1, 0.2));
    EXPECT_EQ(mesh.vertices[2].uv, glm::dvec2(0.4, 0));
}

TEST(Gltf, BakesTheTransformsOfAHierarchy) {
    File file = tilted_triangle();
    // A quarter turn about z (x to y) and a shift, of a node that scales.
    file.nodes =
        R"({"translation": [10, 20, 30], "rotation": [0, 0, 0.70710678118654752, 0.70710678118654752],
                     "children": [1]}, {"scale": [2, 3, 4], "mesh": 0})";
    const Mesh mesh = read_bytes(file.text());
    const auto corners = corners_of(mesh);
    ASSERT_EQ(corners.size(), 3u);
    expect_near(corners[0], {10, 22, 30});
    expect_near(corners[1], {7, 20, 30});
    expect_near(corners[2], {10, 20, 34});
    // A plane's normal stays its normal under the inverse transpose alone.
    for (const Vertex& vertex : mesh.vertices) expect_near(vertex.normal, face_normal(mesh, 0));
    expect_near(mesh.vertices[0].normal, glm::normalize(glm::dvec3(-1.0 / 3, 1.0 / 2, 1.0 / 4)));
}

TEST(Gltf, AMatrixDoesWhatItsPartsWouldDo) {
    File file = tilted_triangle();
    file.nodes = R"({"matrix": [0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1], "mesh": 0})";
    const auto corners = corners_of(read_bytes(file.text()));
    ASSERT_EQ(corners.size(), 3u);
    expect_near(corners[0], {10, 22, 30});
    expect_near(corners[1], {7, 20, 30});
    expect_near(corners[2], {10, 20, 34});
}

TEST(Gltf, AMirroredNodeStillHasItsTrianglesCounterClockwiseSeenFromOutside) {
    for (const char* scale : {"[-1, 1, 1]", "[2, -0.5, 1]", "[-1, -2, -3]", "[1, 2, 3]", "[-1, -2, 3]"}) {
        File file = tilted_triangle();
        file.nodes = fmt::format(R"({{"scale": {}, "mesh": 0}})", scale);
        const Mesh mesh = read_bytes(file.text());
        ASSERT_EQ(mesh.triangles.size(), 1u);
        expect_near(face_normal(mesh, 0), mesh.vertices[0].normal);
        EXPECT_GT(glm::dot(face_normal(mesh, 0), mesh.vertices[0].position), 0) << "away from the origin";
    }
}

TEST(Gltf, WithoutNormalsEachTriangleIsFlat) {
    File file;
    const int positions = file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1}, 3);
    file.primitive(fmt::format(R"("POSITION": {})", positions),
                   file.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
    file.nodes = R"({"scale": [1, 1, -2], "mesh": 0})";
    const Mesh mesh = read_bytes(file.text());
    EXPECT_EQ(mesh.vertices.size(), 6u);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
        for (const std::uint32_t vertex : mesh.triangles[i])
            expect_near(mesh.vertices[vertex].normal, face_normal(mesh, i));
    EXPECT_GT(glm::length(face_normal(mesh, 0) - face_normal(mesh, 1)), 0.1);
}

TEST(Gltf, ANormalOfLengthZeroIsAsGoodAsNone) {
    File file;
    const int positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    const int normals = file.floats({0, 0, 0, 1, 0, 0, 0, 3, 0}, 3);
    file.primitive(fmt::format(R"("POSITION": {}, "NORMAL": {})", positions, normals));
    const Mesh mesh = read_bytes(file.text());
    ASSERT_EQ(mesh.vertices.size(), 3u);
    expect_near(mesh.vertices[0].normal, {0, 0, 1});
    expect_near(mesh.vertices[1].normal, {1, 0, 0});
    expect_near(mesh.vertices[2].normal, {0, 1, 0});
}

TEST(Gltf, ReadsTheDefaultSceneElseAllScenes) {
    File file = tilted_triangle();
    file.nodes =
        R"({"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0, "translation": [9, 0, 0]})";
    file.scenes = R"("scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [1]}])";
    const auto corners = corners_of(read_bytes(file.text()));
    ASSERT_EQ(corners.size(), 3u);
    expect_near(corners[0], {6, 0, 0});
    file.scenes = R"("scenes": [{"nodes": [0]}, {"nodes": [1, 0]}])";
    EXPECT_EQ(read_bytes(file.text()).triangles.size(), 2u) << "nodes 0 and 1, once each";
}

TEST(Gltf, LeavesPointsAndTrianglesWithoutAnArea) {
    File file;
    const int positions = file.floats(kSquare, 3);
    const std::string attributes = fmt::format(R"("POSITION": {})", positions);
    file.primitive(attributes, -1, kPoints);
    file.primitive(attributes, file.indices<std::uint8_t>({0, 1, 2, 0, 0, 1, 2, 2, 2}));
    const Mesh mesh = read_bytes(file.text());
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.vertices.size(), 3u) << "the fourth has no triangle";
}

TEST(Gltf, ReadsBinaryFilesAndBuffersBesideTheFile) {
    const File file = tilted_triangle();
    const auto expected = corners_of(read_bytes(file.text()));
    EXPECT_EQ(corners_of(read_bytes(file.binary(), "mesh.glb")), expected);
    EXPECT_EQ(corners_of(read_bytes(file.binary(), "mesh.gltf")), expected) << "its bytes say what it is";
    const TemporaryFolder folder;
    write_text(folder / "the data.bin", file.buffer());
    write_text(folder / "mesh.gltf", file.json("the%20data.bin"));
    EXPECT_EQ(corners_of(read_gltf(folder / "mesh.gltf")), expected);
}

TEST(Gltf, LeavesImagesWhatEverTheyHold) {
    File file = tilted_triangle();
    file.more = R"(, "images": [{"uri": "missing.png"}, {"bufferView": 0, "mimeType": "image/png"}],
                   "textures": [{"source": 0}], "materials": [{"name": "red"}])";
    EXPECT_EQ(read_bytes(file.text()).triangles.size(), 1u);
}

TEST(Gltf, HasZerosAndTheValuesOfSparseAccessorsInTheirPlaces) {
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 2, 0};
    File dense;
    dense.primitive(fmt::format(R"("POSITION": {})", dense.floats(positions, 3)));
    const std::vector<glm::dvec3> expected = corners_of(read_bytes(dense.text()));
    for (const bool has_view : {true, false}) {
        File file;
        const int where = file.view(bytes_of(std::vector<std::uint16_t>{1, 2}));
        const int what = file.view(bytes_of(std::vector<float>{1, 0, 0, 0, 2, 0}));
        // Other values where the sparse ones come.
        const int all = file.view(bytes_of(std::vector<float>{0, 0, 0, 7, 7, 7, 8, 8, 8}));
        const std::string sparse = fmt::format(
            R"(, "sparse": {{"count": 2, "indices": {{"bufferView": {}, "componentType": 5123}}, "values": {{"bufferView": {}}}}})",
            where, what);
        file.primitive(fmt::format(R"("POSITION": {})", file.accessor(all, kFloat, 3, "VEC3", sparse)));
        std::string text = file.text();
        const std::string view = fmt::format(R"("bufferView": {}, "componentType": 5126)", all);
        if (!has_view) text.replace(text.find(view), view.size(), R"("componentType": 5126)");
        EXPECT_EQ(corners_of(read_bytes(text)), expected) << has_view;
    }
}

}  // namespace
}  // namespace aftershade::scene
