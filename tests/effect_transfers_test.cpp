// Every effect with its images through mapped buffers, and with two frames on their way at once: the bits of
// GL's own copies.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/look/look.h"
#include "framework/render/renderer.h"
#include "tests/every_effect.h"
#include "tests/scoped_variable.h"

namespace aftershade::test {
namespace {

struct TransferScreen {
    explicit TransferScreen(gpu::Backend backend)
        : context(backend), programs(std::make_shared<ProgramCache>(context, kRoot / "glsl")) {}
    gpu::Context context;
    std::shared_ptr<ProgramCache> programs;
};

TransferScreen& transfer_screen(const std::string& way) {
    static std::map<std::string, std::unique_ptr<TransferScreen>> screens;
    std::unique_ptr<TransferScreen>& made = screens[way];
    if (made) return *made;
    ScopedVariable variable("AFTERSHADE_TRANSFERS");
    variable.set(way);
    made = std::make_unique<TransferScreen>(backends().front());
    return *made;
}

class EffectTransfers : public EveryEffect {
protected:
    std::vector<FrameResult> frames(const std::string& way) const {
        Diagnostics diagnostics;
        const auto node = parse_document(look_of(GetParam(), {}), "look", diagnostics);
        const auto look = parse_look(*node, diagnostics);
        const Pipeline pipeline = bind_pipeline(*look, registry(), {}, diagnostics);
        EXPECT_FALSE(diagnostics.has_errors()) << faults_of(diagnostics);
        TransferScreen& on = transfer_screen(way);
        PipelineRenderer renderer(on.context, pipeline, on.programs);
        std::vector<std::string> roles;
        for (const OutputSpec& output : manifest().outputs) roles.push_back(output.role);
        const Capture before = with_aovs(capture_before()), now = with_aovs(small_capture());
        std::vector<PendingFrame> pending;
        std::vector<FrameResult> results;
        for (const Capture* capture : {&before, &now, &before}) {
            FrameInputs frame;
            frame.capture = capture;
            frame.neighbours[-1] = &before;
            pending.push_back(renderer.begin(frame, roles, true));
            if (way == "direct") results.push_back(pending.back().finish());
        }
        for (PendingFrame& frame : pending)
            if (way == "mapped") results.push_back(frame.finish());
        return results;
    }
};

INSTANTIATE_TEST_SUITE_P(Effects, EffectTransfers, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

TEST_P(EffectTransfers, GiveTheSameBitsMappedAndDirect) {
    const std::vector<FrameResult> direct = frames("direct"), mapped = frames("mapped");
    ASSERT_EQ(direct.size(), mapped.size());
    for (std::size_t i = 0; i < direct.size(); ++i) {
        ASSERT_EQ(direct[i].images.size(), manifest().outputs.size());
        EXPECT_EQ(direct[i].finite_roles, mapped[i].finite_roles);
        ASSERT_EQ(direct[i].times.size(), mapped[i].times.size());
        for (std::size_t k = 0; k < direct[i].times.size(); ++k)
            EXPECT_EQ(direct[i].times[k].pass, mapped[i].times[k].pass);
        for (const auto& [role, image] : direct[i].images)
            EXPECT_TRUE(same_bits(image, mapped[i].images.at(role))) << role << " of frame " << i;
    }
}

}  // namespace
}  // namespace aftershade::test
