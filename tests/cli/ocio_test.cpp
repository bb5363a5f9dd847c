// The command with configs of OpenColorIO: --ocio, describe, exit codes, and what resuming looks at.
#include <nlohmann/json.hpp>

#include "framework/batch/process_codes.h"
#include "framework/color/color_transform.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

constexpr const char* kConfig = R"(ocio_profile_version: 2
search_path: luts
roles: {default: light, aces_interchange: light}
displays: {Monitor: [!<View> {name: Film, colorspace: film}]}
colorspaces:
  - !<ColorSpace> {name: light}
  - !<ColorSpace>
    name: film
    from_scene_reference: !<FileTransform> {src: film.cube}
)";

class OcioCommand : public BatchWork {
protected:
    void SetUp() override {
        if (!has_opencolorio()) GTEST_SKIP() << "SKIPPED: built without OpenColorIO";
        std::filesystem::create_directory(folder_ / "luts");
        write_text(folder_ / "studio.ocio", kConfig);
        write_lut(1);
        // An effect of the test's own, of one function of a config.
        write_effect("film", R"("passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"],
                                  "writes": ["color"] } ],
                                "params": { "config": { "type": "file", "kind": "ocio_config", "default": "", "doc": "." },
                                            "view": { "type": "text", "ocio": "view", "default": "", "doc": "." },
                                            "source": { "type": "text", "ocio": "source", "default": "light", "doc": "." } })",
                     "out_color = vec4(config(texelFetch(color, p, 0).rgb), 1.0);");
        write_frames(1, 2, 16, 9);
    }
    void write_lut(double white) const {
        write_text(folder_ / "luts/film.cube",
                   "LUT_1D_SIZE 2\n0 0 0\n" + std::to_string(white) + " 0.5 0.25\n");
    }
};

TEST_F(OcioCommand, TakesTheConfigOfTheOption) {
    run({"film.json", "in_0001.exr", "-o", "out.exr", "--ocio", "studio.ocio"}, 0);
    EXPECT_NEAR(color("out.exr").at(0, 0, 1), 0.5f * 0.2f, 1e-6);
    run({"film.json", "in_0001.exr", "-o", "set.exr", "--set", "film.config=studio.ocio"}, 0);
    EXPECT_NEAR(color("set.exr").at(0, 0, 1), 0.5f * 0.2f, 1e-6);
    const CommandResult absent =
        run({"film.json", "in_0001.exr", "-o", "out.exr", "--ocio", "studoi.ocio"}, int(ExitCode::usage));
    EXPECT_NE(absent.err.find("--ocio: no file 'studoi.ocio'"), std::string::npos) << absent.err;
}

TEST_F(OcioCommand, RefusesAViewThatTheConfigLacksAtItsPlace) {
    const CommandResult result =
        run({"film.json", "in_0001.exr", "-o", "out.exr", "--ocio", "studio.ocio", "--set", "film.view=Flim"},
            int(ExitCode::usage));
    EXPECT_NE(result.err.find("--set film.view=Flim: error: film.view: the display 'Monitor'"),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("did you mean 'Film'?"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("$OCIO"), std::string::npos)
        << "the variable is not the user's: " << result.err;
}

TEST_F(OcioCommand, DrawsFramesAgainAfterAChangeOfALut) {
    const std::vector<std::string> arguments = {"film.json", "in_####.exr", "-o",      "out_####.exr",
                                                "--ocio",    "studio.ocio", "--resume"};
    run(arguments, 0);
    EXPECT_NE(run(arguments, 0).err.find("2 current, 0 to render"), std::string::npos);
    write_lut(0.5);
    EXPECT_NE(run(arguments, 0).err.find("2 of 2 frames"), std::string::npos);
    EXPECT_NEAR(color("out_0001.exr").at(0, 0, 0), 0.5f * 0.1f, 1e-6);
}

TEST_F(OcioCommand, KeepsNoChannelsBesideAColorOfAnotherSpace) {
    const std::string step = R"({ "effect": "color_convert", "name": ")";
    const std::string there = step + R"(there", "params": { "destination": "ACEScg" } })";
    write_text(folder_ / "there.json", R"({ "aftershade": 1, "steps": [)" + there + "] }");
    write_text(folder_ / "back.json", R"({ "aftershade": 1, "steps": [)" + there + ", " + step +
                                          R"(back", "params": { "source": "ACEScg" } }] })");
    const CommandResult refused =
        run({"there.json", "in_0001.exr", "-o", "there.exr", "--keep-channels"}, int(ExitCode::output));
    EXPECT_NE(refused.err.find("a file names one space"), std::string::npos) << refused.err;
    run({"back.json", "in_0001.exr", "-o", "back.exr", "--keep-channels"}, 0);
}

TEST_F(OcioCommand, DescribesTheNamesOfTheConfig) {
    const CommandResult text = run_aftershade(
        {"describe", "film", "--effect-path", "effects", "--ocio", "studio.ocio"}, folder_.path());
    EXPECT_NE(text.out.find("display 'Monitor' has the views 'Film'"), std::string::npos) << text.out;
    const CommandResult described = run_aftershade(
        {"describe", "film", "--effect-path", "effects", "--ocio", "studio.ocio", "--json"}, folder_.path());
    const auto names = nlohmann::json::parse(described.out).at("ocio");
    EXPECT_EQ(names.at("displays").at("Monitor").at(0), "Film");
    EXPECT_EQ(names.at("spaces"), (nlohmann::json{"light", "film"}));
    EXPECT_EQ(names.at("roles").at("default"), "light");
}

}  // namespace
}  // namespace aftershade::test
