// The views of a frame besides the final picture, and what it is where the capture is at fault.
#include <string>

#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

const std::string kThree = R"({ "aftershade": 1, "steps": [
  { "effect": "color_grade", "params": { "exposure": 1 } },
  { "effect": "vignette", "params": { "strength": 1 } },
  { "effect": "view_transform" } ] })";

TEST_F(Serve, ShowsThePictureBeforeAStepAsTheStepsBeforeItDraw) {
    look_ = kThree;
    start();
    const auto view = [&](const std::string& name) { return get("/api/picture?frame=1&view=" + name).body; };
    const std::string final = view("final"), before_vignette = view("before:vignette");
    EXPECT_EQ(view("before:color_grade"), view("before"));
    EXPECT_EQ(view("final"), final) << "the whole look is drawn again after it";
    ASSERT_EQ(edit({{"op", "remove"}, {"step", 2}}).status, 200);
    ASSERT_EQ(edit({{"op", "remove"}, {"step", 1}}).status, 200);
    EXPECT_EQ(view("final"), before_vignette);
    const Answer gone = get("/api/picture?frame=1&view=before:vignette");
    EXPECT_EQ(gone.status, 400);
    EXPECT_NE(gone.body.find("no enabled step 'vignette'"), std::string::npos) << gone.body;
}

TEST_F(Serve, SaysWhatFalseColoursMean) {
    start();
    const Json depth = times("&view=role:depth")["legend"];
    EXPECT_EQ(depth["words"][0], "1 to 8 m") << depth;  // the box and what is behind it
    EXPECT_EQ(depth["drawing"], "ramp");
    EXPECT_EQ(depth["colors"].front(), "#fde725") << "viridis ends in yellow, which is near";
    EXPECT_EQ(depth["colors"].back(), "#440154");
    EXPECT_EQ(times("&view=role:velocity")["legend"]["drawing"], "wheel");
    EXPECT_EQ(times("&view=role:object_id")["legend"]["words"][1], "a colour each, 0 is black");
    for (const char* view : {"final", "before", "role:color", "before:vignette"})
        EXPECT_FALSE(times(std::string("&view=") + view).contains("legend")) << view;
}

TEST_F(Serve, NamesTheFaultyPixelsOfFalseColours) {
    has_nan_ = true;
    start();
    const Json faults = times("&view=tap:vignette.color")["legend"]["faults"];
    ASSERT_EQ(faults.size(), 1) << faults;
    EXPECT_EQ(faults[0]["name"], "NaN");
}

TEST_F(Serve, ShowsTheCaptureAndNamesTheStepWhereTheCaptureIsAtFault) {
    look_ = R"({ "aftershade": 1, "steps": [ { "effect": "color_grade" },
        { "effect": "dof", "name": "lens", "params": { "focus_distance": { "from": "depth", "object": 77 } } } ] })";
    start();
    for (const char* scale : {"", "&scale=4"}) {
        const Answer picture = get(std::string("/api/picture?frame=1") + scale);
        ASSERT_EQ(picture.status, 200) << picture.body;
        EXPECT_EQ(picture.body, get("/api/picture?frame=1&view=before:color_grade").body);
        const Json fault = Json::parse(picture.header("X-Aftershade-Times"))["fault"];
        EXPECT_EQ(fault["step"], "lens");
        EXPECT_NE(fault["message"].get<std::string>().find("object 77 has no pixel with a depth"),
                  std::string::npos);
    }
    EXPECT_EQ(get("/api/picture?frame=1&view=before:lens").status, 200) << "the steps before it can be drawn";
    const Answer tap = get("/api/picture?frame=1&view=tap:color_grade.color");
    EXPECT_EQ(tap.body, get("/api/picture?frame=1&view=before:color_grade").body) << "as the final picture";
    EXPECT_EQ(Json::parse(tap.header("X-Aftershade-Times"))["fault"]["step"], "lens");
    EXPECT_EQ(get("/api/picture?frame=1&format=png").status, 400) << "a file is of the look";
    const Json pixel = get("/api/probe?frame=1&x=12&y=12").json();
    EXPECT_EQ(pixel["objects"][0]["id"], 2) << "which may take the place of the one that lacks";
    EXPECT_EQ(pixel["result"], nullptr);
    const std::string depth = get("/api/picture?frame=1&view=role:depth").body;
    const Json histogram = get("/api/histogram?frame=1").json();
    EXPECT_EQ(post("/api/thumbnail?frame=1", R"({"edits": []})").status, 400)
        << "a thumbnail would show the step as if it did nothing";
    ASSERT_EQ(edit({{"op", "enable"}, {"step", 1}, {"value", false}}).status, 200);
    EXPECT_FALSE(times().contains("fault"));
    EXPECT_EQ(get("/api/picture?frame=1&view=role:depth").body, depth) << "steps have no part in it";
    ASSERT_EQ(edit({{"op", "enable"}, {"step", 0}, {"value", false}}).status, 200);
    EXPECT_EQ(get("/api/histogram?frame=1").json(), histogram);
}

TEST_F(Serve, GivesTheSchemaOfItsLooks) {
    write_effect("mine", "c.r *= 2;");
    start({"--effect-path", "effects"});
    const CommandResult printed =
        run_aftershade({"schema", "look", "--effect-path", "effects"}, folder_.path());
    ASSERT_EQ(printed.exit_code, 0) << printed.err;
    const Json schema = get("/api/schema").json();
    EXPECT_EQ(schema, Json::parse(printed.out));
    EXPECT_NE(schema.dump().find("\"mine\""), std::string::npos);
}

}  // namespace
}  // namespace aftershade::test
