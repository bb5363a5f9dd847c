// What crosses to the process of the plug-ins arrives as it was sent; what nobody sent is refused.
#include "framework/effect/native/native_wire.h"

#include <gtest/gtest.h>

#include "framework/base/error.h"

namespace aftershade {
namespace {

NativeResult sample_result() {
    NativeResult result;
    result.uniforms["gain"] = std::vector<float>{0.1f, -3.0e38f};
    result.uniforms["ids"] = std::vector<std::uint32_t>{0, 4'000'000'000u};
    result.uniforms["steps"] = std::vector<std::int32_t>{-7};
    result.tables["kernel"] = {NativeElement::vec2, 2, 1, std::vector<std::byte>(16, std::byte{0xfe})};
    result.repeats["blur"] = 3;
    result.enabled["blur"] = false;
    result.warm_up_frames = 4;
    result.overscan_px = 5;
    result.log = {{NativeLogLevel::warning, "narrow"}};
    return result;
}

std::string bytes_of(const NativeResult& result) {
    WireWriter out;
    put(out, result);
    return out.bytes();
}

TEST(NativeWire, BringsAResultAsItWas) {
    const NativeResult sent = sample_result();
    const std::string bytes = bytes_of(sent);
    WireReader in(bytes);
    const NativeResult got = take_result(in);
    EXPECT_NO_THROW(in.expect_end());
    EXPECT_EQ(got.uniforms, sent.uniforms);
    EXPECT_EQ(got.tables.at("kernel").bytes, sent.tables.at("kernel").bytes);
    EXPECT_EQ(got.tables.at("kernel").element, NativeElement::vec2);
    EXPECT_EQ(got.repeats, sent.repeats);
    EXPECT_EQ(got.enabled, sent.enabled);
    EXPECT_EQ(got.warm_up_frames, 4);
    EXPECT_EQ(got.overscan_px, 5);
    EXPECT_EQ(got.log.at(0).text, "narrow");
}

TEST(NativeWire, RefusesWhatIsCutShortOrHoldsWrongNumbers) {
    const std::string bytes = bytes_of(sample_result());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const std::string part = bytes.substr(0, size);
        WireReader in(part);
        EXPECT_THROW(take_result(in), Error) << size;
    }
    // Every word as a count, an index or a length that is far too large.
    for (std::size_t at = 0; at + 8 <= bytes.size(); ++at) {
        std::string changed = bytes;
        changed.replace(at, 8, 8, '\x7f');
        WireReader in(changed);
        try {
            take_result(in);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::effect);
        }
    }
}

TEST(NativeWire, RefusesMoreNumbersThanTheMessageHasRoomFor) {
    WireWriter out;
    out.number(1);  // uniforms
    out.text("gain");
    out.number(0);  // floats
    out.number(4096);
    // Room for 4096 things of a byte, which are 512 floats.
    const std::string bytes = out.bytes() + std::string(4096, '\0');
    WireReader in(bytes);
    in.number();
    in.text();
    in.number();
    EXPECT_EQ(in.count(), 4096u);
    WireReader again(bytes);
    again.number();
    again.text();
    again.number();
    EXPECT_THROW(again.count(sizeof(double)), Error);
}

TEST(NativeWire, BringsAFrameWithItsParametersAndCamera) {
    std::vector<ParamSpec> specs(3);
    specs[0].name = "radius";
    specs[0].unit = "px";
    specs[1].name = "shape";
    specs[1].type = ParamType::enum_;
    specs[2].name = "tint";
    specs[2].type = ParamType::color;
    ParamSet values;
    values.set("radius", 0.1);
    values.set("shape", std::string("hexagon"));
    values.set("tint", std::vector<double>{0.25, 0.5, 1});
    Camera camera;
    camera.set("f_number", 1.4);
    camera.camera_from_world = CameraMatrix{1, 2, 3};
    NativeFrame frame;
    frame.specs = &specs;
    frame.params = &values;
    frame.camera = &camera;
    frame.metadata = {{"comments", "of the capture"}};
    frame.images = {{"color", "color", 1920, 1080, 4, true}};
    frame.number = -3;
    frame.fps = 23.976;
    frame.step_seed = 4'000'000'000u;
    WireWriter out;
    put(out, frame);
    WireReader in(out.bytes());
    WireFrame got;
    take_frame(in, got);
    EXPECT_NO_THROW(in.expect_end());
    ASSERT_EQ(got.specs.size(), 3u);
    EXPECT_EQ(got.specs[0].unit, "px");
    EXPECT_EQ(got.specs[2].type, ParamType::color);
    for (const ParamSpec& spec : specs)
        EXPECT_EQ(got.params.get(spec.name), values.get(spec.name)) << spec.name;
    EXPECT_EQ(got.camera.get("f_number"), 1.4);
    EXPECT_EQ(got.camera.camera_from_world, camera.camera_from_world);
    EXPECT_EQ(got.camera.ndc_from_world, std::nullopt);
    EXPECT_EQ(got.frame.metadata, frame.metadata);
    EXPECT_EQ(got.frame.images.at(0).width_px, 1920);
    EXPECT_EQ(got.frame.number, -3);
    EXPECT_EQ(got.frame.fps, 23.976);
    EXPECT_EQ(got.frame.step_seed, 4'000'000'000u);
}

}  // namespace
}  // namespace aftershade
