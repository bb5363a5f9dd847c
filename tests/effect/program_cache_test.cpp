// Programs of passes on software GL, and those that stay on disk.
#include "framework/effect/manifest/manifest_reader.h"
#include "framework/effect/pass_program.h"

#include <cstdio>

#include "framework/effect/usage_check.h"
#include "tests/effect/assembly.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade {
namespace {

using test::Assembly;
using test::demo_manifest;
using test::EffectFolder;

const std::filesystem::path kSource = AFTERSHADE_SOURCE_DIR;

ParamSet defaults_of(const EffectManifest& manifest) {
    ParamSet params;
    for (const ParamSpec& spec : manifest.params) params.set(spec.name, spec.default_value);
    return params;
}

std::vector<std::string> inputs_of(const EffectManifest& manifest) {
    std::vector<std::string> names;
    for (const InputSpec& input : manifest.inputs) names.push_back(input.name);
    return names;
}

class ProgramCacheOn : public gpu::SoftwareTest {
protected:
    /// Compiles every pass of an effect; the first fault as a failure of the test.
    void compile_all(const EffectManifest& manifest, ProgramCache& cache) {
        const ParamSet params = defaults_of(manifest);
        for (const PassSpec& pass : manifest.passes) {
            if (!pass.runs_shader()) continue;
            const ShaderContext shader{&manifest, &pass, params, inputs_of(manifest), kSource / "glsl"};
            EXPECT_NO_THROW({
                try {
                    cache.get(shader);
                } catch (const Error& error) {
                    ADD_FAILURE() << error.what();
                    throw;
                }
            });
        }
    }
    /// Mesa gives binaries only where its own shader cache is on.
    bool gives_binaries() {
        return fragment("layout(location = 0) out vec4 c; void main() { c = vec4(1); }").binary().has_value();
    }
    ProgramCache cache(const std::filesystem::path& folder) {
        return ProgramCache(context(), kSource / "glsl", ProgramStore(folder));
    }
    EffectManifest toy(const std::string& name) {
        Diagnostics faults;
        const auto folder = kSource / "tests/effect/toys" / name;
        const auto node = read_document(folder / "effect.json", faults);
        const auto manifest = node ? parse_manifest(*node, folder, faults) : std::nullopt;
        if (manifest) check_declared_used(*manifest, kSource / "glsl", faults);
        EXPECT_EQ(test::lines_of(faults), test::Lines{});
        return manifest.value_or(EffectManifest{});
    }
};
ON_EACH_BACKEND(ProgramCacheOn);

TEST_P(ProgramCacheOn, CompilesComputeInstancesAndAtomics) {
    ProgramCache programs(context(), kSource / "glsl", ProgramStore());
    compile_all(toy("tile_classify"), programs);
    EXPECT_EQ(programs.compiled_count(), 3);  // a clear has none
    compile_all(toy("forward_splat"), programs);
    EXPECT_EQ(programs.compiled_count(), 6);
    const EffectManifest manifest = toy("tile_classify");
    const ParamSet params = defaults_of(manifest);
    const auto compiled = [&](std::size_t pass) {
        return programs.get({&manifest, &manifest.passes[pass], params, {}, kSource / "glsl"});
    };
    EXPECT_TRUE(compiled(0)->is_compute());
    EXPECT_FALSE(compiled(2)->is_compute());
    EXPECT_NE(compiled(2), compiled(3)) << "one fragment shader, but another vertex shader";
    EXPECT_EQ(programs.compiled_count(), 6);
}

TEST_P(ProgramCacheOn, MakesOneFormOfShadersWithLoops) {
    const auto has_one_form = [&](const std::string& body) {
        ProgramCache programs(context(), kSource / "glsl", ProgramStore());
        ProgramSources sources;
        sources.vertex = gpu::kFullScreen;
        sources.main.text = "#version 450 core\nlayout(location = 0) out vec4 c;\n" + body + "\n";
        sources.main.lines.assign(3, SourceLine{"a.frag", 1});
        return programs.get(sources)->has_one_form();
    };
    EXPECT_TRUE(has_one_form("void main() { c = vec4(0); for (int i = 0; i < 9; ++i) c.x += c.y; }"));
    EXPECT_TRUE(has_one_form("void main() { c = vec4(0); do c.x += 1.0; while (c.x < 9.0); }"));
    EXPECT_FALSE(has_one_form("void main() { c = vec4(0); }  // while for"));
    EXPECT_FALSE(has_one_form("void main() { float form = 0.0; c = vec4(form); }"));
}

TEST_P(ProgramCacheOn, KeepsAsManyIdleProgramsAsItMay) {
    ProgramCache programs(context(), kSource / "glsl", ProgramStore());
    const std::size_t before = context().objects().programs;
    const auto of_host = [&](const std::string& symbol) {
        return programs.get(programs.host_sources("mix.frag", {symbol}));
    };
    const auto held = of_host("HELD");
    for (std::size_t i = 0; i < ProgramCache::kMostIdlePrograms + 20; ++i)
        of_host("SYMBOL_" + std::to_string(i));
    // The newest was in use while the others were counted; all share one vertex shader.
    EXPECT_EQ(context().objects().programs - before, ProgramCache::kMostIdlePrograms + 3);
    EXPECT_EQ(of_host("HELD"), held) << "it is not idle";
    const int compiled = programs.compiled_count();
    of_host("SYMBOL_" + std::to_string(ProgramCache::kMostIdlePrograms + 19));
    EXPECT_EQ(programs.compiled_count(), compiled) << "it was used last";
    of_host("SYMBOL_0");
    EXPECT_EQ(programs.compiled_count(), compiled + 1);
}

TEST_P(ProgramCacheOn, CompilesEveryKindOfBinding) {
    const EffectFolder folder(demo_manifest(
        {{test::kInputs,
          R"("inputs": {"color": {"role": "color", "history": true}, "depth": {"role": "depth", "optional": true}})"},
         {test::kTextures, R"("textures": {"small": {"format": "rgba16f", "doc": "."},
            "accum": {"format": "rg32f", "history": true, "doc": "."},
            "counts": {"format": "r32ui", "clear": 7, "doc": "."},
            "signed_counts": {"format": "r32i", "clear": -7, "doc": "."},
            "normals_stack": {"format": "rgba8", "layers": 4, "clear": [0, 0, 1, 0], "doc": "."},
            "stack": {"format": "rgba16f", "layers": 3, "doc": "."}})"},
         {test::kPasses, R"("passes": [
            {"name": "wipe", "kind": "clear", "writes": ["signed_counts", "normals_stack"], "value": 1},
            {"name": "stats", "kind": "compute", "shader": "c.comp", "reads": ["color", "normals_stack"],
             "images": {"counts": "atomic", "stack": "write", "signed_counts": "read"},
             "dispatch": {"groups": [1, 2, 3]},
             "buffers": {"list": "write", "list.prev": "read", "sums": "atomic"}},
            {"name": "one", "shader": "a.frag", "repeat": 3,
             "reads": ["color", "color.prev", "accum.prev", "depth", "counts", "stack"],
             "writes": ["accum", "small"], "buffers": {"list": "read"}},
            {"name": "ground", "kind": "copy", "from": "color", "to": "color"},
            {"name": "two", "shader": "b.frag", "vertex": "d.vert",
             "instances": {"of": "points", "per": "pixel"}, "reads": ["small"], "writes": ["color"]}])"},
         {test::kMore, R"("buffers": {
            "list": {"element": "uvec4", "per": "pixel", "count": 2, "history": true, "doc": "."},
            "sums": {"element": "int", "count": "taps", "clear": 0, "doc": "."}},
            "native": {"uniforms": {"warp": {"type": "vec3", "doc": "."}, "turns": {"type": "uint", "doc": "."}},
             "tables": {"kernel": {"element": "vec2", "count": 64, "doc": "."},
                        "seeds": {"element": "uint", "count": [8, 8], "doc": "."}}})"},
         {test::kParams, R"("params": {
            "gain": {"type": "float", "unit": "m", "default": 1, "min": 0, "max": 9, "doc": "."},
            "mode": {"type": "enum", "values": ["fast", "good"], "default": "fast", "bind": "define", "doc": "."},
            "taps": {"type": "int", "default": 3, "min": 1, "max": 8, "doc": "."}})"}}));
    folder.write("c.comp", R"(#version 450 core
#include <pass>
layout(local_size_x = 4) in;
void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    uint old = imageAtomicAdd(counts, p, 1u);
    imageStore(stack, ivec3(p, 2), texelFetch(color, p, 0) * color_size.z +
               texelFetch(normals_stack, ivec3(p, 1), 0) * normals_stack_size.w);
    list[p.x] = list_prev[p.x] + uvec4(imageLoad(signed_counts, p).r);
    atomicAdd(sums[0], int(old) + param.taps);
}
)");
    folder.write("a.frag", R"(#version 450 core
#include <pass>
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_accum = texelFetch(accum_prev, p, 0).rg + accum_prev_size.xy * float(pass.index) / float(pass.count);
    out_small = texelFetch(color, p, 0) + texelFetch(color_prev, p, 0) * color_prev_size.x +
                texture(stack, vec3(0.5, 0.5, 1.0)) + vec4(list[0]) * float(texelFetch(counts, p, 0).r);
#ifdef HAS_DEPTH
    out_small.a = texelFetch(depth, p, 0).r * native.warp.y * float(native.turns);
#endif
    out_small.rg += texelFetch(kernel, ivec2(3, 0), 0).rg * float(texelFetch(seeds, ivec2(1, 2), 0).r);
    if (frame.history_valid && camera.has_prev_matrices)
        out_small += camera.prev_clip_from_world * vec4(camera.position_m, frame.subframe_time) * frame.scale;
    out_small.xy += camera.jitter_px - camera.prev_jitter_px + vec2(frame.size - frame.full_display_size) * frame.fps;
    out_small.z += camera.focal_length + camera.f_number + float(frame.subframe + frame.subframe_count);
}
)");
    folder.write("d.vert", R"(#version 450 core
#include <pass>
layout(location = 0) out float shade;
void main() {
    shade = texelFetch(small, ivec2(gl_InstanceID, 0), 0).r * param.gain;
    gl_Position = camera.clip_from_world * vec4(shade);
}
)");
    folder.write("b.frag", R"(#version 450 core
#include <pass>
layout(location = 0) in float shade;
void main() { out_color = vec4(shade) * small_size.x + float(MODE); }
)");
    const EffectManifest manifest = folder.sound_manifest();
    Diagnostics unused;
    check_declared_used(manifest, kSource / "glsl", unused);
    EXPECT_EQ(test::lines_of(unused), test::Lines{});
    ProgramCache programs(context(), kSource / "glsl", ProgramStore());
    compile_all(manifest, programs);
    EXPECT_EQ(programs.compiled_count(), 3);
}

TEST_P(ProgramCacheOn, NamesTheAuthorsLineInEitherShader) {
    const EffectFolder folder(demo_manifest({{test::kPasses, R"("passes": [
        {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"]},
        {"name": "ground", "kind": "copy", "from": "color", "to": "color"},
        {"name": "two", "shader": "b.frag", "vertex": "d.vert", "instances": {"of": "quads", "count": 5},
         "reads": ["small"], "writes": ["color"]}])"}}));
    const EffectManifest manifest = folder.sound_manifest();
    const ParamSet params = defaults_of(manifest);
    ProgramCache programs(context(), kSource / "glsl", ProgramStore());
    const auto fault = [&] {
        return gpu::error_of([&] {
            programs.get({&manifest, &manifest.passes[2], params, {}, kSource / "glsl"});
        });
    };
    folder.write("d.vert", "#version 450 core\n#include <pass>\n\nvoid main() { gl_Position = parm; }\n");
    EXPECT_TRUE(fault().starts_with((folder.path() / "d.vert").string() + ":4:")) << fault();
    EXPECT_NE(fault().find("[pass two, "), std::string::npos) << fault();
    folder.write("d.vert", "#version 450 core\n#include <pass>\nvoid main() { gl_Position = vec4(1); }\n");
    folder.write("b.frag", "#version 450 core\n#include <pass>\n\n\nvoid main() { out_color = parm; }\n");
    EXPECT_TRUE(fault().starts_with((folder.path() / "b.frag").string() + ":5:")) << fault();
}

const char* const kNoBinaries = "the driver gives no program binaries (MESA_SHADER_CACHE_DISABLE?)";

TEST_P(ProgramCacheOn, CompilesWithAStoreEvenWhereTheDriverGivesNoBinaries) {
    const test::TemporaryFolder store;
    ProgramCache programs = cache(store.path());
    compile_all(toy("forward_splat"), programs);
    EXPECT_EQ(programs.compiled_count(), 3);
    EXPECT_EQ(store.file_count(), gives_binaries() ? 4U : 0U) << "with the vertex shader that draws share";
}

TEST_P(ProgramCacheOn, TakesProgramsFromTheRunBefore) {
    if (!gives_binaries()) GTEST_SKIP() << kNoBinaries;
    const test::TemporaryFolder store;
    const EffectManifest manifest = toy("forward_splat");
    ProgramCache first = cache(store.path()), second = cache(store.path());
    compile_all(manifest, first);
    EXPECT_EQ(first.compiled_count(), 3);
    EXPECT_EQ(first.loaded_count(), 0);
    EXPECT_EQ(store.file_count(), 4U);
    compile_all(manifest, second);
    EXPECT_EQ(second.compiled_count(), 0);
    EXPECT_EQ(second.loaded_count(), 3);
    EXPECT_EQ(store.file_count(), 4U);
}

TEST_P(ProgramCacheOn, DrawsTheSameWithAProgramFromDisk) {
    if (!gives_binaries()) GTEST_SKIP() << kNoBinaries;
    const std::string source =
        "#version 450 core\nlayout(location = 0) out vec4 c;\n"
        "void main() { c = vec4(gl_FragCoord.xy, 3.0 * gl_FragCoord.x, 7.0); }\n";
    const gpu::Program compiled = gpu::Program::draw(context(), gpu::kFullScreen, source, "compiled");
    const auto binary = compiled.binary();
    ASSERT_TRUE(binary.has_value());
    const test::TemporaryFolder folder;
    const ProgramStore store(folder.path());
    store.save("key", *binary);
    const auto stored = store.load("key");
    ASSERT_TRUE(stored.has_value());
    const auto loaded = gpu::Program::from_binary(context(), *stored, gpu::Stages::draw, "loaded");
    ASSERT_TRUE(loaded.has_value());
    EXPECT_EQ(loaded->label(), "loaded");
    EXPECT_EQ(drawn(*loaded, 2, 1), (std::vector<float>{0.5F, 0.5F, 1.5F, 7.0F, 1.5F, 0.5F, 4.5F, 7.0F}));
}

TEST_P(ProgramCacheOn, CompilesWhereTheDriverRefusesABinary) {
    if (!gives_binaries()) GTEST_SKIP() << kNoBinaries;
    EXPECT_FALSE(
        gpu::Program::from_binary(context(), {0x1234, {std::byte{1}}}, gpu::Stages::draw, "p").has_value());
    const gpu::Program good = fragment("layout(location = 0) out vec4 c; void main() { c = vec4(1); }");
    auto binary = *good.binary();
    // Mesa writes the driver's identity in front, and refuses that of another.
    for (std::size_t i = 0; i < std::min<std::size_t>(binary.bytes.size(), 24); ++i)
        binary.bytes[i] ^= std::byte{0xff};
    EXPECT_FALSE(gpu::Program::from_binary(context(), binary, gpu::Stages::draw, "p").has_value());
    EXPECT_NO_THROW(context().check("the next pass"));

    const test::TemporaryFolder store;
    const EffectManifest manifest = toy("forward_splat");
    ProgramCache first = cache(store.path()), second = cache(store.path());
    compile_all(manifest, first);
    for (const auto& entry : std::filesystem::directory_iterator(store.path())) {
        std::string bytes = test::read_text(entry.path());
        bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 1);
        test::write_text(entry.path(), bytes);
    }
    compile_all(manifest, second);
    EXPECT_EQ(second.compiled_count(), 3) << "one bit changed is not to be trusted";
    ProgramCache third = cache(store.path());
    compile_all(manifest, third);
    EXPECT_EQ(third.loaded_count(), 3) << "and was replaced";
}

TEST_P(ProgramCacheOn, KeepsTheProgramsOfRenderersApart) {
    if (!gives_binaries()) GTEST_SKIP() << kNoBinaries;
    const test::TemporaryFolder store;
    const EffectManifest manifest = toy("forward_splat");
    ProgramCache first = cache(store.path());
    compile_all(manifest, first);
    // As if another driver version had written the files: the key in the head differs in that alone.
    for (const auto& entry : std::filesystem::directory_iterator(store.path())) {
        std::string bytes = test::read_text(entry.path());
        const std::string& version = context().info().version;
        const std::size_t at = bytes.find("\n" + version + "\n");
        ASSERT_NE(at, std::string::npos);
        bytes[at + version.size()] = '~';
        test::write_text(entry.path(), bytes);
    }
    ProgramCache second = cache(store.path());
    compile_all(manifest, second);
    EXPECT_EQ(second.loaded_count(), 0);
    EXPECT_EQ(second.compiled_count(), 3);
}

// What the next test runs in processes of its own: a fork of this one would have the driver's locks, but not
// its threads.
TEST_P(ProgramCacheOn, DISABLED_CompilesIntoTheFolderOfTheEnvironment) {
    ProgramCache programs(context(), kSource / "glsl");
    compile_all(toy("forward_splat"), programs);
    EXPECT_EQ(programs.compiled_count() + programs.loaded_count(), 3);
}

TEST_P(ProgramCacheOn, SharesItsFolderBetweenProcesses) {
    if (!gives_binaries()) GTEST_SKIP() << kNoBinaries;
    const test::TemporaryFolder store;
    const std::string command =
        "AFTERSHADE_CACHE='" + store.path().string() + "' timeout 60 '" +
        std::filesystem::read_symlink("/proc/self/exe").string() +
        "' --gtest_also_run_disabled_tests --gtest_filter='*DISABLED_CompilesIntoTheFolder*/" +
        gpu::parameter_name({GetParam(), 0}) + "'";
    std::vector<FILE*> children;
    for (int i = 0; i < 2; ++i) children.push_back(popen(command.c_str(), "r"));
    for (FILE* child : children) {
        ASSERT_NE(child, nullptr);
        std::string output;
        for (int c = 0; (c = std::fgetc(child)) != EOF;) output += char(c);
        EXPECT_EQ(pclose(child), 0) << output;
        EXPECT_NE(output.find("[  PASSED  ] 1 test."), std::string::npos) << output;
    }
    EXPECT_EQ(store.file_count(), 4U) << "and no temporary file";
    ProgramCache programs = cache(store.path());
    compile_all(toy("forward_splat"), programs);
    EXPECT_EQ(programs.loaded_count(), 3);
}

}  // namespace
}  // namespace aftershade
