#include "framework/gpu/commands.h"

#include <array>
#include <cstring>
#include <span>

#include "framework/base/error.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

class DrawOn : public SoftwareTest {
protected:
    void draw_to(const Program& program, std::vector<const Texture*> targets, const Bindings& bindings = {},
                 Blend blend = Blend::none) {
        std::vector<Target> whole;
        for (const Texture* texture : targets) whole.push_back({.texture = texture});
        draw(context(), program, whole, bindings, blend);
    }
};
ON_EACH_BACKEND(DrawOn);

constexpr const char* kOne = "layout(location = 0) out vec4 c; void main() { c = vec4(1); }";

TEST_P(DrawOn, StartsAtTheTopLeftTexel) {
    const Program program = fragment("layout(location = 0) out vec4 c;\nvoid main() { c = gl_FragCoord; }");
    const std::vector<float> got = drawn(program, 2, 3);
    EXPECT_EQ(std::vector<float>(got.begin(), got.begin() + 2), (std::vector<float>{0.5F, 0.5F}));
    EXPECT_EQ(std::vector<float>(got.end() - 4, got.end() - 2), (std::vector<float>{1.5F, 2.5F}));
}

TEST_P(DrawOn, FetchesRowZeroOfAnUploadAtFragCoordZero) {
    Texture image = texture(1, 3, TextureFormat::r32f);
    image.upload(std::vector<float>{10.0F, 20.0F, 30.0F});
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 c;
void main() { c = texelFetch(image, ivec2(gl_FragCoord.xy), 0); })");
    const SampledTexture textures[] = {{.texture = &image}};
    const std::vector<float> got = drawn(program, 1, 3, {.textures = textures});
    EXPECT_EQ(got[0], 10.0F);
    EXPECT_EQ(got[4], 20.0F);
    EXPECT_EQ(got[8], 30.0F);
}

TEST_P(DrawOn, PutsNdcYUpAtRowZero) {
    const Program program = Program::draw(context(), R"(#version 450 core
layout(location = 0) out vec2 ndc;
void main() {
    ndc = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
    gl_Position = vec4(ndc, 0.0, 1.0);
})",
                                          R"(#version 450 core
layout(location = 0) in vec2 ndc;
layout(location = 0) out vec4 c;
void main() { c = vec4(ndc, gl_FragCoord.z, 0); })",
                                          "ndc");
    const std::vector<float> got = drawn(program, 1, 2);
    EXPECT_FLOAT_EQ(got[1], 0.5F);  // row 0 is the upper half
    EXPECT_FLOAT_EQ(got[5], -0.5F);
    EXPECT_EQ(got[2], 0.0F);  // NDC z is depth already, in [0, 1]
}

TEST_P(DrawOn, GivesTheEdgeTexelOrZeroOutside) {
    Texture image = texture(2, 2, TextureFormat::r32f);
    image.upload(std::vector<float>{1, 2, 3, 4});
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2D edge;
layout(binding = 3) uniform sampler2D zero;
layout(location = 0) out vec4 c;
void main() {
    c = vec4(textureLod(edge, vec2(-0.9), 0).r, textureLod(zero, vec2(-0.9), 0).r,
             textureLod(edge, vec2(1.9), 0).r, textureLod(zero, vec2(0.75), 0).r);
})");
    const SampledTexture textures[] = {{&image, 0, Filter::nearest, Wrap::clamp},
                                       {&image, 3, Filter::nearest, Wrap::zero}};
    EXPECT_EQ(drawn(program, 1, 1, {.textures = textures}), (std::vector<float>{1, 0, 4, 4}));
}

TEST_P(DrawOn, FiltersLinearlyOnlyWhereAsked) {
    Texture image = texture(2, 1, TextureFormat::r32f);
    image.upload(std::vector<float>{0.0F, 8.0F});
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2D a;
layout(binding = 1) uniform sampler2D b;
layout(location = 0) out vec4 c;
void main() { c = vec4(textureLod(a, vec2(0.5001, 0.5), 0).r, textureLod(b, vec2(0.5, 0.5), 0).r, 0, 0); })");
    const SampledTexture textures[] = {{&image, 0, Filter::nearest, Wrap::clamp},
                                       {&image, 1, Filter::linear, Wrap::clamp}};
    const std::vector<float> got = drawn(program, 1, 1, {.textures = textures});
    EXPECT_EQ(got[0], 8.0F);
    EXPECT_FLOAT_EQ(got[1], 4.0F);
}

TEST_P(DrawOn, ReadsAMipLevelWithEitherFilter) {
    Texture image(context(), {.width = 4, .height = 4, .format = TextureFormat::r32f, .mips = 3}, "pyramid");
    image.upload(std::vector<float>{0, 0, 4, 4, 0, 0, 4, 4, 8, 8, 12, 12, 8, 8, 12, 12});
    image.generate_mips();
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2D a;
layout(binding = 1) uniform sampler2D b;
layout(location = 0) out vec4 c;
void main() {
    c = vec4(textureLod(a, vec2(0.25), 1.0).r, textureLod(a, vec2(0.25), 2.0).r,
             textureLod(b, vec2(0.25), 1.0).r, textureLod(b, vec2(0.25), 1.5).r);
})");
    const SampledTexture textures[] = {{&image, 0, Filter::nearest, Wrap::clamp},
                                       {&image, 1, Filter::linear, Wrap::clamp}};
    const std::vector<float> got = drawn(program, 1, 1, {.textures = textures});
    EXPECT_EQ(got[0], 0.0F);
    EXPECT_EQ(got[1], 6.0F);
    EXPECT_FLOAT_EQ(got[2], 0.0F);
    EXPECT_FLOAT_EQ(got[3], 3.0F);
}

TEST_P(DrawOn, SamplesTheLayersOfAnArray) {
    Texture image(context(), {.width = 1, .height = 1, .format = TextureFormat::r32f, .layers = 2}, "array");
    image.upload(std::vector<float>{1.0F}, 0);
    image.upload(std::vector<float>{2.0F}, 1);
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2DArray image;
layout(location = 0) out vec4 c;
void main() { c = vec4(texelFetch(image, ivec3(0), 0).r, texelFetch(image, ivec3(0, 0, 1), 0).r, 0, 0); })");
    const SampledTexture textures[] = {{.texture = &image}};
    EXPECT_EQ(drawn(program, 1, 1, {.textures = textures}), (std::vector<float>{1, 2, 0, 0}));
}

TEST_P(DrawOn, WritesSeveralTargetsOfDifferentFormats) {
    const Texture colour = texture(2, 2, TextureFormat::rgba16f);
    const Texture ids = texture(2, 2, TextureFormat::r32ui);
    const Texture extra = texture(2, 2, TextureFormat::r32i);
    const Program program = fragment(R"(layout(location = 0) out vec4 c;
layout(location = 1) out uint id;
layout(location = 2) out int signed_id;
void main() { c = vec4(-2, 0.5, 70, 1); id = 4000000000u; signed_id = -3; })");
    draw_to(program, {&colour, &ids, &extra});
    EXPECT_EQ(colour.read_floats()[2], 70.0F);
    EXPECT_EQ(ids.read_uints(), std::vector<std::uint32_t>(4, 4000000000U));
    EXPECT_EQ(extra.read_floats(), std::vector<float>(4, -3.0F));
}

TEST_P(DrawOn, BlendsByAddMinAndMaxAndNotAfterwards) {
    Texture target = texture(1, 1, TextureFormat::rg32f);
    const Program program =
        fragment("layout(location = 0) out vec4 c; void main() { c = vec4(3, -5, 0, 0.25); }");
    const auto blended = [&](Blend blend) {
        target.upload(std::vector<float>{1.0F, 2.0F});
        draw_to(program, {&target}, {}, blend);
        return target.read_floats();
    };
    EXPECT_EQ(blended(Blend::add), (std::vector<float>{4.0F, -3.0F}));
    EXPECT_EQ(blended(Blend::min), (std::vector<float>{1.0F, -5.0F}));
    EXPECT_EQ(blended(Blend::max), (std::vector<float>{3.0F, 2.0F}));
    EXPECT_EQ(blended(Blend::none), (std::vector<float>{3.0F, -5.0F}));
}

TEST_P(DrawOn, GivesTheSameBitsWithOneForm) {
    Program floats = fragment(
        "layout(location = 0) out vec4 c; void main() { c = vec4(-gl_FragCoord.x, 1.0 / 0.0, 1e-40, 0.1); }");
    Program bits = fragment(
        "layout(location = 0) out uvec4 c; void main() { c = uvec4(gl_FragCoord.x, 0xffffffffu, 7u, "
        "0x7fc00001u); }");
    const auto both = [&](bool uses_one_form) {
        if (uses_one_form) floats.use_one_form(), bits.use_one_form();
        const Texture a = texture(70, 67), b = texture(70, 67, TextureFormat::rgba32ui),
                      half = texture(70, 67, TextureFormat::rgba16f);
        draw_to(floats, {&a});
        draw_to(bits, {&b});
        draw_to(floats, {&half});
        return std::tuple(a.read_floats(), b.read_uints(), half.read_floats());
    };
    const auto two_forms = both(false);
    EXPECT_EQ(both(true), two_forms);
    Program two = fragment("layout(location = 0) out vec4 c; void main() { c = vec4(2); }");
    two.use_one_form();
    Texture sum = texture(1, 1);
    sum.clear(1);
    draw_to(two, {&sum}, {}, Blend::add);
    EXPECT_EQ(sum.read_floats()[0], 3) << "it blends as ever";
}

TEST_P(DrawOn, ReadsAUniformBlockInStd140) {
    struct Block {
        float scale;
        std::int32_t count;
        float padding[2];
        float offset[3];
        std::uint32_t flag;
        float rows[2][4];
    };
    static_assert(sizeof(Block) == 64);
    const Block block = {2.0F, -3, {}, {0.25F, 0.5F, 0.75F}, 7U, {{1, 2, 3, 4}, {5, 6, 7, 8}}};
    Buffer buffer(context(), sizeof block, "param");
    buffer.write(std::as_bytes(std::span(&block, 1)));
    const Program program = fragment(R"(layout(std140, binding = 2) uniform Param {
    float scale; int count; vec3 offset; uint flag; vec4 rows[2];
};
layout(location = 0) out vec4 c;
void main() { c = vec4(scale * float(count), offset.z, float(flag), rows[1].w); })");
    const BufferBinding uniforms[] = {{&buffer, 2}};
    EXPECT_EQ(drawn(program, 1, 1, {.uniforms = uniforms}), (std::vector<float>{-6.0F, 0.75F, 7.0F, 8.0F}));
}

TEST_P(DrawOn, WritesImagesAndBuffersFromAFragment) {
    Texture image = texture(2, 1, TextureFormat::r32ui);
    image.clear_to({0, 0, 0, 0});
    Buffer counter(context(), 4, "counter");
    const Program program = fragment(R"(layout(r32ui, binding = 1) uniform uimage2D image;
layout(std430, binding = 0) buffer Counter { uint total; };
layout(location = 0) out vec4 c;
void main() {
    imageAtomicAdd(image, ivec2(1, 0), 1u);
    atomicAdd(total, 2u);
    c = vec4(0);
})");
    const ImageBinding images[] = {{.texture = &image, .binding = 1}};
    const BufferBinding storage[] = {{&counter, 0}};
    drawn(program, 4, 4, {.images = images, .storage = storage});
    EXPECT_EQ(image.read_uints(), (std::vector<std::uint32_t>{0U, 16U}));
    std::uint32_t total = 0;
    std::memcpy(&total, counter.read().data(), sizeof total);
    EXPECT_EQ(total, 32U);
}

TEST_P(DrawOn, RefusesTargetsThatDoNotBelongTogetherAndNamesTheProgram) {
    const Program program = fragment(kOne, "bokeh.coc");
    const Texture small = texture(1, 1);
    const Texture large = texture(2, 2);
    const std::string sizes = error_of([&] { draw_to(program, {&small, &large}); });
    EXPECT_EQ(sizes.find("bokeh.coc: targets differ in size"), 0U) << sizes;
    const std::string many = error_of([&] { draw_to(program, std::vector<const Texture*>(99, &small)); });
    EXPECT_NE(many.find("GL_MAX_COLOR_ATTACHMENTS"), std::string::npos) << many;
    EXPECT_NE(error_of([&] { draw_to(program, {}); }), "");
}

TEST_P(DrawOn, RefusesToReadWhatItDrawsToAndToFilterIntegers) {
    const Program program = fragment(kOne, "tiles");
    const Texture target = texture(1, 1);
    const SampledTexture same[] = {{.texture = &target}};
    EXPECT_NE(error_of([&] { draw_to(program, {&target}, {.textures = same}); }), "");
    const Texture ids = texture(1, 1, TextureFormat::r32ui);
    const SampledTexture linear[] = {{.texture = &ids, .filter = Filter::linear}};
    const std::string message = error_of([&] { draw_to(program, {&target}, {.textures = linear}); });
    EXPECT_EQ(message.find("tiles: texture 'test' holds integers"), 0U) << message;
}

TEST_P(DrawOn, TurnsAGlErrorIntoAnErrorThatNamesTheProgramAndDrawsOn) {
    const Program program = fragment(kOne, "look.step");
    const Texture target = texture(1, 1);
    const Texture image = texture(1, 1);
    const ImageBinding images[] = {{.texture = &image, .binding = 100000}};
    const std::string message = error_of([&] { draw_to(program, {&target}, {.images = images}); });
    EXPECT_EQ(message.find("look.step: "), 0U) << message;
    EXPECT_NE(message.find("GL_INVALID_VALUE"), std::string::npos) << message;
    EXPECT_EQ(drawn(program, 1, 1), std::vector<float>(4, 1.0F));
}

TEST_P(DrawOn, RefusesAProgramOfTheOtherKind) {
    const Program compute = Program::compute(
        context(), "#version 450 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n", "computes");
    const Texture target = texture(1, 1);
    EXPECT_EQ(error_of([&] { draw_to(compute, {&target}); }), "computes: a compute program cannot draw");
    const Program draws = fragment(kOne, "draws");
    EXPECT_EQ(error_of([&] { dispatch(context(), draws, 1, 1, 1, {}); }).find("draws: "), 0U);
}

TEST_P(DrawOn, IsDoneBeforeItsTargetIsReadThoughAnotherWasDrawnToSince) {
    const Program sum = fragment(R"(layout(binding = 0) uniform sampler2D previous;
layout(binding = 1) uniform sampler2D input_image;
layout(location = 0) out float c;
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    c = texelFetch(previous, p, 0).r + texelFetch(input_image, p, 0).r;
})");
    const Program copy = fragment(R"(layout(binding = 0) uniform sampler2D previous;
layout(location = 0) out float c;
void main() { c = texelFetch(previous, ivec2(gl_FragCoord.xy), 0).r; })");
    for (int repeat = 0; repeat < 50; ++repeat) {
        Texture a = texture(5, 3, TextureFormat::r32f), b = texture(5, 3, TextureFormat::r32f);
        Texture input = texture(5, 3, TextureFormat::r32f);
        const Texture other = texture(5, 3, TextureFormat::r32f);
        a.clear(0.0F);
        for (int frame = 1; frame <= 3; ++frame) {
            input.upload(std::vector<float>(15, 1.0F));
            const SampledTexture textures[] = {{.texture = &a}, {.texture = &input, .binding = 1}};
            draw_to(sum, {&b}, {.textures = textures});
            draw_to(copy, {&other}, {.textures = std::span(textures).first(1)});
            ASSERT_EQ(b.read_floats(), std::vector<float>(15, static_cast<float>(frame))) << repeat;
            std::swap(a, b);
        }
    }
}

TEST_P(DrawOn, DropsTheFramebufferOfATextureThatDied) {
    const Program program = fragment(kOne);
    for (int i = 1; i < 20; ++i)
        EXPECT_EQ(drawn(program, i, 1), std::vector<float>(4U * static_cast<unsigned>(i), 1.0F));
}

class DispatchOn : public SoftwareTest {};
ON_EACH_BACKEND(DispatchOn);

TEST_P(DispatchOn, StoresToAnImageThatTheNextDrawReads) {
    const Texture image = texture(4, 4, TextureFormat::r32f);
    const Program program = Program::compute(context(), R"(#version 450 core
layout(local_size_x = 2, local_size_y = 2) in;
layout(r32f, binding = 0) uniform writeonly image2D image;
void main() {
    uvec2 p = gl_GlobalInvocationID.xy;
    imageStore(image, ivec2(p), vec4(p.x + 10 * p.y));
}
)",
                                             "store");
    const ImageBinding images[] = {{.texture = &image, .access = Access::write}};
    dispatch(context(), program, 2, 2, 1, {.images = images});
    const Program reader = fragment(R"(layout(binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 c;
void main() { c = texelFetch(image, ivec2(gl_FragCoord.xy), 0); })");
    const SampledTexture textures[] = {{.texture = &image}};
    const std::vector<float> got = drawn(reader, 4, 4, {.textures = textures});
    EXPECT_EQ(got[0], 0.0F);
    EXPECT_EQ(got[4U * 3], 3.0F);
    EXPECT_EQ(got[4U * 15], 33.0F);
    EXPECT_EQ(image.read_floats()[6], 12.0F);
}

TEST_P(DispatchOn, SumsInAStorageBuffer) {
    const std::array<std::uint32_t, 4> values = {1, 20, 300, 4000};
    Buffer input(context(), sizeof values, "input");
    input.write(std::as_bytes(std::span(values)));
    const Buffer output(context(), 4, "output");
    const Program program = Program::compute(context(), R"(#version 450 core
layout(local_size_x = 4) in;
layout(std430, binding = 0) readonly buffer Input { uint values[]; };
layout(std430, binding = 1) buffer Output { uint sum; };
void main() { atomicAdd(sum, values[gl_GlobalInvocationID.x]); }
)",
                                             "sum");
    const BufferBinding storage[] = {{&input, 0}, {&output, 1}};
    dispatch(context(), program, 1, 1, 1, {.storage = storage});
    std::uint32_t sum = 0;
    std::memcpy(&sum, output.read().data(), sizeof sum);
    EXPECT_EQ(sum, 4321U);
}

TEST_P(DispatchOn, TurnsTooManyGroupsIntoAnErrorThatNamesTheProgram) {
    const Program program = Program::compute(
        context(), "#version 450 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n", "dof.tiles");
    const std::string message = error_of([&] { dispatch(context(), program, 70000, 1, 1, {}); });
    EXPECT_EQ(message.find("dof.tiles: "), 0U) << message;
    EXPECT_NE(message.find("GL_INVALID_VALUE"), std::string::npos) << message;
    EXPECT_NO_THROW(dispatch(context(), program, 1, 1, 1, {}));
}

/// The picture of a shader whose functions are the ones that differ between implementations.
std::vector<float> transcendental_picture(Backend backend) {
    Context context(backend);
    Texture source(context, {.width = 8, .height = 8, .format = TextureFormat::rgba8}, "source");
    std::vector<float> values(256);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>((i * 37) % 256) / 255.0F;
    source.upload(values);
    const Program program = Program::draw(context, kFullScreen, R"(#version 450 core
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 c;
void main() {
    vec2 p = gl_FragCoord.xy / 64.0;
    vec4 s = textureLod(source, p * 1.3 - 0.1, 0.0);
    c = vec4(exp(p.x * 5.0 - p.y), sin(40.0 * p.x + s.r), pow(p.y, 2.2) + s.g, s.b + atan(p.y, p.x));
})",
                                          "transcendental");
    const Texture target(context, {.width = 64, .height = 64}, "target");
    const Target targets[] = {{.texture = &target}};
    const SampledTexture textures[] = {{&source, 0, Filter::linear, Wrap::clamp}};
    draw(context, program, targets, {.textures = textures});
    return target.read_floats();
}

TEST(Draw, GivesTheSameBitsOnOsmesaAndOnEachBackendEgl) {
    for (Backend backend : {Backend::egl_software, Backend::osmesa}) {
        if (const std::string reason = why_not(backend); !reason.empty()) GTEST_SKIP() << reason;
    }
    const std::vector<float> egl = transcendental_picture(Backend::egl_software);
    const std::vector<float> osmesa = transcendental_picture(Backend::osmesa);
    ASSERT_EQ(egl.size(), osmesa.size());
    EXPECT_EQ(std::memcmp(egl.data(), osmesa.data(), egl.size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace aftershade::gpu
