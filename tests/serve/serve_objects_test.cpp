// Names of what a frame shows, and values that follow an object.
#include <map>
#include <string>
#include <vector>

#include "framework/capture/cryptomatte.h"
#include "framework/serve/frame_objects.h"
#include "tests/real_captures.h"
#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

class ServeObjects : public Serve {
protected:
    Json object_at(int x, int y) const {
        return get("/api/probe?frame=1&x=" + std::to_string(x) + "&y=" + std::to_string(y)).json()["objects"];
    }
};

/// The capture's own numbers, with names of a capture.json.
class NamedObjects : public ServeObjects {
protected:
    void change_frames() const override {
        write_text(folder_ / "capture.json",
                   R"({ "aftershade": 1, "frames": "in_0001.exr", "objects": { "Box": 2 } })");
    }
    NamedObjects() { capture_ = "capture.json"; }
};

TEST_F(NamedObjects, AreShownByTheirNamesAndTheOthersByTheirNumbers) {
    start();
    EXPECT_EQ(object_at(12, 12), Json::parse(R"([{"kind": "object", "name": "Box", "id": 2}])"));
    const Json ground = object_at(40, 30);
    ASSERT_EQ(ground.size(), 1u);
    EXPECT_FALSE(ground[0].contains("name"));
    const Json list = get("/api/objects?frame=1").json();
    ASSERT_EQ(list.size(), 2u) << list;
    EXPECT_GT(list[0]["share"], list[1]["share"]) << "the largest first";
    EXPECT_EQ(list[1]["name"], "Box");
    EXPECT_NEAR(list[1]["share"].get<double>(), 16.0 * 12 / (64 * 36), 1e-9);
    // The look names it, and object_id has the name's hash from then on.
    ASSERT_EQ(edit({{"op", "text"}, {"value", R"({ "aftershade": 1, "steps": [ { "effect": "dof", "params":
        { "focus_distance": { "from": "depth", "object": "Box" }, "max_coc_radius": 4 } }, { "effect": "view_transform" } ] })"}})
                  .status,
              200);
    const Json measured = times()["measured"];
    EXPECT_EQ(measured, Json::parse(R"([{"step": "dof", "param": "focus_distance", "value": 1.0}])"));
    EXPECT_EQ(object_at(12, 12)[0]["name"], "Box");
    const Json sharp = times("&view=sharp:dof");
    EXPECT_NEAR(sharp["sharp_m"][0].get<double>(), 1, 1e-6) << "the box, and not what lies behind it at 8 m";
    EXPECT_NEAR(sharp["sharp_m"][1].get<double>(), 1, 1e-6);
    EXPECT_EQ(get("/api/picture?frame=1&view=sharp:view_transform").status, 400);
}

TEST(FrameObjects, OfBlenderAreObjectsAndMaterialsByTheirCoverage) {
    AFTERSHADE_REQUIRE_CAPTURE(file, "blender-versions/5.2.3/multi_0003.exr");
    Diagnostics faults;
    const auto sequence = open_sequence(file->string(), faults);
    ASSERT_TRUE(sequence);
    const CaptureReader reader(*sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", faults), {});
    const std::vector<std::string> roles{"color", "object_id"};
    const Capture whole = reader.read(3, roles);
    const serve::FrameObjects objects(reader, *sequence, 3, whole);
    EXPECT_EQ(objects.at({240, 120}), Json::parse(R"([{"kind": "object", "name": "Suzanne", "id": )" +
                                                  std::to_string(cryptomatte_hash("Suzanne")) +
                                                  R"(}, {"kind": "material", "name": "skin", "id": )" +
                                                  std::to_string(cryptomatte_hash("skin")) + "}]"));
    std::map<std::string, double> share;
    for (const Json& one : objects.list(reader, 3)) share[one.value("name", "")] = one["share"];
    EXPECT_NEAR(share["Suzanne"], 0.104693, 1e-6) << "as inspect --cryptomatte prints it";
    EXPECT_NEAR(share["skin"], 0.104693, 1e-6);
    EXPECT_NEAR(share["cube"], 0.063284, 1e-6);
}

}  // namespace
}  // namespace aftershade::test
