#include "framework/capture/stored_matrices.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "framework/image/camera_matrix.h"
#include "tests/camera_pose.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

constexpr int kWidth_px = 64, kHeight_px = 36;

/// How a producer stores its matrices.
struct Convention {
    std::string name;
    bool left_handed = false, unsigned_ndc = false, y_down = false, transposed = false;
    std::string projection = "worldToNDC";
};

std::vector<Convention> conventions() {
    return {{"Aftershade before version 2, and Clarisse"},
            {"Arnold 5", true},
            {"Arnold 7", true, false, false, false, "worldToScreen"},
            {"OpenEXR", true, true, true},
            {"a y that grows upwards from 0", true, true, false},
            {"pbrt-v4", true, true, true, true},
            {"-z ahead and 0 to 1", false, true, true}};
}

/// Turned about every axis.
CameraPose turned_pose() {
    CameraPose pose;
    pose.position_m = {1.5, 0.75, 4};
    pose.angles_deg = {-12, 35, 4};
    return pose;
}

std::vector<float> stored(glm::dmat4 matrix, bool transposed) {
    // EXR's act on row vectors: its rows are GLM's columns.
    if (transposed) matrix = glm::transpose(matrix);
    std::vector<float> values;
    for (int i = 0; i < 16; ++i) values.push_back(float(matrix[i / 4][i % 4]));
    return values;
}

std::map<std::string, ExrValue> attributes_of(const Camera& camera, const Convention& convention) {
    glm::dmat4 view = glm_matrix(*camera.camera_from_world), ndc = glm_matrix(*camera.ndc_from_world);
    if (convention.left_handed)
        for (int column = 0; column < 4; ++column) view[column][2] *= -1;
    for (int column = 0; column < 4; ++column) {
        if (convention.y_down) ndc[column][1] *= -1;
        if (!convention.unsigned_ndc) continue;
        for (const int row : {0, 1}) ndc[column][row] = 0.5 * (ndc[column][row] + ndc[column][3]);
    }
    return {{"worldToCamera", stored(view, convention.transposed)},
            {convention.projection, stored(ndc, convention.transposed)}};
}

/// The header that a file of these attributes has when it is read back.
ExrPart part_with(const std::map<std::string, ExrValue>& attributes) {
    const TemporaryFolder folder;
    const Image image(kWidth_px, kHeight_px, 1);
    const std::vector<ExrOutputChannel> channels = {{"R", PixelType::half, &image, 0}};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, kWidth_px - 1, kHeight_px - 1};
    options.attributes = attributes;
    write_exr(folder / "a.exr", channels, options);
    return ExrFile(folder / "a.exr").parts()[0];
}

glm::dvec2 pixel_of(const CameraMatrix& ndc_from_world, glm::dvec4 world, int width, int height) {
    const glm::dvec4 ndc = glm_matrix(ndc_from_world) * world;
    EXPECT_GT(ndc.w, 0);
    return {(ndc.x / ndc.w + 1) / 2 * width, (1 - ndc.y / ndc.w) / 2 * height};
}

/// Points that the pose sees are where it sees them, and as far.
void expect_matches(const StoredMatrices& matrices, const CameraPose& pose) {
    ASSERT_TRUE(matrices.camera_from_world && matrices.ndc_from_world) << matrices.fault;
    for (const double depth_m : {0.5, 3.0, 80.0})
        for (const glm::dvec2 pixel : {glm::dvec2(3, 2), glm::dvec2(40, 30), glm::dvec2(63, 8)}) {
            const glm::dvec4 world = pose.world_at(pixel, depth_m, kWidth_px, kHeight_px);
            const glm::dvec2 found = pixel_of(*matrices.ndc_from_world, world, kWidth_px, kHeight_px);
            EXPECT_NEAR(found.x, pixel.x, 1e-3);
            EXPECT_NEAR(found.y, pixel.y, 1e-3);
            EXPECT_NEAR((glm_matrix(*matrices.camera_from_world) * world).z, -depth_m, 1e-4 * depth_m + 1e-5);
        }
}

TEST(StoredMatrices, OfEveryConventionShowPointsWhereTheCameraSawThem) {
    const CameraPose pose = turned_pose();
    Camera camera;
    set_pose(camera, pose, kWidth_px, kHeight_px);
    for (const Convention& convention : conventions()) {
        SCOPED_TRACE(convention.name);
        const StoredMatrices matrices = read_matrices(part_with(attributes_of(camera, convention)), {});
        EXPECT_EQ(matrices.fault, "");
        EXPECT_NE(matrices.found.find(convention.left_handed ? "+z ahead" : "-z ahead"), std::string::npos);
        EXPECT_NE(matrices.found.find(convention.unsigned_ndc ? "0 to 1" : "-1 to 1"), std::string::npos);
        expect_matches(matrices, pose);
    }
}

TEST(StoredMatrices, OfACameraAtTheOriginAreReadToo) {
    CameraPose pose = turned_pose();
    pose.position_m = {0, 0, 0};
    Camera camera;
    set_pose(camera, pose, kWidth_px, kHeight_px);
    for (const Convention& convention : conventions()) {
        SCOPED_TRACE(convention.name);
        expect_matches(read_matrices(part_with(attributes_of(camera, convention)), {}), pose);
    }
}

TEST(StoredMatrices, AreWrittenByOpenExrsDefinition) {
    const CameraPose pose = turned_pose();
    Camera camera;
    set_pose(camera, pose, kWidth_px, kHeight_px);
    std::map<std::string, ExrValue> attributes;
    add_matrices(camera, attributes);
    // ImfStandardAttributes.h: a point times worldToCamera has +z ahead; times worldToNDC it is (0, 0) at the
    // upper left and (1, 1) at the lower right corner of the display window.
    const glm::dvec2 pixel(16, 27);
    const glm::dvec4 point = pose.world_at(pixel, 5, kWidth_px, kHeight_px);
    const auto times = [&](const char* name) {
        const auto& m = std::get<std::vector<float>>(attributes.at(name));
        glm::dvec4 result(0.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                result[column] += point[row] * double(m[std::size_t(row * 4 + column)]);
        return result;
    };
    EXPECT_NEAR(times("worldToCamera").z, 5, 1e-4);
    const glm::dvec4 ndc = times("worldToNDC");
    EXPECT_NEAR(ndc.x / ndc.w, pixel.x / kWidth_px, 1e-5);
    EXPECT_NEAR(ndc.y / ndc.w, pixel.y / kHeight_px, 1e-5);
    expect_matches(read_matrices(part_with(attributes), {}), pose);
}

TEST(StoredMatrices, ThatEqualEachOtherGiveTheProjectionOfTheLens) {
    const CameraPose pose = turned_pose();
    Camera camera;
    set_pose(camera, pose, kWidth_px, kHeight_px);
    auto attributes = attributes_of(camera, {"Karma", true});
    attributes["worldToNDC"] = attributes["worldToCamera"];
    const ExrPart part = part_with(attributes);
    const StoredMatrices without = read_matrices(part, {});
    EXPECT_TRUE(without.camera_from_world);
    EXPECT_FALSE(without.ndc_from_world);
    EXPECT_EQ(without.fault, "worldToNDC equals worldToCamera: it does not project");
    Camera lens;
    lens.set("focal_length", pose.focal_length_mm);
    lens.set("sensor_width", pose.sensor_width_mm);
    const StoredMatrices with = read_matrices(part, lens);
    EXPECT_EQ(with.found, "worldToCamera, +z ahead; projection of the lens");
    expect_matches(with, pose);
}

TEST(StoredMatrices, ThatFitNothingAreRefusedWithTheReason) {
    const CameraPose pose = turned_pose();
    Camera camera;
    set_pose(camera, pose, kWidth_px, kHeight_px);
    const auto fault_of = [&](const std::string& name, auto change) {
        auto attributes = attributes_of(camera, {"OpenEXR", true, true, true});
        change(std::get<std::vector<float>>(attributes.at(name)));
        const StoredMatrices matrices = read_matrices(part_with(attributes), {});
        EXPECT_FALSE(matrices.ndc_from_world);
        return matrices.fault;
    };
    EXPECT_EQ(fault_of("worldToCamera", [](auto& m) { m[0] += 0.5f; }),
              "worldToCamera is not a camera's: its axes are not at right angles and of one length");
    EXPECT_EQ(fault_of("worldToNDC", [](auto& m) { m[3] += 0.5f; }),
              "worldToNDC does not divide by the distance that worldToCamera gives");
    EXPECT_EQ(fault_of("worldToNDC",
                       [](auto& m) {
                           for (int row = 0; row < 4; ++row) m[std::size_t(row * 4)] *= 2;
                       }),
              "worldToNDC is for a picture of another aspect ratio than the display window");
}

/// Arnold's P is in world space: each pixel's point must be in that pixel.
struct TransformCase {
    std::string name;
    std::string version;      ///< vrayInfo/vrayversion; "" for no such attribute
    bool is_of_maya = false;  ///< rows are right, back and down, else right, up and back
};

/// The pose's world has y up; 3ds Max's has z up.
glm::dmat4 world_from_camera(const CameraPose& pose, bool is_of_maya) {
    glm::dmat4 placed = pose.world_from_view();
    if (is_of_maya) return glm::dmat4(placed[0], placed[2], -placed[1], placed[3]);
    for (int column = 0; column < 4; ++column)
        placed[column] = {placed[column].x, -placed[column].z, placed[column].y, placed[column].w};
    return placed;
}

/// Where a point of the pose's world is in the world of the file.
glm::dvec4 in_files_world(const glm::dvec4& point, bool is_of_maya) {
    return is_of_maya ? point : glm::dvec4(point.x, -point.z, point.y, point.w);
}

class CameraTransform : public testing::TestWithParam<TransformCase> {};

TEST_P(CameraTransform, ShowsPointsWhereTheCameraSawThem) {
    const TransformCase& row = GetParam();
    CameraPose pose = turned_pose();
    pose.angles_deg[2] = 0;
    std::map<std::string, ExrValue> attributes = {
        {"cameraTransform", stored(world_from_camera(pose, row.is_of_maya), false)}};
    if (!row.version.empty()) attributes["vrayInfo/vrayversion"] = row.version;
    Camera lens;
    lens.set("focal_length", pose.focal_length_mm);
    lens.set("sensor_width", pose.sensor_width_mm);
    const StoredMatrices read = read_matrices(part_with(attributes), lens);
    ASSERT_TRUE(read.camera_from_world && read.ndc_from_world) << read.fault;
    for (const glm::dvec2 pixel : {glm::dvec2(3, 4), glm::dvec2(40, 30)}) {
        const glm::dvec4 world =
            in_files_world(pose.world_at(pixel, 5, kWidth_px, kHeight_px), row.is_of_maya);
        const glm::dvec4 clip = glm_matrix(*read.ndc_from_world) * world;
        EXPECT_NEAR((clip.x / clip.w + 1) / 2 * kWidth_px, pixel.x, 1e-3);
        EXPECT_NEAR((1 - clip.y / clip.w) / 2 * kHeight_px, pixel.y, 1e-3);
        EXPECT_NEAR((glm_matrix(*read.camera_from_world) * world).z, -5, 1e-4);
    }
    EXPECT_NE(
        read.found.find(row.is_of_maya ? "rows are right, back and down" : "rows are right, up and back"),
        std::string::npos)
        << read.found;
}

INSTANTIATE_TEST_SUITE_P(VRay, CameraTransform,
                         testing::Values(TransformCase{"Maya", "Version of V-Ray for Maya 3.60.05", true},
                                         TransformCase{"MayaWithoutItsName", "", true},
                                         TransformCase{"Max", "", false}),
                         [](const auto& row) { return row.param.name; });

TEST(StoredMatrices, OfVRayThatDoNotTellWhichRowIsUpAreNotTaken) {
    // Level and along an axis, so that the rows are upright either way.
    const ExrPart part = part_with(
        {{"cameraTransform", std::vector<float>{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 5, 20, 1}}});
    const StoredMatrices read = read_matrices(part, {});
    EXPECT_FALSE(read.camera_from_world);
    EXPECT_EQ(read.fault, "cameraTransform does not show which of its rows is up");
}

TEST(StoredMatrices, OfVRaysRealFileLookAlongTheRoom) {
    AFTERSHADE_REQUIRE_CAPTURE(path, "producers/vray/vray36_maya_crypto_normals.exr");
    Camera lens;
    lens.set("focal_length", 35);
    lens.set("sensor_width", 36);
    const StoredMatrices read = read_matrices(ExrFile(*path).parts().front(), lens);
    ASSERT_TRUE(read.camera_from_world && read.ndc_from_world) << read.fault;
    const glm::dvec4 ahead = glm_matrix(*read.camera_from_world) * glm::dvec4(0, 5, 0, 1);
    EXPECT_NEAR(glm::length(ahead - glm::dvec4(0, 0, -20, 1)), 0, 1e-4);
    const glm::dvec4 above = glm_matrix(*read.ndc_from_world) * glm::dvec4(0, 6, 0, 1);
    EXPECT_GT(above.y / above.w, 0);
}

TEST(StoredMatrices, OfArnoldShowItsPositionsInTheirPixels) {
    AFTERSHADE_REQUIRE_CAPTURE(path, "producers/arnold/arnold75_N_P_aovs.exr");
    const ExrFile file(*path);
    const ExrPart& part = file.parts()[0];
    const StoredMatrices matrices = read_matrices(part, {});
    EXPECT_EQ(matrices.found, "worldToCamera, +z ahead; worldToScreen, -1 to 1 with y up");
    ASSERT_TRUE(matrices.ndc_from_world) << matrices.fault;
    const Image position = file.read_floats(0, std::vector<std::string>{"P.X", "P.Y", "P.Z"});
    const Image alpha = file.read_floats(0, std::vector<std::string>{"A"});
    const Window& data = part.data_window;
    double sum_px = 0;
    int count = 0;
    for (int y = 0; y < position.height(); ++y)
        for (int x = 0; x < position.width(); ++x) {
            if (alpha.at(x, y, 0) < 1) continue;
            const glm::dvec4 world(position.at(x, y, 0), position.at(x, y, 1), position.at(x, y, 2), 1);
            const glm::dvec2 found = pixel_of(*matrices.ndc_from_world, world, part.display_window.width(),
                                              part.display_window.height());
            sum_px += glm::length(found - glm::dvec2(x + data.min_x + 0.5, y + data.min_y + 0.5));
            ++count;
        }
    ASSERT_GT(count, 1000);
    EXPECT_LT(sum_px / count, 0.05);
}

TEST(StoredMatrices, OfOtherProducersAreRecognized) {
    const std::vector<std::pair<std::string, std::string>> expected = {
        {"arnold/arnold51_beauty_3crypto.exr", "worldToCamera, +z ahead; worldToNDC, -1 to 1 with y up"},
        {"arnold/arnold_three_crypto.exr", "worldToCamera, +z ahead; worldToScreen, -1 to 1 with y up"},
        {"clarisse/clarisse_two_crypto.exr", "worldToCamera, -z ahead; worldToNDC, -1 to 1 with y up"},
        {"karma/karma_cpu_solaris_one_crypto.exr", "worldToCamera, +z ahead"},
        {"nuke/special_chars.exr", "worldToCamera, +z ahead; worldToNDC, -1 to 1 with y up"}};
    for (const auto& [name, found] : expected) {
        AFTERSHADE_REQUIRE_CAPTURE(path, "producers/" + name);
        const StoredMatrices matrices = read_matrices(ExrFile(*path).parts()[0], {});
        EXPECT_EQ(matrices.found, found) << name << ": " << matrices.fault;
    }
}

}  // namespace
}  // namespace aftershade::test
