#include "framework/scene/scene_reader.h"

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

TEST(SceneDocument, HasUnitsKeysParentsAndRepetitions) {
    const Scene scene = scene_of(R"({
        "aftershade": 1, "frames": "1-4,8", "fps": 30, "cuts": [3], "size": [64, 32],
        "camera": { "position": ["10 cm", 0, "2 m"], "focal_length": "5 cm", "blades": 6 },
        "shutter": { "angle": "0.5 turn", "phase": "start" },
        "materials": { "clay": { "albedo": 0.5 },
                       "tiles": { "albedo": { "checker": [[0, 0, 0], [1, 1, 1]], "cells": [4, 2] } } },
        "objects": [
            { "name": "arm", "shape": "group", "rotation": { "keys": { "1": [0, 0, 0], "4": [0, "90 deg", 0] } } },
            { "name": "ball", "parent": "arm", "shape": "sphere", "radius": "5 cm", "material": "tiles",
              "repeat": { "count": [2, 3, 1], "step": [1, 2, 0], "id_step": 5 }, "id": 7 } ],
        "lights": [ { "type": "area", "position": [0, 2, 0], "size": [1, "50 cm"], "intensity": 3 } ] })");
    EXPECT_EQ(scene.frames, (std::vector<int>{1, 2, 3, 4, 8}));
    EXPECT_DOUBLE_EQ(scene.camera.position_m.at(1).x, 0.1);
    EXPECT_DOUBLE_EQ(scene.camera.focal_length_mm.at(1), 50);
    EXPECT_DOUBLE_EQ(scene.camera.shutter_angle_deg, 180);
    ASSERT_EQ(scene.objects.size(), 7u);
    EXPECT_EQ(scene.objects[6].parent, 0);
    EXPECT_EQ(scene.objects[6].id, 7u + 5 * 5);
    EXPECT_EQ(scene.objects[6].position_m.at(1), glm::dvec3(1, 4, 0));
    EXPECT_DOUBLE_EQ(scene.objects[0].rotation_deg.at(2.5).y, 45);
    EXPECT_DOUBLE_EQ(scene.objects[1].shape.half_size_m.x, 0.05);
    EXPECT_EQ(scene.materials[1].checker_cells, glm::dvec2(4, 2));
    EXPECT_DOUBLE_EQ(scene.lights[0].size_m.y, 0.5);
}

TEST(SceneDocument, CutsTheSequenceIntoShots) {
    Scene scene;
    scene.cuts = {5, 9};
    EXPECT_EQ(scene.shot_of(5).first, 5);
    EXPECT_EQ(scene.shot_of(8).last, 8);
    EXPECT_LT(scene.shot_of(4).first, -1e8);
    EXPECT_EQ(scene.shot_of(4).last, 4);
    EXPECT_GT(scene.shot_of(9).last, 1e8);
}

struct Fault {
    const char* what;
    const char* key;    ///< put into the scene below
    const char* error;  ///< part of the message
};

class SceneFaults : public testing::TestWithParam<Fault> {};

TEST_P(SceneFaults, AreToldWithTheirPlace) {
    Diagnostics diagnostics;
    const std::string text = R"({ "aftershade": 1, "camera": {}, "objects": [],
)" + std::string(GetParam().key) +
                             " }";
    const auto node = parse_document(text, "scene.json", diagnostics);
    ASSERT_TRUE(node) << faults_of(diagnostics);
    EXPECT_FALSE(parse_scene(*node, diagnostics));
    EXPECT_NE(faults_of(diagnostics).find(GetParam().error), std::string::npos) << faults_of(diagnostics);
    EXPECT_NE(faults_of(diagnostics).find("scene.json:2:"), std::string::npos) << faults_of(diagnostics);
}

const Fault kFaults[] = {
    {"unknown key", R"("light": [])", "the scene has no key 'light'; did you mean 'lights'?"},
    {"frames", R"("frames": "1-x")", "frames are a range"},
    {"size", R"("size": [0, 20])", "size: 0 is below the minimum 1"},
    {"half a size", R"("size": [10.5, 20])", "size: 10.5 is not a whole number"},
    {"cut", R"("cuts": [2, 2])", "'cuts' holds 2 twice"},
    {"fps", R"("fps": 0)", "fps: 0 is below the minimum 0.001"},
    {"background", R"("background": [0, -1, 0])", "background: -1 is below the minimum 0"},
    {"keys where there are none", R"("fps": { "keys": { "1": 2 } })", "fps does not take keys"},
    {"shutter", R"("shutter": { "angle": 400 })", "shutter.angle: 400 deg is above the maximum 360 deg"},
    {"phase", R"("shutter": { "phase": "centre" })", "did you mean 'center'?"},
    {"material", R"("materials": { "a": { "albedo": 1.5 } })", "materials.a.albedo"},
    {"checker", R"("materials": { "a": { "albedo": { "checker": [1], "cells": [2, 2] } } })",
     "a checker has two colours"},
    {"profile type",
     R"("materials": { "a": { "scattering_profile": { "type": "burly", "d_mm": [1, 1, 1] } } })",
     "did you mean 'burley'?"},
    {"profile", R"("materials": { "a": { "scattering_profile": { "type": "burley", "d_mm": [1, 0, 1] } } })",
     "d_mm: 0 is below the minimum 1e-06"},
    {"mesh of nothing", R"("meshes": { "a": {} })", "either a 'file' or a 'height_field'"},
    {"mesh file", R"("meshes": { "a": { "file": "nowhere.glb" } })", "nowhere.glb"},
    {"light type", R"("lights": [ { "type": "spot" } ])",
     "'type' is 'spot' but must be 'point', 'directional' or 'area'"},
    {"light without place", R"("lights": [ { "type": "point" } ])", "has no 'position'"},
    {"no direction", R"("lights": [ { "type": "directional", "position": [0, 0, 0] } ])",
     "one point, which gives no direction"},
    {"pattern of a lamp",
     R"("lights": [ { "type": "point", "position": [0, 1, 0], "pattern": { "type": "edge" } } ])",
     "no key 'pattern'"},
    {"pattern axis",
     R"("lights": [ { "type": "directional", "position": [0, 1, 0], "pattern": { "type": "edge", "axis": [0, 0, 0] } } ])",
     "axis: has no length"},
};
INSTANTIATE_TEST_SUITE_P(All, SceneFaults, testing::ValuesIn(kFaults));

class ObjectFaults : public testing::TestWithParam<Fault> {};

TEST_P(ObjectFaults, AreToldWithTheirPlace) {
    Diagnostics diagnostics;
    const std::string text = R"({ "aftershade": 1, "camera": {}, "materials": { "clay": {} }, "objects": [
{ "name": "first", "shape": "sphere", "radius": 1, "material": "clay" },
)" + std::string(GetParam().key) +
                             " ] }";
    const auto node = parse_document(text, "scene.json", diagnostics);
    ASSERT_TRUE(node) << faults_of(diagnostics);
    EXPECT_FALSE(parse_scene(*node, diagnostics));
    EXPECT_NE(faults_of(diagnostics).find(GetParam().error), std::string::npos) << faults_of(diagnostics);
    EXPECT_NE(faults_of(diagnostics).find("scene.json:3:"), std::string::npos) << faults_of(diagnostics);
}

const Fault kObjectFaults[] = {
    {"shape", R"({ "shape": "ball", "material": "clay" })", "'shape' is 'ball' but must be 'group'"},
    {"no radius", R"({ "shape": "sphere", "material": "clay" })", "has no 'radius'"},
    {"another's key", R"({ "shape": "sphere", "radius": 1, "height": 2, "material": "clay" })",
     "no key 'height'"},
    {"radius", R"({ "shape": "sphere", "radius": -1, "material": "clay" })",
     "objects[1].radius: -1 m is below the minimum"},
    {"unit", R"({ "shape": "sphere", "radius": "1 s", "material": "clay" })", "cannot be converted to m"},
    {"material", R"({ "shape": "sphere", "radius": 1, "material": "cley" })",
     "there is no material 'cley'; did you mean 'clay'?"},
    {"no material", R"({ "shape": "sphere", "radius": 1 })", "objects[1] has no material"},
    {"parent", R"({ "shape": "group", "parent": "last" })", "there is no earlier object 'last'"},
    {"own parent", R"({ "name": "me", "shape": "group", "parent": "me" })",
     "there is no earlier object 'me'"},
    {"name", R"({ "name": "first", "shape": "group" })", "two objects are named 'first'"},
    {"mesh", R"({ "shape": "mesh", "mesh": "bat", "material": "clay" })", "there is no mesh 'bat'"},
    {"key", R"({ "shape": "group", "position": { "keys": { "one": [0, 0, 0] } } })",
     "a key is a frame number"},
    {"no keys", R"({ "shape": "group", "position": { "keys": {} } })", "there is no key"},
    {"keys", R"({ "shape": "group", "position": { "keys": { "1": [0, 0] } } })",
     "expected an array of 3 numbers"},
    {"one frame twice",
     R"({ "shape": "group", "position": { "keys": { "1": [0, 0, 0], "1.0": [1, 0, 0] } } })",
     "frame 1 has two keys"},
    {"interpolation",
     R"({ "shape": "group", "position": { "keys": { "1": [0, 0, 0] }, "interpolation": "cubic" } })",
     "'interpolation' is 'cubic' but must be"},
    {"repetition", R"({ "shape": "group", "repeat": { "count": [1.5, 1, 1] } })",
     "repeat.count: 1.5 is not a whole number"},
    {"too many", R"({ "shape": "group", "repeat": { "count": [100, 100, 1] } })",
     "repeat.count: makes 10000 objects, more than 8192"},
    {"id", R"({ "shape": "group", "id": 16777216 })", "id: 16777216 is above the maximum 16777215"},
};
INSTANTIATE_TEST_SUITE_P(All, ObjectFaults, testing::ValuesIn(kObjectFaults));

TEST(SceneDocument, TellsAllItsFaultsAtOnce) {
    Diagnostics diagnostics;
    const auto node =
        parse_document(R"({ "aftershade": 1, "fps": -1, "camera": { "f_number": 0, "blades": 2 },
        "objects": [ { "shape": "cone" } ], "lights": [ {} ] })",
                       "scene.json", diagnostics);
    EXPECT_FALSE(parse_scene(*node, diagnostics));
    EXPECT_EQ(diagnostics.error_count(), 5) << faults_of(diagnostics);
}

}  // namespace
}  // namespace aftershade::scene
