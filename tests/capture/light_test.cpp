#include "framework/capture/light.h"

#include <sstream>

#include <gtest/gtest.h>

namespace aftershade {
namespace {

std::string faults(const std::string& text) {
    Diagnostics diagnostics;
    if (const auto node = parse_document(text, "capture.json", diagnostics)) parse_lights(*node, diagnostics);
    std::ostringstream out;
    diagnostics.print(out);
    return out.str();
}

TEST(Lights, AreReadBackAsTheyWereWritten) {
    const double third = 1.0 / 3;
    const std::vector<CaptureLight> lights = {
        {CaptureLight::Kind::point, "key \"one\"", {0.1, -2.5, third}, {}, {}, {1e-3, 2, 4e5}},
        {CaptureLight::Kind::directional, "", {}, {0.6, 0, -0.8}, {}, {1, 1, 1}},
        {CaptureLight::Kind::area, "soft", {1, 2, 3}, {0, -1, 0}, {0.5, third}, {7, 0, 0}}};
    Diagnostics diagnostics;
    const auto node = parse_document(format_lights(lights), "lights", diagnostics);
    ASSERT_TRUE(node);
    EXPECT_EQ(parse_lights(*node, diagnostics), lights);
    EXPECT_FALSE(diagnostics.has_errors());
}

TEST(Lights, HaveDirectionsOfUnitLengthAndUnits) {
    Diagnostics diagnostics;
    const auto node = parse_document(
        R"([ { "type": "area", "position": ["10 cm", 0, 0], "direction": [3, 0, 4], "size": [1, "5 mm"], "intensity": [1, 1, 1] } ])",
        "lights", diagnostics);
    const CaptureLight light = parse_lights(*node, diagnostics).at(0);
    EXPECT_DOUBLE_EQ(light.position_m[0], 0.1);
    EXPECT_DOUBLE_EQ(light.size_m[1], 0.005);
    EXPECT_DOUBLE_EQ(light.direction[0], 0.6);
    EXPECT_DOUBLE_EQ(light.direction[2], 0.8);
}

TEST(Lights, TellTheirFaults) {
    const std::pair<const char*, const char*> cases[] = {
        {R"({})", "lights are an array"},
        {R"([ {} ])", "the light has no 'type'"},
        {R"([ { "type": "spot", "intensity": [1, 1, 1] } ])", "'type' is 'spot' but must be"},
        {R"([ { "type": "point", "intensity": [1, 1, 1] } ])", "the light has no 'position'"},
        {R"([ { "type": "point", "position": [0, 0, 0], "intensity": [1, -1, 1] } ])",
         "light.intensity: -1 is below the minimum 0"},
        {R"([ { "type": "point", "position": [0, 0], "intensity": [1, 1, 1] } ])",
         "expected an array of 3 numbers"},
        {R"([ { "type": "point", "position": ["1 s", 0, 0], "intensity": [1, 1, 1] } ])",
         "cannot be converted to m"},
        {R"([ { "type": "directional", "direction": [0, 0, 0], "intensity": [1, 1, 1] } ])",
         "light.direction: has no length"},
        {R"([ { "type": "directional", "direction": [0, 0, 1], "position": [0, 0, 0], "intensity": [1, 1, 1] } ])",
         "no key 'position'"},
        {R"([ { "type": "point", "position": [0, 0, 0], "intensit": [1, 1, 1], "intensity": [1, 1, 1] } ])",
         "did you mean 'intensity'?"},
    };
    for (const auto& [text, message] : cases)
        EXPECT_NE(faults(text).find(message), std::string::npos) << text << "\n" << faults(text);
}

}  // namespace
}  // namespace aftershade
