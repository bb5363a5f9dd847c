// The text of each kind of binding, and the blocks' bytes.

#include "tests/effect/assembly.h"
#include "tests/effect/block_bytes.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade {
namespace {

using test::Assembly;
using test::demo_manifest;
using test::EffectFolder;
using test::has_line;
using test::Lines;
using test::lines_of_text;
using test::value_at;

/// One compute pass, one repeated draw and one draw of instances, with everything that can be bound.
const test::Sections kEverything = {
    {test::kInputs,
     R"("inputs": {"color": {"role": "color", "history": true}, "depth": {"role": "depth", "optional": true}})"},
    {test::kTextures, R"("textures": {"small": {"format": "rgba16f", "doc": "."},
        "accum": {"format": "rg32f", "history": true, "doc": "."}, "counts": {"format": "r32ui", "clear": 7, "doc": "."},
        "offsets": {"format": "r32i", "clear": 0, "doc": "."}, "stack": {"format": "rgba8", "layers": 3, "clear": 0, "doc": "."}})"},
    {test::kMore,
     R"("buffers": {"tile_list": {"element": "uvec4", "per": "pixel", "history": true, "doc": "."},
        "sums": {"element": "int", "count": 4, "clear": 0, "doc": "."}},
        "native": {"uniforms": {"turns": {"type": "uint", "doc": "."}, "warp": {"type": "vec3", "doc": "."},
            "shift": {"type": "int", "doc": "."}, "span": {"type": "vec2", "doc": "."}},
          "tables": {"kernel": {"element": "vec2", "count": 64, "doc": "."}, "seeds": {"element": "uint", "count": [8, 8], "doc": "."}}})"},
    {test::kPasses, R"("passes": [
        {"name": "stats", "kind": "compute", "shader": "c.comp", "reads": ["color.prev", "stack"], "dispatch": {"tile": 8},
         "images": {"counts": "atomic", "offsets": "read", "small": "write"},
         "buffers": {"tile_list": "write", "tile_list.prev": "read", "sums": "atomic"}},
        {"name": "one", "shader": "a.frag", "repeat": 3, "reads": ["depth", "color", "accum.prev", "counts", "offsets"],
         "writes": ["accum", "counts"]},
        {"name": "ground", "kind": "copy", "from": "color", "to": "color"},
        {"name": "two", "shader": "b.frag", "vertex": "d.vert", "instances": {"of": "points", "per": "pixel"},
         "buffers": {"tile_list": "read"}, "reads": ["small"], "writes": ["color"]},
        {"name": "wipe", "kind": "clear", "writes": ["offsets", "stack"], "value": 0}])"}};

Lines declarations(const std::string& text, const std::string& beginning) {
    Lines found;
    for (const std::string& line : lines_of_text(text))
        if (line.starts_with(beginning)) found.push_back(line);
    return found;
}

TEST(ShaderBindings, DeclareTheSamplersOfReadsAndTables) {
    const EffectFolder folder(demo_manifest(kEverything));
    Assembly assembly(folder);
    assembly.present = {"depth"};
    EXPECT_EQ(declarations(assembly.sound().text, "layout(binding = "),
              (Lines{"layout(binding = 0) uniform sampler2D color_prev;",
                     "layout(binding = 1) uniform sampler2DArray stack;",
                     "layout(binding = 2) uniform sampler2D kernel;",
                     "layout(binding = 3) uniform usampler2D seeds;",
                     "layout(binding = 0, r32ui) uniform uimage2D counts;",
                     "layout(binding = 1, r32i) readonly uniform iimage2D offsets;",
                     "layout(binding = 2, rgba16f) writeonly uniform image2D small;"}));
    const Assembly repeated(folder, 1);  // without depth
    EXPECT_EQ(declarations(repeated.sound().text, "layout(binding = "),
              (Lines{"layout(binding = 0) uniform sampler2D color;",
                     "layout(binding = 1) uniform sampler2D accum_prev;",
                     "layout(binding = 2) uniform usampler2D counts;",
                     "layout(binding = 3) uniform isampler2D offsets;",
                     "layout(binding = 4) uniform sampler2D kernel;",
                     "layout(binding = 5) uniform usampler2D seeds;"}));
    EXPECT_EQ(declarations(repeated.sound().text, "    vec4 "),
              (Lines{"    vec4 color_size;", "    vec4 accum_prev_size;", "    vec4 counts_size;",
                     "    vec4 offsets_size;"}));
    EXPECT_EQ(
        declarations(repeated.sound().text, "layout(location"),
        (Lines{"layout(location = 0) out vec2 out_accum;", "layout(location = 1) out uint out_counts;"}));
}

TEST(ShaderBindings, DeclareStorageBlocks) {
    const EffectFolder folder(demo_manifest(kEverything));
    EXPECT_EQ(
        declarations(Assembly(folder, 0).sound().text, "layout(std430"),
        (Lines{"layout(std430, binding = 0) writeonly buffer TileListBuffer { uvec4 tile_list[]; };",
               "layout(std430, binding = 1) readonly buffer TileListPrevBuffer { uvec4 tile_list_prev[]; };",
               "layout(std430, binding = 2) buffer SumsBuffer { int sums[]; };"}));
}

TEST(ShaderBindings, GiveAVertexShaderAllButOutputs) {
    const EffectFolder folder(demo_manifest(kEverything));
    const Assembly assembly(folder, 3);
    const ShaderContext shader{
        &assembly.manifest, &assembly.manifest.passes[3], assembly.params, {}, assembly.glsl.path()};
    const Lines main = lines_of_text(interface_glsl(shader));
    Lines vertex = lines_of_text(interface_glsl(shader, ShaderFile::vertex));
    vertex.push_back("layout(location = 0) out vec4 out_color;");
    EXPECT_EQ(main, vertex);
    Diagnostics faults;
    const ShaderSource source = assemble_shader(shader, faults, ShaderFile::vertex);
    EXPECT_EQ(std::filesystem::path(source.lines.back().file.text()).filename(), "d.vert");
}

TEST(ShaderBindings, HaveThePassBlockOnlyWhereThePassRepeats) {
    const EffectFolder folder(demo_manifest(kEverything));
    EXPECT_TRUE(has_line(Assembly(folder, 1).sound(), "layout(std140, binding = 4) uniform PassBlock {"));
    EXPECT_FALSE(has_line(Assembly(folder, 0).sound(), "layout(std140, binding = 4) uniform PassBlock {"));
    EXPECT_TRUE(has_line(Assembly(folder, 0).sound(), "layout(std140, binding = 5) uniform NativeBlock {"));
    const EffectFolder plain;
    EXPECT_EQ(Assembly(plain).sound().text.find("NativeBlock"), std::string::npos);
}

ParamSpec param_of(const std::string& name, ParamType type) {
    ParamSpec spec;
    spec.name = name;
    spec.type = type;
    return spec;
}

TEST(ShaderBindings, NumberParametersAndTablesAfterThePassesOwn) {
    const EffectFolder folder(demo_manifest(kEverything));
    Assembly assembly(folder);
    for (const auto& [name, type] :
         {std::pair("falloff", ParamType::curve), std::pair("objects", ParamType::table),
          std::pair("lens", ParamType::file)})
        assembly.manifest.params.push_back(param_of(name, type));
    const std::map<std::string, ParamFile> files = {{"lens", Image(4, 2, 4)}};
    ShaderContext shader{
        &assembly.manifest, &assembly.manifest.passes[0], assembly.params, {}, assembly.glsl.path(), &files};
    const PassBindings bindings = pass_bindings(shader);
    EXPECT_EQ(bindings.reads.size(), 2U);
    EXPECT_EQ(bindings.first_param_sampler, 2);
    ASSERT_EQ(bindings.param_samplers.size(), 2U);
    EXPECT_EQ(bindings.param_samplers[0]->name, "falloff");
    EXPECT_EQ(bindings.param_samplers[1]->name, "lens");
    EXPECT_EQ(bindings.first_native_sampler, 4);
    ASSERT_EQ(bindings.native_tables.size(), 2U);
    EXPECT_EQ(bindings.native_tables[1]->name, "seeds");
    EXPECT_EQ(bindings.images.size(), 3U);
    EXPECT_EQ(bindings.buffers.size(), 3U);
    EXPECT_EQ(bindings.first_param_buffer, 3);
    ASSERT_EQ(bindings.param_buffers.size(), 1U);
    EXPECT_EQ(bindings.param_buffers[0]->name, "objects");
    EXPECT_TRUE(bindings.has_param_block && bindings.has_native_block && !bindings.has_pass_block);
    const std::string text = interface_glsl(shader);
    EXPECT_NE(text.find("layout(binding = 3) uniform sampler2D lens;"), std::string::npos) << text;
    EXPECT_NE(text.find("layout(binding = 5) uniform usampler2D seeds;"), std::string::npos) << text;
    EXPECT_NE(text.find("layout(std430, binding = 3) readonly buffer"), std::string::npos) << text;
    EXPECT_EQ(text.find("sampler2D objects"), std::string::npos);

    shader.files = nullptr;
    EXPECT_EQ(pass_bindings(shader).param_samplers.size(), 1U) << "no file, no sampler";
    EXPECT_EQ(pass_bindings(shader).first_native_sampler, 3);
}

// By hand from OpenGL 4.5, section 7.6.2.2: uint at 0, vec3 at 16, int in its fourth place at 28, vec2 at 32.
TEST(NativeBlock, LiesAsStd140Says) {
    const EffectFolder folder(demo_manifest(kEverything));
    const EffectManifest manifest = folder.sound_manifest();
    EXPECT_TRUE(has_native_block(manifest));
    const auto block =
        native_block(manifest, {{"turns", {4294967295.0}}, {"warp", {1, 2, 3}}, {"shift", {-5}}});
    ASSERT_EQ(block.size(), 48U);
    EXPECT_EQ(value_at<std::uint32_t>(block, 0), 4294967295U);
    EXPECT_EQ(value_at<float>(block, 16), 1.0F);
    EXPECT_EQ(value_at<float>(block, 24), 3.0F);
    EXPECT_EQ(value_at<std::int32_t>(block, 28), -5);
    EXPECT_EQ(value_at<float>(block, 32), 0.0F) << "what has no value is 0";
    EXPECT_TRUE(native_block(EffectFolder().sound_manifest(), {}).empty());
}

class HostBlocksOn : public gpu::SoftwareTest {
protected:
    /// What a shader sees of a block that the host laid out: the vec4 that `expression` makes.
    template <typename Block>
    std::vector<float> seen(const std::string_view glsl, int binding, const Block& block,
                            const std::string& expression) {
        const gpu::Program program =
            fragment(std::string(glsl) + "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(" +
                     expression + "); }\n");
        gpu::Buffer buffer(context(), sizeof block, "block");
        buffer.write(std::as_bytes(std::span(&block, 1)));
        const gpu::BufferBinding uniforms[] = {{&buffer, binding}};
        return drawn(program, 1, 1, {.uniforms = uniforms});
    }
};
ON_EACH_BACKEND(HostBlocksOn);

using Floats = std::vector<float>;

TEST_P(HostBlocksOn, MeanInGlslWhatTheHostPutIn) {
    FrameBlock frame{.display_size_px = {1, 2},
                     .origin_px = {-3, 4},
                     .number = -5,
                     .step_seed = 6,
                     .fps = 24,
                     .history_valid = 1,
                     .size_px = {7, 8},
                     .full_display_size_px = {9, 10},
                     .scale = 0.5F,
                     .subframe = 11,
                     .subframe_count = 12,
                     .subframe_time = -0.25F};
    frame.rec709_from_color[2][1] = 13;  // column 2, row 1
    const auto in_frame = [&](const std::string& expression) {
        return seen(frame_block_glsl(), kFrameBinding, frame, expression);
    };
    EXPECT_EQ(in_frame("frame.display_size, frame.origin"), (Floats{1, 2, -3, 4}));
    EXPECT_EQ(in_frame("frame.number, frame.step_seed, frame.fps, frame.history_valid"),
              (Floats{-5, 6, 24, 1}));
    EXPECT_EQ(in_frame("frame.rec709_from_color[2], frame.rec709_from_color[1][1]"), (Floats{0, 13, 1, 1}));
    EXPECT_EQ(in_frame("frame.size, frame.full_display_size"), (Floats{7, 8, 9, 10}));
    EXPECT_EQ(in_frame("frame.scale, frame.subframe, frame.subframe_count, frame.subframe_time"),
              (Floats{0.5F, 11, 12, -0.25F}));

    CameraBlock camera{.position_m = {1, 2, 3},
                       .jitter_px = {4, 5},
                       .prev_jitter_px = {6, 7},
                       .focal_length_mm = 50,
                       .sensor_width_mm = 36,
                       .focus_distance_m = 2.5F,
                       .f_number = 2.8F,
                       .has_matrices = 0,
                       .has_prev_matrices = 1};
    ColumnMatrix* const matrices[] = {&camera.view_from_world,      &camera.world_from_view,
                                      &camera.clip_from_view,       &camera.view_from_clip,
                                      &camera.clip_from_world,      &camera.world_from_clip,
                                      &camera.prev_clip_from_world, &camera.prev_view_from_world,
                                      &camera.prev_clip_from_view,  &camera.prev_view_from_view};
    for (int i = 0; i < 10; ++i) (*matrices[i])[13] = float(20 + i);  // column 3, row 1: a move along y
    const auto in_camera = [&](const std::string& expression) {
        return seen(camera_block_glsl(), kCameraBinding, camera, expression);
    };
    EXPECT_EQ(in_camera("(camera.view_from_world * vec4(0, 0, 0, 1)).y, camera.world_from_view[3][1], "
                        "camera.clip_from_view[3][1], camera.view_from_clip[3][1]"),
              (Floats{20, 21, 22, 23}));
    EXPECT_EQ(
        in_camera(
            "camera.clip_from_world[3][1], camera.world_from_clip[3][1], camera.prev_clip_from_world[3][1], "
            "camera.prev_view_from_world[3][1]"),
        (Floats{24, 25, 26, 27}));
    EXPECT_EQ(in_camera("camera.position_m, camera.has_matrices"), (Floats{1, 2, 3, 0}));
    EXPECT_EQ(in_camera("camera.jitter_px, camera.prev_jitter_px"), (Floats{4, 5, 6, 7}));
    EXPECT_EQ(in_camera("camera.focal_length, camera.sensor_width, camera.focus_distance, camera.f_number"),
              (Floats{50, 36, 2.5F, 2.8F}));
    LightsBlock lights{.count = 2, .padding = {}, .light = {}};
    lights.light[0] = {.position_m = {1, 2, 3},
                       .kind = 2,
                       .direction = {4, 5, 6},
                       .intensity = {7, 8, 9},
                       .size_m = {10, 11}};
    lights.light[15] = {.kind = 1, .intensity = {0, 0, 12}, .size_m = {0, 13}};
    const auto in_lights = [&](const std::string& expression) {
        return seen(lights_block_glsl(), kLightsBinding, lights, expression);
    };
    EXPECT_EQ(in_lights("lights.light[0].position_m, lights.count"), (Floats{1, 2, 3, 2}));
    EXPECT_EQ(in_lights("lights.light[0].direction, lights.light[0].kind == LIGHT_AREA"),
              (Floats{4, 5, 6, 1}));
    EXPECT_EQ(in_lights("lights.light[0].intensity, lights.light[15].kind == LIGHT_DIRECTIONAL"),
              (Floats{7, 8, 9, 1}));
    EXPECT_EQ(in_lights("lights.light[0].size_m, lights.light[15].size_m.y, lights.light[15].intensity.b"),
              (Floats{10, 11, 13, 12}));
    EXPECT_EQ(in_lights("lights.light[1].kind == LIGHT_POINT, lights.light.length(), 0, 0"),
              (Floats{1, 16, 0, 0}));
    EXPECT_EQ(in_camera("camera.has_prev_matrices, 0, camera.prev_clip_from_view[3][1], "
                        "camera.prev_view_from_view[3][1]"),
              (Floats{1, 0, 28, 29}));
}

}  // namespace
}  // namespace aftershade
