#include "framework/batch/determinism.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/batch/approved_image.h"
#include "framework/batch/bound_case.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// What a pass of a step writes.
struct Written {
    std::string tap, pass;
};

/// Textures and outputs of a step in the order in which passes finish them.
std::vector<Written> written_by(const PipelineStep& step) {
    std::vector<Written> all;
    for (const PassSpec& pass : step.manifest->passes)
        for (const WriteSpec& write : pass.writes) {
            const TextureSpec* texture = step.manifest->find_texture(write.name);
            if (texture && texture->layers > 1) continue;  // no tap has layers
            const std::string tap = step.name + "." + write.name;
            std::erase_if(all, [&](const Written& known) { return known.tap == tap; });
            all.push_back({tap, step.name + "." + pass.name});
        }
    return all;
}

RenderedCase drawn(const GoldenCase& test, const GoldenRenderOptions& options, const fs::path& work,
                   const std::atomic<bool>& interrupt) {
    fs::create_directories(work);
    return render_case(test, options, work, interrupt);
}

/// The first image of `a` that has other bits in `b`, in the order of `a`; nullptr: all are equal, or one was
/// not drawn.
const RenderedImage* first_difference(const RenderedCase& a, const RenderedCase& b) {
    if (a.images.size() != b.images.size()) return nullptr;
    for (std::size_t i = 0; i < a.images.size(); ++i)
        if (file_hash(a.images[i].file) != file_hash(b.images[i].file)) return &a.images[i];
    return nullptr;
}

/// Draws a case with one tap more than once, to find the first that differs.
class PlaceOfDifference {
public:
    PlaceOfDifference(const GoldenCase& test, const GoldenRenderOptions& options, fs::path work,
                      const std::atomic<bool>& interrupt)
        : tapped_(test), options_(options), work_(std::move(work)), interrupt_(interrupt) {}

    /// "; the first pass whose result differs is 'dof.far' (lens.dof.far_color.0001)"; "" where none does.
    std::string text() {
        EffectRegistry effects(effect_folders(options_.effect_paths), data_path() / "glsl");
        const BoundCase bound = bind_case(tapped_, effects);
        for (const PipelineStep& step : bound.pipeline.steps) {
            const auto is_output = [&](const OutputSpec& output) {
                return differs(step.name + "." + output.name);
            };
            if (!std::ranges::any_of(step.manifest->outputs, is_output)) continue;
            for (const Written& written : written_by(step))
                if (differs(written.tap))
                    return fmt::format("; the first pass whose result differs is '{}' ({})", written.pass,
                                       image_);
        }
        return "";
    }

private:
    /// False too where the values of the step make no such texture.
    bool differs(const std::string& tap) {
        tapped_.taps = {tap};
        std::array<RenderedCase, 2> runs;
        for (RenderedCase& run : runs) {
            run = drawn(tapped_, options_, work_ / ("tapped" + std::to_string(++count_)), interrupt_);
            std::erase_if(run.images, [&](const RenderedImage& image) { return image.output != tap; });
        }
        const RenderedImage* const image = first_difference(runs[0], runs[1]);
        if (image) image_ = image->name;
        return image != nullptr;
    }

    GoldenCase tapped_;
    const GoldenRenderOptions& options_;
    fs::path work_;
    const std::atomic<bool>& interrupt_;
    int count_ = 0;
    std::string image_;
};

}  // namespace

std::string difference_of_runs(const GoldenCase& test, const GoldenRenderOptions& options,
                               const RenderedCase& first, int runs, const fs::path& work,
                               const std::atomic<bool>& interrupt) {
    for (int run = 2; run <= runs && !interrupt; ++run) {
        const RenderedCase again = drawn(test, options, work / ("run" + std::to_string(run)), interrupt);
        if (interrupt) break;
        if (again.verdict == Verdict::warning)
            return fmt::format("run {} of {}: {}", run, runs, again.messages.front());
        if (again.images.size() != first.images.size())
            return fmt::format("run {} of {} did not draw", run, runs);
        if (const RenderedImage* image = first_difference(first, again))
            return fmt::format("not deterministic: run {} of {} gave other bits in {}{}", run, runs,
                               image->name, PlaceOfDifference(test, options, work, interrupt).text());
    }
    return "";
}

}  // namespace aftershade
