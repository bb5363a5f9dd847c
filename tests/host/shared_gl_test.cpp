// Frames that never leave the GPU, with an EGL context of the test's own in the place of an engine's.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "aftershade/host.h"
#include "tests/host/host_setup.h"
#include "tests/host/own_egl.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;

constexpr int kWidth = 48, kHeight = 32;

HostOptions sharing(const OwnEgl& egl) {
    HostOptions options = on_software();
    options.backend = Backend::automatic;
    options.share = SharedEgl{egl.display, egl.context};
    return options;
}

std::vector<float> flipped(std::span<const float> rows, std::size_t row) {
    std::vector<float> result(rows.size());
    const std::size_t count = rows.size() / row;
    for (std::size_t y = 0; y < count; ++y) std::copy_n(&rows[y * row], row, &result[(count - 1 - y) * row]);
    return result;
}

/// The capture's images as textures, as GL draws them: from the bottom up.
Capture on_gpu(const OwnEgl& egl, const Capture& capture) {
    Capture textures = capture;
    const auto add = [&](const char* role, GLenum format, GLenum layout, std::size_t channels) {
        const GLuint name = egl.texture(format, kWidth, kHeight);
        const auto rows = flipped(capture.image(role).floats(), kWidth * channels);
        egl.gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        egl.gl.TextureSubImage2D(name, 0, 0, 0, kWidth, kHeight, layout, GL_FLOAT, rows.data());
        textures.set_texture(role, {name, kWidth, kHeight});
    };
    add("color", GL_RGBA32F, GL_RGBA, 4);
    add("depth", GL_R32F, GL_RED, 1);
    return textures;
}

TEST(HostSharedGl, TexturesGiveTheBitsOfArrays) {
    OwnEgl egl;
    Host host(sharing(egl));
    Look look = host.parse_look(kBlurLook);
    const Capture arrays = small_capture(kWidth, kHeight);
    const Image expected = look.render(arrays).image("color");
    EXPECT_TRUE(egl.is_current());

    const Capture textures = on_gpu(egl, arrays);
    const GLuint target = egl.texture(GL_RGBA32F, kWidth, kHeight);
    const GLsync written = egl.gl.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    egl.gl.Flush();
    const Result result = look.render(
        textures, {.targets = {{"color", {target, kWidth, kHeight}}}, .wait = written, .wants_fence = true});
    egl.gl.DeleteSync(written);
    ASSERT_TRUE(egl.is_current());
    ASSERT_NE(result.fence(), nullptr);
    const auto done = static_cast<GLsync>(result.fence());
    EXPECT_NE(egl.gl.ClientWaitSync(done, GL_SYNC_FLUSH_COMMANDS_BIT, 5'000'000'000u),
              GLenum(GL_TIMEOUT_EXPIRED));
    egl.gl.DeleteSync(done);
    const auto rows = flipped(egl.read(target, GL_RGBA, kWidth * kHeight * 4), kWidth * 4);
    EXPECT_TRUE(std::ranges::equal(rows, expected.floats()));
    EXPECT_TRUE(result.roles().empty());
    EXPECT_EQ(egl.gl.GetError(), GLenum(GL_NO_ERROR));
}

TEST(HostSharedGl, TexturesOfPixelsThatAreNotSquareGiveTheBitsOfArraysToo) {
    const TemporaryFolder folder;
    const std::string in = folder.path() / "in.exr";
    aftershade::Capture frame = make_capture({.width = kWidth,
                                              .height = kHeight,
                                              .background = {0.1f, 0.2f, 0.4f},
                                              .background_depth_m = 2,
                                              .points = {{20, 10, 50}, {40, 25, 9}}});
    frame.header.pixel_aspect = 1.5f;
    write_capture(frame, in);
    OwnEgl egl;
    Host host(sharing(egl));
    Look look = host.parse_look(kBlurLook);
    const Capture arrays = look.read(in);
    const Image expected = look.render(arrays).image("color");
    const GLuint target = egl.texture(GL_RGBA32F, kWidth, kHeight);
    look.render(on_gpu(egl, arrays), {.targets = {{"color", {target, kWidth, kHeight}}}});
    const auto rows = flipped(egl.read(target, GL_RGBA, kWidth * kHeight * 4), kWidth * 4);
    EXPECT_TRUE(std::ranges::equal(rows, expected.floats()));
}

TEST(HostSharedGl, ValuesAreTakenFromTexturesToo) {
    OwnEgl egl;
    Host host(sharing(egl));
    Look look = host.parse_look(kBlurLook);
    look.set("bokeh.focus_distance", Json{R"({"from": "depth", "uv": [0.25, 0.5]})"});
    const Capture arrays = small_capture(kWidth, kHeight);
    const Image expected = look.render(arrays).image("color");
    EXPECT_TRUE(same_bits(look.render(on_gpu(egl, arrays)).image("color"), expected));
}

TEST(HostSharedGl, LeavesTheCallersContextCurrentWhateverTheBackend) {
    OwnEgl egl;
    const GLuint mine = egl.texture(GL_RGBA32F, 4, 4);
    Host host(on_software());
    Look look = host.parse_look(kBlurLook);
    const Image first = look.render(small_capture()).image("color");
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(egl.is_current());
        const float value[4] = {1, 2, 3, float(i)};
        egl.gl.ClearTexImage(mine, 0, GL_RGBA, GL_FLOAT, value);
        EXPECT_TRUE(same_bits(look.render(small_capture()).image("color"), first));
        EXPECT_EQ(egl.read(mine, GL_RGBA, 64)[63], float(i));
    }
    EXPECT_EQ(egl.gl.GetError(), GLenum(GL_NO_ERROR));
}

TEST(HostSharedGl, LeavesTheCallersChoiceOfAnApi) {
    OwnEgl egl;
    egl.bind_es_api();
    Host host(sharing(egl));
    host.parse_look(kBlurLook).render(small_capture());
    EXPECT_TRUE(egl.is_es_api_bound());
    EXPECT_TRUE(egl.is_current());
}

TEST(HostSharedGl, RefusesTexturesThatDoNotFit) {
    OwnEgl egl;
    Host host(sharing(egl));
    Look look = host.parse_look(kBlurLook);
    const Capture capture = small_capture(kWidth, kHeight);
    const auto message = [&](const GlTexture& target) -> std::string {
        try {
            look.render(capture, {.targets = {{"color", target}}});
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            return error.what();
        }
        return "";
    };
    const auto expect = [&](const GlTexture& target, const char* part) {
        EXPECT_NE(message(target).find(part), std::string::npos) << message(target);
    };
    expect({9999, kWidth, kHeight}, "is not a texture of the shared context");
    expect({egl.texture(GL_RGBA32F, 16, 16), 16, 16}, "16 x 16 texels");
    expect({egl.texture(GL_RGBA32F, 16, 16), kWidth, kHeight}, "has 16 x 16 texels");
    expect({egl.texture(GL_RG32F, kWidth, kHeight), kWidth, kHeight}, "has 2 channels");
    expect({egl.texture(GL_RGBA32UI, kWidth, kHeight), kWidth, kHeight}, "holds integers");
    EXPECT_NO_THROW(look.render(capture));
    EXPECT_EQ(egl.gl.GetError(), GLenum(GL_NO_ERROR));
}

}  // namespace
