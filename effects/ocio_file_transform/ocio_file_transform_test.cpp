// Files of transforms against OpenColorIO's own CPU processor.
#include <algorithm>
#include <exception>
#include <string>

#include <gtest/gtest.h>

#include "tests/ocio_oracle.h"

#ifdef AFTERSHADE_HAS_OPENCOLORIO

namespace aftershade::test::ocio_file_transform {
namespace {

using namespace colors;

constexpr const char* kClf = R"(<?xml version="1.0" encoding="UTF-8"?>
<ProcessList compCLFversion="3" id="steps">
  <Matrix inBitDepth="32f" outBitDepth="32f"><Array dim="3 3">0.8 0.2 0 0.1 0.9 0 0 0.1 0.9</Array></Matrix>
  <Log inBitDepth="32f" outBitDepth="32f" style="linToLog"><LogParams base="2" linSideSlope="1" linSideOffset="0.01"
    logSideSlope="0.1" logSideOffset="0.7"/></Log>
  <Range inBitDepth="32f" outBitDepth="32f"><minInValue>0</minInValue><maxInValue>1</maxInValue>
    <minOutValue>0</minOutValue><maxOutValue>1</maxOutValue></Range>
</ProcessList>
)";

constexpr const char* kCorrections = R"(<ColorCorrectionCollection xmlns="urn:ASC:CDL:v1.2">
  <ColorCorrection id="day"><SOPNode><Slope>1.2 1 0.9</Slope><Offset>0 0.01 0</Offset><Power>1 1.1 0.9</Power></SOPNode>
    <SatNode><Saturation>0.7</Saturation></SatNode></ColorCorrection>
  <ColorCorrection id="night"><SOPNode><Slope>0.5 0.6 0.9</Slope><Offset>0 0 0</Offset><Power>1 1 1</Power></SOPNode>
  </ColorCorrection>
</ColorCorrectionCollection>
)";

void expect_equal(const std::string& file, bool inverse, const std::string& correction = "") {
    const Image light = test_light();
    const auto transform = ocio::FileTransform::Create();
    transform->setSrc(file.c_str());
    transform->setCCCId(correction.c_str());
    transform->setInterpolation(ocio::INTERP_BEST);
    const auto processor = ocio::Config::CreateRaw()->getProcessor(
        transform, inverse ? ocio::TRANSFORM_DIR_INVERSE : ocio::TRANSFORM_DIR_FORWARD);
    const Image image = drawn("ocio_file_transform", light,
                              R"("file": ")" + file + R"(", "correction": ")" + correction +
                                  R"(", "inverse": )" + (inverse ? "true" : "false"),
                              "color");
    EXPECT_LT(largest_error(image, by_cpu(light, processor), Measure::linear), kLinearLimit)
        << file << " " << correction << inverse;
}

TEST(OcioFileTransform, EqualsOpenColorIosProcessorForwardAndBack) {
    const StudioConfig studio;
    write_text(studio.folder() / "steps.clf", kClf);
    write_text(studio.folder() / "grades.ccc", kCorrections);
    for (const bool inverse : {false, true}) {
        for (const char* file : {"luts/cube.cube", "luts/curve.cube", "luts/long.spi1d", "steps.clf"})
            expect_equal((studio.folder() / file).string(), inverse);
        for (const char* correction : {"day", "night"})
            expect_equal((studio.folder() / "grades.ccc").string(), inverse, correction);
    }
}

TEST(OcioFileTransform, LeavesEveryBitWithoutAFile) {
    const Image light = test_light();
    const Image image = drawn("ocio_file_transform", light, "", "color");
    EXPECT_TRUE(std::ranges::equal(image.floats(), light.floats()));
}

TEST(OcioFileTransform, SaysWhatAFileLacks) {
    const StudioConfig studio;
    write_text(studio.folder() / "grades.ccc", kCorrections);
    write_text(studio.folder() / "bad.clf", "<ProcessList>");
    write_text(studio.folder() / "point.cube", "LUT_3D_SIZE 1\n0 0 0\n");
    const auto fault_of = [&](const std::string& file, const std::string& more) -> std::string {
        try {
            drawn("ocio_file_transform", test_light(),
                  R"("file": ")" + (studio.folder() / file).string() + "\"" + more, "color");
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(fault_of("bad.clf", "").find("bad.clf' is not a transform"), std::string::npos)
        << fault_of("bad.clf", "");
    EXPECT_NE(fault_of("point.cube", "").find("point.cube' is not a transform"), std::string::npos);
    EXPECT_NE(fault_of("grades.ccc", R"(, "correction": "dusk")").find("dusk"), std::string::npos);
}

}  // namespace
}  // namespace aftershade::test::ocio_file_transform
#endif
