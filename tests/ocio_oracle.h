// OpenColorIO's own CPU processor beside the effects that draw what it gives as shaders.
#pragma once

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "framework/capture/capture.h"
#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/scattering_checks.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace aftershade::test::colors {

namespace ocio = OCIO_NAMESPACE;

/// Light of 64x48 pixels: a ramp over 24 stops of grey and of each channel, the 24 patches of the
/// ColorChecker (linear Rec. 709, after BabelColor's averages of 2012) at four exposures, and a piece of
/// Suzanne.
inline Image test_light() {
    constexpr float kPatches[24][3] = {
        {.17f, .08f, .06f}, {.54f, .30f, .22f}, {.12f, .19f, .34f},  {.10f, .15f, .05f}, {.23f, .22f, .44f},
        {.13f, .50f, .40f}, {.67f, .20f, .03f}, {.08f, .11f, .39f},  {.53f, .09f, .13f}, {.11f, .05f, .15f},
        {.34f, .50f, .05f}, {.76f, .36f, .03f}, {.03f, .05f, .29f},  {.06f, .30f, .07f}, {.42f, .04f, .04f},
        {.84f, .57f, .01f}, {.49f, .09f, .30f}, {-.03f, .24f, .38f}, {.88f, .88f, .86f}, {.58f, .59f, .58f},
        {.36f, .36f, .36f}, {.19f, .19f, .19f}, {.09f, .09f, .09f},  {.03f, .03f, .03f}};
    const Image suzanne =
        read_blender_capture(AFTERSHADE_SOURCE_DIR "/scenes/suzanne/gbuffer_####.exr", 3, {"color"})
            .images.at("color");
    Image light(64, 48, 4);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const float ramp = std::exp2(-16 + 24 * float(x) / 63);
            for (int c = 0; c < 3; ++c) {
                const int channel = y / 4;
                float value = channel == 0 || channel == c + 1 ? ramp : 0.3f * ramp;
                if (y >= 16)
                    value = kPatches[(y - 16) / 4 * 8 % 24 + x / 8][c] * std::exp2(float(y % 4 * 2 - 3));
                if (y >= 28) value = suzanne.at(200 + x, 100 + 2 * (y - 28), c);
                light.at(x, y, c) = value;
            }
            light.at(x, y, 3) = 1;
        }
    return light;
}

inline Capture capture_of(const Image& light) {
    Capture capture = make_capture({.width = light.width(), .height = light.height()});
    capture.images.at("color") = light;
    return capture;
}

inline Image by_cpu(Image image, const ocio::ConstProcessorRcPtr& processor) {
    ocio::PackedImageDesc pixels(image.floats().data(), image.width(), image.height(), 4);
    processor->getDefaultCPUProcessor()->apply(pixels);
    return image;
}

/// The largest difference of the first three channels: of linear light as a share of the value, or of 0.01
/// where that is more; of display values as it is, both cut to [0, 1].
enum class Measure { linear, display };
inline double largest_error(const Image& a, const Image& b, Measure measure) {
    double largest = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                double one = a.at(x, y, c), other = b.at(x, y, c);
                if (measure == Measure::display)
                    one = std::clamp(one, 0.0, 1.0), other = std::clamp(other, 0.0, 1.0);
                const double unit = measure == Measure::display ? 1 : std::max(std::abs(other), 0.01);
                largest = std::max(largest, std::abs(one - other) / unit);
            }
    return largest;
}
inline constexpr double kLinearLimit = 1e-3, kDisplayLimit = 1.0 / 1023;

/// What the step makes on each software backend, which must agree in every bit.
inline Image drawn(const std::string& effect, const Image& light, const std::string& params,
                   const std::string& role) {
    Image first;
    for (const gpu::Backend backend : gpu::test_backends()) {
        if (!gpu::why_not(backend).empty()) continue;
        const Image image =
            LookRunner(look_of_step(effect, params), backend).run(capture_of(light)).images.at(role);
        if (first.width() == 0) first = image;
        EXPECT_TRUE(std::ranges::equal(first.floats(), image.floats())) << params;
    }
    return first;
}

/// The built-in config with more spaces, and the LUTs that they name, in a folder of their own.
class StudioConfig {
public:
    StudioConfig() : config_(builtin()->createEditableCopy()) {
        std::filesystem::create_directory(folder_ / "luts");
        write_luts();
        config_->setSearchPath("luts");
        add("matrix", [] {
            const double matrix[16] = {.9, .1, 0, 0, .05, .8, .15, 0, .02, .03, .95, 0, 0, 0, 0, 1};
            const auto made = ocio::MatrixTransform::Create();
            made->setMatrix(matrix);
            return made;
        }());
        add("log", ocio::LogTransform::Create());
        add("camera", [] {
            const double slope[3] = {.25, .25, .25}, offset[3] = {.4, .4, .4}, linear[3] = {5, 5, 5};
            const double shift[3] = {.06, .06, .06}, cut[3] = {.01, .01, .01};
            const auto made = ocio::LogCameraTransform::Create(cut);
            made->setBase(10);
            made->setLogSideSlopeValue(slope);
            made->setLogSideOffsetValue(offset);
            made->setLinSideSlopeValue(linear);
            made->setLinSideOffsetValue(shift);
            return made;
        }());
        add("cdl", [] {
            const double slope[3] = {1.1, 1, .9}, offset[3] = {.01, 0, -.01}, power[3] = {1.2, 1, .8};
            const auto made = ocio::CDLTransform::Create();
            made->setSlope(slope);
            made->setOffset(offset);
            made->setPower(power);
            made->setSat(.8);
            return made;
        }());
        add("gamma", [] {
            const double gamma[4] = {2.2, 2.4, 2.6, 1};
            const auto made = ocio::ExponentTransform::Create();
            made->setValue(gamma);
            made->setDirection(ocio::TRANSFORM_DIR_INVERSE);
            return made;
        }());
        add("curve", file("curve.cube", ocio::INTERP_LINEAR));
        add("long_curve", file("long.spi1d", ocio::INTERP_LINEAR));
        add("cube", file("cube.cube", ocio::INTERP_LINEAR));
        add("tetrahedra", file("cube.cube", ocio::INTERP_TETRAHEDRAL));
        config_->addDisplayView("Monitor", "Film", "cube", "");
        add_look();
        std::ofstream(path()) << *config_;
    }

    std::string path() const { return (folder_ / "config.ocio").string(); }
    ocio::ConstConfigRcPtr config() const { return ocio::Config::CreateFromFile(path().c_str()); }
    const TemporaryFolder& folder() const { return folder_; }

    static ocio::ConstConfigRcPtr builtin() {
        return ocio::Config::CreateFromFile(AFTERSHADE_SOURCE_DIR "/framework/color/builtin.ocio");
    }

private:
    static ocio::FileTransformRcPtr file(const char* name, ocio::Interpolation interpolation) {
        const auto made = ocio::FileTransform::Create();
        made->setSrc(name);
        made->setInterpolation(interpolation);
        return made;
    }

    /// From linear Rec. 709, so that the transform gets the numbers that a test puts in.
    void add(const char* name, const ocio::ConstTransformRcPtr& transform) {
        const auto group = ocio::GroupTransform::Create();
        group->appendTransform(config_->getColorSpace("lin_rec709")
                                   ->getTransform(ocio::COLORSPACE_DIR_FROM_REFERENCE)
                                   ->createEditableCopy());
        group->appendTransform(transform->createEditableCopy());
        const auto space = ocio::ColorSpace::Create();
        space->setName(name);
        space->setTransform(group, ocio::COLORSPACE_DIR_FROM_REFERENCE);
        config_->addColorSpace(space);
    }

    void add_look() {
        const double slope[3] = {1.3, 1, 0.7};
        const auto cdl = ocio::CDLTransform::Create();
        cdl->setSlope(slope);
        const auto look = ocio::Look::Create();
        look->setName("warm");
        look->setProcessSpace("lin_rec709");
        look->setTransform(cdl);
        config_->addLook(look);
    }

    void write_luts() const {
        std::ofstream curve(folder_ / "luts/curve.cube"), cube(folder_ / "luts/cube.cube");
        curve << "LUT_1D_SIZE 33\n";
        for (int i = 0; i < 33; ++i)
            curve << std::pow(i / 32.0, 0.5) << " " << std::pow(i / 32.0, 0.8) << " " << i / 32.0 << "\n";
        cube << "LUT_3D_SIZE 17\n";
        for (int b = 0; b < 17; ++b)
            for (int g = 0; g < 17; ++g)
                for (int r = 0; r < 17; ++r)
                    cube << std::pow(r / 16.0, 0.6) * 0.9 + g * b / 2560.0 << " " << std::pow(g / 16.0, 0.7)
                         << " " << 0.05 + b / 16.0 * (1 - r / 32.0) << "\n";
        std::ofstream values(folder_ / "luts/long.spi1d");
        values << "Version 1\nFrom -0.5 2\nLength 5000\nComponents 1\n{\n";
        for (int i = 0; i < 5000; ++i) values << 0.2 + 0.7 * std::tanh(i / 2000.0) << "\n";
        values << "}\n";
    }

    TemporaryFolder folder_;
    ocio::ConfigRcPtr config_;
};

}  // namespace aftershade::test::colors
#endif
