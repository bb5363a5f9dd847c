// Programs that threads compile beside the one that draws: the same pictures, the same faults, a clean end.
#include "framework/render/compile_ahead.h"

#include <chrono>
#include <cstring>
#include <functional>
#include <random>
#include <thread>

#include "tests/gpu/gpu_test.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

const std::filesystem::path kData = AFTERSHADE_SOURCE_DIR;

/// A renderer whose programs lie in an empty folder, or in none.
class Fresh {
public:
    Fresh(const EffectFolder& effects, const std::string& steps, gpu::Backend backend, int threads,
          bool has_store = true)
        : bound_(effects, look_of(steps)),
          context_(backend),
          renderer_(context_, bound_.pipeline(),
                    std::make_shared<ProgramCache>(context_, kData / "glsl",
                                                   has_store ? ProgramStore(folder_.path()) : ProgramStore()),
                    {}, {.compile_threads = threads}) {
        EXPECT_EQ(bound_.faults().find("error"), std::string::npos) << bound_.faults();
    }
    FrameResult run(const Capture& capture) {
        FrameInputs frame;
        frame.capture = &capture;
        return renderer_.render(frame, {"color", "display"}, false);
    }
    PipelineRenderer& renderer() { return renderer_; }

private:
    TemporaryFolder folder_;
    Bound bound_;
    gpu::Context context_;
    PipelineRenderer renderer_;
};

class CompileAheadOn : public gpu::SoftwareTest {
protected:
    static Capture capture() {
        return make_capture({.width = 61,
                             .height = 40,
                             .background_depth_m = 6,
                             .box = SyntheticBox{20, 9, 14, 12, 2, 1, 2}});
    }
    EffectFolder none_;
};
ON_EACH_BACKEND(CompileAheadOn);

const char* const kLongLook =
    R"({ "effect": "bokeh", "params": { "f_number": 0.3 } }, { "effect": "motion_blur" },
    { "effect": "bloom" }, { "effect": "film_grain" }, { "effect": "view_transform" })";

TEST_P(CompileAheadOn, GivesTheBitsOfOneThread) {
    const FrameResult alone = Fresh(none_, kLongLook, GetParam(), 0).run(capture());
    for (const int threads : {1, 3}) {
        Fresh fresh(none_, kLongLook, GetParam(), threads);
        for (int turn = 0; turn < 2; ++turn) {
            const FrameResult result = fresh.run(capture());
            ASSERT_EQ(result.images.size(), alone.images.size());
            for (const auto& [role, image] : alone.images) {
                const auto& values = result.images.at(role).floats();
                EXPECT_EQ(std::memcmp(values.data(), image.floats().data(), image.floats().size_bytes()), 0)
                    << role << ", " << threads << " threads";
            }
        }
        EXPECT_GT(fresh.renderer().programs_compiled_ahead(), 0) << threads << " threads";
    }
}

TEST_P(CompileAheadOn, CompilesNothingThatCouldNotReachTheCaller) {
    Fresh fresh(none_, kLongLook, GetParam(), 2, false);
    fresh.run(capture());
    EXPECT_EQ(fresh.renderer().programs_compiled_ahead(), 0);
}

TEST_P(CompileAheadOn, ReportsTheFaultThatOneThreadMeetsFirst) {
    EffectFolder effects;
    effects.add_color("first", "source * 0.5");
    effects.add_color("second", "source * no_such_name");
    effects.add_color("third", "source + vec3(1)");
    const std::string steps = R"({ "effect": "first" }, { "effect": "second" }, { "effect": "third" })";
    std::vector<std::string> said;
    for (const int threads : {0, 1, 3}) {
        Fresh fresh(effects, steps, GetParam(), threads);
        said.push_back(gpu::error_of([&] { fresh.run(capture()); }));
        // The threads may go on with what is sound; the next frame meets the fault again.
        EXPECT_EQ(gpu::error_of([&] { fresh.run(capture()); }), said.back());
    }
    EXPECT_NE(said[0].find("no_such_name"), std::string::npos) << said[0];
    EXPECT_EQ(said[1], said[0]);
    EXPECT_EQ(said[2], said[0]);
}

/// Passes for CompileAhead itself: a draw each, which writes its number.
std::vector<PassToCompile> passes_to_compile(int count, const std::string& faulty = "") {
    std::vector<PassToCompile> passes;
    for (int i = 0; i < count; ++i) {
        ProgramSources sources;
        sources.vertex = gpu::kFullScreen;
        sources.main.text = "#version 450 core\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(" +
                            std::to_string(i) + ".5); " + (i == count / 2 ? faulty : "") + " }\n";
        PassToCompile pass{"pass " + std::to_string(i), std::make_shared<const ProgramSources>(sources)};
        constexpr auto kFormat = gpu::TextureFormat::rgba32f;
        pass.shape.targets.push_back({{{4, 4, kFormat}, kFormat}});
        passes.push_back(std::move(pass));
    }
    return passes;
}

bool waits_for(const std::function<bool()>& holds) {
    using namespace std::chrono_literals;
    for (int i = 0; i < 6000 && !holds(); ++i) std::this_thread::sleep_for(10ms);
    return holds();
}

TEST_P(CompileAheadOn, CompilesEverythingThatTheCallerLeavesIt) {
    const TemporaryFolder folder;
    ProgramCache programs(context(), kData / "glsl", ProgramStore(folder.path()));
    const std::vector<PassToCompile> passes = passes_to_compile(6);
    CompileAhead ahead(context(), programs, passes, 2);
    EXPECT_TRUE(waits_for([&] { return ahead.passes_drawn() == 6; })) << ahead.passes_drawn();
    EXPECT_EQ(ahead.programs_made(), 6);
    for (const PassToCompile& pass : passes) {
        const CompileAhead::LinkScope linking(&ahead, pass.pass);
        EXPECT_EQ(drawn(*programs.get(*pass.sources), 1, 1)[0], std::stof(pass.pass.substr(5)) + 0.5f);
    }
    if (programs.loaded_count() == 0) GTEST_SKIP() << "SKIPPED: the driver gives no program binaries";
    EXPECT_EQ(programs.compiled_count(), 0);
}

TEST_P(CompileAheadOn, LeavesAFaultToTheCallerAndGoesOn) {
    const TemporaryFolder folder;
    ProgramCache programs(context(), kData / "glsl", ProgramStore(folder.path()));
    const auto passes = passes_to_compile(5, "c = no_such_name;");
    CompileAhead ahead(context(), programs, passes, 1);
    EXPECT_TRUE(waits_for([&] { return ahead.passes_drawn() == 4; })) << ahead.passes_drawn();
    const CompileAhead::LinkScope linking(&ahead, passes[2].pass);
    EXPECT_THROW(programs.get(*passes[2].sources), gpu::ShaderError);
}

/// Passes of which the last one, with which the thread begins, takes long to draw: also where an earlier run
/// of the tests has left its own in Mesa's cache.
std::vector<PassToCompile> passes_with_a_slow_one(int terms) {
    std::vector<PassToCompile> passes = passes_to_compile(4);
    ProgramSources slow = *passes.back().sources;
    std::string sum = " + " + std::to_string(std::random_device()()) + ".0";
    for (int i = 0; i < terms; ++i) sum += " + sin(gl_FragCoord.x * " + std::to_string(i) + ".25)";
    slow.main.text.replace(slow.main.text.rfind('}'), 1, "c.g += 0.0" + sum + "; }");
    passes.back().sources = std::make_shared<const ProgramSources>(slow);
    return passes;
}

TEST_P(CompileAheadOn, LetsTheCallerDrawOtherPassesWhileItWaitsForOne) {
    int passes_drawn_here = 0;
    // Where other processes keep the caller from a core, the thread may be ready first: then with a slower
    // pass.
    for (int terms = 300; terms <= 2400 && passes_drawn_here == 0; terms *= 2) {
        const TemporaryFolder folder;
        ProgramCache programs(context(), kData / "glsl", ProgramStore(folder.path()));
        const std::vector<PassToCompile> passes = passes_with_a_slow_one(terms);
        CompileAhead ahead(context(), programs, passes, 1);
        ASSERT_TRUE(waits_for([&] { return ahead.programs_made() >= 1; }));
        for (int i = 0; i < 3; ++i) {
            const CompileAhead::LinkScope linking(&ahead, passes[std::size_t(i)].pass);
            programs.get(*passes[std::size_t(i)].sources);
        }
        ahead.take(passes.back().pass);
        passes_drawn_here = ahead.passes_drawn_here();
        for (int i = 0; i < 3; ++i) {
            ahead.take(passes[std::size_t(i)].pass);
            EXPECT_EQ(drawn(*programs.get(*passes[std::size_t(i)].sources), 1, 1)[0], float(i) + 0.5f);
        }
    }
    EXPECT_GT(passes_drawn_here, 0);
}

TEST_P(CompileAheadOn, KnowsHowLongTheCallersProgramsAre) {
    const TemporaryFolder folder;
    ProgramCache programs(context(), kData / "glsl", ProgramStore(folder.path()));
    const ProgramSources small = *passes_to_compile(1).front().sources;
    ProgramSources large = small;
    large.main.text.insert(large.main.text.rfind('}'),
                           "for (int i = 0; i < 9; ++i) c.x += sin(c.y * gl_FragCoord.x); ");
    EXPECT_EQ(programs.binary_bytes(small), 0U) << "it was not asked for yet";
    if (!programs.get(small)->binary()) GTEST_SKIP() << "SKIPPED: the driver gives no program binaries";
    programs.get(large);
    EXPECT_GT(programs.binary_bytes(small), 0U);
    EXPECT_GT(programs.binary_bytes(large), programs.binary_bytes(small));
    ProgramCache later(context(), kData / "glsl", ProgramStore(folder.path()));
    later.get(large);
    EXPECT_EQ(later.binary_bytes(large), programs.binary_bytes(large)) << "from the store";
}

TEST_P(CompileAheadOn, EndsWhileItCompiles) {
    const TemporaryFolder folder;
    ProgramCache programs(context(), kData / "glsl", ProgramStore(folder.path()));
    for (int i = 0; i < 20; ++i) {
        const auto passes = passes_to_compile(8);
        CompileAhead ahead(context(), programs, passes, 1 + i % 3);
        for (int taken = 0; taken < i % 8; ++taken) ahead.take(passes[std::size_t(taken)].pass);
    }
    EXPECT_NO_THROW(context().check("the context of the caller"));
}

TEST(CompileAheadSafety, LeavesOutTheVersionsOfMesaWhoseCompilerCrashesOnThreads) {
    for (const char* safe :
         {"4.5 (Core Profile) Mesa 22.3.6", "4.5 (Core Profile) Mesa 25.0.7-2+deb13u1",
          "4.6 (Core Profile) Mesa 25.1.9", "4.6 (Core Profile) Mesa 26.2.6-1",
          "4.6 (Core Profile) Mesa 27.0.0-devel (git-0123456789)", "4.6.0 NVIDIA 580.159", ""})
        EXPECT_TRUE(CompileAhead::is_safe_on_threads(safe)) << safe;
    for (const char* crashing : {"4.6 (Core Profile) Mesa 25.2.0", "4.6 (Core Profile) Mesa 25.3.4-1ubuntu1",
                                 "4.6 (Core Profile) Mesa 26.0.1", "4.6 (Core Profile) Mesa 26.1.12"})
        EXPECT_FALSE(CompileAhead::is_safe_on_threads(crashing)) << crashing;
}

TEST_P(CompileAheadOn, IsForDriversThatCompileOnTheProcessor) {
    EXPECT_EQ(CompileAhead::useful_threads(context(), 3), 3);
    EXPECT_EQ(CompileAhead::useful_threads(context(), 0), 0);
    EXPECT_EQ(CompileAhead::useful_threads(context(), -1), 0);
}

}  // namespace
}  // namespace aftershade::test
