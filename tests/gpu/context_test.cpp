#include "framework/gpu/context.h"

#include <cstdlib>
#include <set>
#include <type_traits>

#include "framework/base/error.h"
#include "framework/gpu/context_internal.h"
#include "framework/gpu/platform.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

static_assert(!std::is_copy_constructible_v<Context> && !std::is_move_constructible_v<Context>);

class ContextOn : public SoftwareTest {};
ON_EACH_BACKEND(ContextOn);

TEST_P(ContextOn, PassesItsSelfTestAndSaysThatItIsSoftware) {
    const ContextInfo& info = context().info();
    EXPECT_EQ(info.backend, GetParam());
    EXPECT_TRUE(info.software) << info.renderer;
    EXPECT_FALSE(info.renderer.empty());
    EXPECT_FALSE(info.vendor.empty());
    EXPECT_EQ(info.version.substr(0, 2), "4.") << info.version;
}

/// Nothing that is drawn comes into a target.
void mask_colour(Context& context, bool masked) {
    context.make_current();
    const GLboolean writes = masked ? GL_FALSE : GL_TRUE;
    context.gl().ColorMask(writes, writes, writes, writes);
}

/// Draws 2 to a texel; returns what it then holds.
std::vector<float> two_drawn(Context& context) {
    const Program program = Program::draw(
        context, kFullScreen,
        "#version 450 core\nlayout(location = 0) out vec4 c; void main() { c = vec4(2); }", "two");
    const Texture target(context, {.width = 1, .height = 1, .format = TextureFormat::rgba32f}, "target");
    const Target targets[] = {{.texture = &target}};
    draw(context, program, targets, {});
    return target.read_floats();
}

TEST_P(ContextOn, DrawsAPutOffSelfTestBeforeItsFirstDrawUntilItPassesOnce) {
    Context late(GetParam(), SelfTest::at_first_use);
    mask_colour(late, true);
    for (int i = 0; i < 2; ++i) {
        try {
            two_drawn(late);
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::gl);
            EXPECT_EQ(std::string(error.what()).substr(0, 12), "self-test on") << error.what();
        }
    }
    mask_colour(late, false);
    EXPECT_EQ(two_drawn(late), std::vector<float>(4, 2.0F));
    mask_colour(late, true);
    EXPECT_NO_THROW(late.test_once());
    EXPECT_NO_THROW(two_drawn(late));
}

/// A backend whose self-test fails gives way to the next one.
TEST_P(ContextOn, IsTestedAtOnceWhereAnotherBackendMayTakeItsPlace) {
    Context chosen(Backend::automatic, SelfTest::at_first_use);
    mask_colour(chosen, true);
    EXPECT_NO_THROW(two_drawn(chosen));
}

/// Whatever the memory held before: of these sizes the allocator gives it out again.
TEST_P(ContextOn, HasZerosInNewTextures) {
    EXPECT_TRUE(context().zeroes_new_textures());
    for (const int side : {16, 64, 512}) {
        const TextureDesc desc{.width = side, .height = side, .format = TextureFormat::rgba32f, .mips = 3};
        const std::vector<float> sevens(std::size_t(4 * side * side), 7.0F);
        Texture(context(), desc, "sevens").upload(sevens);
        context().finish();
        EXPECT_EQ(Texture(context(), desc, "new").read_floats(), std::vector<float>(sevens.size(), 0.0F));
    }
}

TEST_P(ContextOn, ReportsNoErrorWhenThereIsNone) {
    context().finish();
    EXPECT_NO_THROW(context().check("nothing"));
}

TEST_P(ContextOn, TwoOfTheSameKindAlternate) {
    Context other(GetParam());
    Texture mine(context(), {.width = 1, .height = 1, .format = TextureFormat::r32f}, "mine");
    Texture theirs(other, {.width = 1, .height = 1, .format = TextureFormat::r32f}, "theirs");
    for (int i = 0; i < 3; ++i) {
        mine.clear(1.0F + static_cast<float>(i));
        theirs.clear(10.0F + static_cast<float>(i));
        EXPECT_EQ(mine.read_floats(), std::vector<float>{1.0F + static_cast<float>(i)});
        EXPECT_EQ(theirs.read_floats(), std::vector<float>{10.0F + static_cast<float>(i)});
    }
}

TEST_P(ContextOn, SurvivesTheDeathOfAnother) {
    Texture mine = texture(1, 1, TextureFormat::r32f);
    mine.clear(3.0F);
    { Context other(GetParam()); }
    EXPECT_EQ(mine.read_floats(), std::vector<float>{3.0F});
}

TEST_P(ContextOn, KeepsMovedFromObjectsHarmless) {
    Texture first = texture(1, 1, TextureFormat::r32f);
    first.clear(1.0F);
    Texture second(std::move(first));
    EXPECT_EQ(first.handle(), 0U);  // NOLINT: the moved-from state is what is tested
    Texture third = texture(2, 2, TextureFormat::r32f);
    third = std::move(second);
    EXPECT_EQ(third.read_floats(), std::vector<float>{1.0F});
    Buffer buffer(context(), 4, "a");
    Buffer moved(std::move(buffer));
    buffer = Buffer(context(), 8, "b");
    EXPECT_EQ(buffer.size(), 8U);
    EXPECT_EQ(moved.size(), 4U);
    Program program = fragment("layout(location = 0) out vec4 c; void main() { c = vec4(1); }");
    Program taken(std::move(program));
    EXPECT_EQ(program.handle(), 0U);  // NOLINT: as above
    EXPECT_EQ(drawn(taken, 1, 1), std::vector<float>(4, 1.0F));
}

TEST_P(ContextOn, CountsTheObjectsThatAreAlive) {
    const ObjectCounts before = context().objects();
    {
        Texture first = texture(4, 4, TextureFormat::r32f);
        const Texture moved(std::move(first));
        const Buffer buffer(context(), 4, "a");
        const Program program = fragment("layout(location = 0) out vec4 c; void main() { c = vec4(1); }");
        EXPECT_EQ(context().objects().textures, before.textures + 1);
        EXPECT_EQ(context().objects().buffers, before.buffers + 1);
        EXPECT_EQ(context().objects().programs, before.programs + 1);
        drawn(program, 1, 1);  // into a target that has a framebuffer while it lives
    }
    EXPECT_EQ(context().objects().total(), before.total());
}

TEST(Context, EglAndOsmesaAlternateInOneProcess) {
    for (Backend backend : {Backend::egl_software, Backend::osmesa}) {
        if (const std::string reason = why_not(backend); !reason.empty()) GTEST_SKIP() << reason;
    }
    Context egl(Backend::egl_software);
    Context osmesa(Backend::osmesa);
    Texture a(egl, {.width = 1, .height = 1, .format = TextureFormat::r32f}, "a");
    Texture b(osmesa, {.width = 1, .height = 1, .format = TextureFormat::r32f}, "b");
    for (int i = 0; i < 3; ++i) {
        a.clear(1.0F);
        b.clear(2.0F);
        EXPECT_EQ(a.read_floats(), std::vector<float>{1.0F});
        EXPECT_EQ(b.read_floats(), std::vector<float>{2.0F});
    }
}

TEST(Context, ProbesEveryBackendWithAReasonForEachThatFails) {
    const std::vector<BackendReport> reports = probe_backends();
    ASSERT_EQ(reports.size(), 3U);
    std::set<Backend> seen;
    for (const BackendReport& report : reports) {
        seen.insert(report.backend);
        EXPECT_EQ(report.usable, report.reason.empty()) << report.reason;
        if (report.usable) {
            EXPECT_EQ(report.info.backend, report.backend);
            EXPECT_EQ(report.info.software, report.backend != Backend::egl);
        }
        RecordProperty(std::string(backend_name(report.backend)),
                       report.usable ? report.info.renderer : report.reason);
    }
    EXPECT_EQ(seen.size(), 3U);
}

TEST(Context, RefusesWithEveryBackendTriedAndItsReason) {
    if (why_not(Backend::egl).empty()) GTEST_SKIP() << "this machine has hardware GL";
    try {
        const Context context(Backend::egl);
        FAIL() << "made a context";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::gl);
        EXPECT_EQ(std::string(error.what()), "no usable GL\n  egl: " + why_not(Backend::egl));
    }
}

TEST(Context, SpellsItsBackendsAsTheCommandLineDoes) {
    for (Backend backend :
         {Backend::automatic, Backend::egl, Backend::egl_software, Backend::osmesa, Backend::software}) {
        EXPECT_EQ(parse_backend(backend_name(backend)), backend);
    }
    EXPECT_EQ(parse_backend("egl-software"), Backend::egl_software);
    EXPECT_EQ(parse_backend("EGL"), std::nullopt);
}

TEST(Context, LeavesTheEnvironmentAsItWas) {
    const char* before = std::getenv("LIBGL_ALWAYS_SOFTWARE");
    const std::string text = before ? before : "";
    probe_backends();
    const char* after = std::getenv("LIBGL_ALWAYS_SOFTWARE");
    EXPECT_EQ(before != nullptr, after != nullptr);
    EXPECT_EQ(text, after ? after : "");
}

TEST(Platform, KnowsSoftwareRenderersByTheirNames) {
    EXPECT_TRUE(is_software_renderer("llvmpipe (LLVM 15.0.6, 256 bits)"));
    EXPECT_TRUE(is_software_renderer("zink Vulkan 1.3(llvmpipe (LLVM 15.0.6, 256 bits))"));
    EXPECT_TRUE(is_software_renderer("softpipe"));
    EXPECT_TRUE(is_software_renderer("Software Rasterizer"));
    EXPECT_TRUE(is_software_renderer("D3D12 (Microsoft Basic Render Driver)"));
    EXPECT_TRUE(is_software_renderer("ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)))"));
    EXPECT_TRUE(is_software_renderer("zink Vulkan 1.3(lavapipe)"));
    EXPECT_FALSE(is_software_renderer("NVIDIA H200/PCIe/SSE2"));
    EXPECT_FALSE(is_software_renderer("AMD Radeon RX 6800 (navi21, LLVM 15.0.6, DRM 3.49)"));
}

TEST(Platform, NamesThePackageOfALibraryThatIsMissing) {
    try {
        open_library({"libnone.so.1", "libnone.so"}, "libnone1");
        FAIL() << "a library that does not exist was opened";
    } catch (const AbsentLibrary& error) {
        EXPECT_NE(std::string(error.what()).find("libnone.so.1"), std::string::npos) << error.what();
        EXPECT_EQ(error.advice(), "; install the Debian package libnone1");
    }
}

TEST(Platform, QuotesTheLoaderOfALibraryThatIsThereAndCannotBeLoaded) {
    // A file that is no library.
    const std::string script = AFTERSHADE_SOURCE_DIR "/README.md";
    try {
        open_library({"libnone.so.1", script.c_str()}, "libnone1");
        FAIL() << "a text was opened as a library";
    } catch (const AbsentLibrary& error) {
        FAIL() << error.advice();
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("is there, but the loader refuses it: " + script), std::string::npos) << text;
        EXPECT_EQ(text.find("install"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace aftershade::gpu
