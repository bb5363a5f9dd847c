// Every effect drawn by compute shaders: the bits of fragments, with every value of what its programs depend
// on, and at the ends of every other parameter. Prints the draws that stay fragments, with the reason.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/look/look.h"
#include "framework/render/renderer.h"
#include "tests/every_effect.h"

namespace aftershade::test {
namespace {

/// A context and its programs, which all runs share.
struct Screen {
    explicit Screen(gpu::Backend backend)
        : context(backend), programs(std::make_shared<ProgramCache>(context, kRoot / "glsl")) {}
    gpu::Context context;
    std::shared_ptr<ProgramCache> programs;
};

Screen& screen(gpu::Backend backend) {
    static std::map<gpu::Backend, std::unique_ptr<Screen>> screens;
    std::unique_ptr<Screen>& made = screens[backend];
    if (!made) made = std::make_unique<Screen>(backend);
    return *made;
}

class EffectAsCompute : public EveryEffect {
protected:
    struct Run {
        std::vector<FrameResult> frames;
        std::vector<DrawnPass> draws;
    };

    Run run_with(const Values& values, gpu::Backend backend, const RendererOptions& drawing) const {
        Diagnostics diagnostics;
        const auto node = parse_document(look_of(GetParam(), values), "look", diagnostics);
        const auto look = parse_look(*node, diagnostics);
        const Pipeline pipeline = bind_pipeline(*look, registry(), {}, diagnostics);
        EXPECT_FALSE(diagnostics.has_errors()) << faults_of(diagnostics);
        Screen& on = screen(backend);
        // Guarded programs are others.
        const auto programs =
            drawing.guards_loops ? std::make_shared<ProgramCache>(on.context, kRoot / "glsl") : on.programs;
        PipelineRenderer renderer(on.context, pipeline, programs, {}, drawing);
        std::vector<std::string> roles;
        for (const OutputSpec& output : manifest().outputs) roles.push_back(output.role);
        Run run;
        const Capture before = with_aovs(capture_before()), now = with_aovs(small_capture());
        for (const Capture* capture : {&before, &now}) {
            FrameInputs frame;
            frame.capture = capture;
            frame.neighbours[-1] = &before;
            run.frames.push_back(renderer.render(frame, roles, false));
        }
        run.draws = renderer.draws();
        return run;
    }

    void expect_same(const Values& values, gpu::Backend backend) {
        const Run drawn = run_with(values, backend, {.draw_with = DrawWith::fragment});
        const Run computed = run_with(values, backend, {.draw_with = DrawWith::compute});
        const std::string where =
            std::string(gpu::backend_name(backend)) + ": " + look_of(GetParam(), values);
        const std::string difference = first_difference(drawn, computed);
        if (!difference.empty()) {
            const std::string fault = fault_of_loops(values, backend);
            if (fault.empty()) {
                EXPECT_EQ(largest_difference(drawn, computed), 0) << where;
            }
            std::cout << difference << " differs on " << where << "\n    " << fault << "\n";
        }
        for (const DrawnPass& draw : computed.draws) {
            EXPECT_EQ(draw.computes, draw.why_drawn.empty()) << draw.pass << ": " << draw.why_drawn;
            // The turns of a repeated pass are alike.
            draws_[draw.pass.substr(0, draw.pass.find('['))] = draw.why_drawn;
        }
    }

    static std::string first_difference(const Run& drawn, const Run& computed) {
        for (std::size_t i = 0; i < drawn.frames.size(); ++i)
            for (const auto& [role, image] : drawn.frames[i].images)
                if (!same_bits(image, computed.frames[i].images.at(role)))
                    return role + " of frame " + std::to_string(i);
        return "";
    }

    /// Of a value, over the larger one or 1.
    static double largest_difference(const Run& drawn, const Run& computed) {
        double largest = 0;
        for (std::size_t i = 0; i < drawn.frames.size(); ++i)
            for (const auto& [role, image] : drawn.frames[i].images) {
                const auto other = computed.frames[i].images.at(role).floats();
                for (std::size_t k = 0; k < other.size(); ++k) {
                    const double a = image.floats()[k], b = other[k];
                    largest = std::max(largest, std::abs(a - b) / std::max({1.0, std::abs(a), std::abs(b)}));
                }
            }
        return largest;
    }

    /// llvmpipe counts iterations of several pixels together, fragments' and invocations' by other groups,
    /// and ends loops after 65,535: then neither picture is right.
    std::string fault_of_loops(const Values& values, gpu::Backend backend) const {
        for (const DrawWith way : {DrawWith::fragment, DrawWith::compute}) try {
                run_with(values, backend, {.guards_loops = true, .draw_with = way});
            } catch (const Error& error) {
                return error.what();
            }
        return "";
    }

    void print_draws() const {
        int computed = 0;
        for (const auto& [pass, why] : draws_) computed += why.empty();
        std::cout << GetParam() << ": " << computed << " of " << draws_.size() << " draws compute\n";
        for (const auto& [pass, why] : draws_)
            if (!why.empty()) std::cout << "    " << pass << " " << why << "\n";
    }

private:
    std::map<std::string, std::string> draws_;  // why each stays a draw, or ""
};

INSTANTIATE_TEST_SUITE_P(Effects, EffectAsCompute, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

TEST_P(EffectAsCompute, GivesTheBitsOfFragments) {
    for (const gpu::Backend backend : backends()) expect_same({}, backend);
    for (const ParamSpec& spec : manifest().params)
        for (const ParamValue& value : extremes_of(spec))
            if (value != spec.default_value) expect_same({{spec.name, value}}, backends().front());
    print_draws();
}

/// --plain.
TEST_P(EffectAsCompute, GivesTheBitsOfPlainDrawing) {
    const auto backend = backends().front();
    const Run drawn = run_with({}, backend, {.draw_with = DrawWith::fragment});
    const Run plain =
        run_with({}, backend, {.fuses_passes = false, .plain = true, .draw_with = DrawWith::fragment});
    EXPECT_EQ(first_difference(drawn, plain), "");
}

}  // namespace
}  // namespace aftershade::test
