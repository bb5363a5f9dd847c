// The truth that `render --truth` wrote beside a frame: a view, and figures that hold for what `run` makes.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "framework/compare/metrics.h"
#include "framework/file/exr_file.h"
#include "framework/file/png_file.h"
#include "framework/image/srgb.h"
#include "tests/serve/serve_fixture.h"
#include "tests/wide_capture.h"

namespace aftershade::test {
namespace {

void write_truth(const std::filesystem::path& path, int width = 64, const std::string& space = "rec709") {
    SyntheticScene scene{
        .width = width, .height = 36, .background = {0.12f, 0.2f, 0.35f}, .background_depth_m = 8};
    scene.box = SyntheticBox{5, 6, 16, 12, 5, 2};
    write_capture(in_space(make_capture(scene, 1), space), path);
}

Image rgb_in(const std::filesystem::path& path) {
    return ExrFile(path).read_floats(0, std::vector<std::string>{"R", "G", "B"});
}

TEST_F(Serve, MeasuresTheColourOfItsStepsAgainstTheTruthBesideTheFrame) {
    start();
    EXPECT_EQ(get("/api/state").json()["capture"]["truths"], Json::object());
    write_truth(folder_ / "truth_lens_shutter_0001.exr");
    EXPECT_EQ(get("/api/state").json()["capture"]["truths"], (Json{{"1", {"lens+shutter"}}}));
    const Json metrics = get("/api/metrics?frame=1&truth=lens%2Bshutter").json();

    const CommandResult run =
        run_aftershade({"run", "look.json", "in_0001.exr", "--output-roles", "color", "--pixel-type", "float",
                        "-o", "out.exr", "--backend", "software"},
                       folder_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const double psnr_db =
        display_psnr_db(rgb_in(folder_ / "truth_lens_shutter_0001.exr"), rgb_in(folder_ / "out.exr"));
    EXPECT_NEAR(metrics["psnr_db"].get<double>(), psnr_db, 1e-6);
    const CommandResult compared = run_aftershade(
        {"compare", "truth_lens_shutter_0001.exr", "out.exr", "--json", "--flip", "ldr"}, folder_.path());
    double flip = -1;  // where no layer has colours
    const Json report = Json::parse(compared.out);
    for (const Json& layer : report["layers"])
        if (layer["layer"] == "RGB") flip = layer["ldr_flip"]["mean"];
    EXPECT_NEAR(metrics["flip"].get<double>(), flip, 1e-6);
    EXPECT_TRUE(get("/api/picture?frame=1&view=truth:lens%2Bshutter").body.starts_with("\x89PNG"));
}

TEST_F(Serve, MeasuresATruthInOtherPrimariesByItsLight) {
    start();
    write_truth(folder_ / "truth_lens_0001.exr");
    write_truth(folder_ / "truth_shutter_0001.exr", 64, "acescg");
    const Json expected = get("/api/metrics?frame=1&truth=lens").json();
    const Json metrics = get("/api/metrics?frame=1&truth=shutter").json();
    EXPECT_NEAR(metrics["psnr_db"].get<double>(), expected["psnr_db"].get<double>(), 1e-3);
    EXPECT_NEAR(metrics["flip"].get<double>(), expected["flip"].get<double>(), 1e-5);
}

TEST_F(Serve, ShowsHowFarEachPixelIsFromTheTruthAsBrightAsTheExposureMakesIt) {
    start();
    write_truth(folder_ / "truth_lens_0001.exr");
    const CommandResult run =
        run_aftershade({"run", "look.json", "in_0001.exr", "--output-roles", "color", "--pixel-type", "float",
                        "-o", "out.exr", "--backend", "software"},
                       folder_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Image truth = rgb_in(folder_ / "truth_lens_0001.exr"), made = rgb_in(folder_ / "out.exr");
    for (const int stops : {0, 3}) {
        const Answer answer =
            get("/api/picture?frame=1&view=difference:lens&exposure=" + std::to_string(stops));
        ASSERT_EQ(answer.status, 200) << answer.body;
        write_text(folder_ / "shown.png", answer.body);
        const Image shown = read_png(folder_ / "shown.png");
        double brightest = 0;
        for (int y = 0; y < 36; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c) {
                    const double apart = std::abs(double(made.at(x, y, c)) - double(truth.at(x, y, c)));
                    const double expected = std::clamp(encode_srgb(apart * std::exp2(stops)), 0.0, 1.0);
                    ASSERT_NEAR(shown.at(x, y, c), expected, 0.6 / 255) << x << " " << y << " " << stops;
                    brightest = std::max(brightest, expected);
                }
        EXPECT_GT(brightest, 0.1);
    }
    EXPECT_EQ(get("/api/picture?frame=1&view=difference:lens&scale=4").status, 200);
    EXPECT_EQ(get("/api/picture?frame=1&view=difference:shutter").status, 404);
    const Answer again = get("/api/picture?frame=1");
    EXPECT_EQ(again.status, 200) << again.body;
}

TEST_F(Serve, TakesATruthFromARegularFileOfTheFramesSizeAlone) {
    start();
    write_truth(folder_ / "elsewhere.exr");
    std::filesystem::create_symlink(folder_ / "elsewhere.exr", folder_ / "truth_lens_0001.exr");
    write_truth(folder_ / "truth_shutter_0001.exr", 32);
    write_text(folder_ / "truth_antialias_0001.exr", "no EXR");
    EXPECT_EQ(get("/api/state").json()["capture"]["truths"], (Json{{"1", {"antialias", "shutter"}}}));
    for (const char* name : {"lens", "", "../secret", "scattering"})
        EXPECT_EQ(get(std::string("/api/metrics?frame=1&truth=") + name).status, 404) << name;
    const Answer other_size = get("/api/metrics?frame=1&truth=shutter");
    EXPECT_EQ(other_size.status, 409);
    EXPECT_NE(other_size.body.find("32x36 px, the capture 64x36"), std::string::npos) << other_size.body;
    EXPECT_EQ(get("/api/metrics?frame=1&truth=antialias").status, 400);
    EXPECT_EQ(get("/api/picture?frame=1&view=truth:lens").status, 404);
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
}

}  // namespace
}  // namespace aftershade::test
