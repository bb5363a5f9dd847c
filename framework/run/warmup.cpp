#include "framework/run/warmup.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/error.h"

namespace aftershade {

namespace {

/// The last frame's colour, after `warmup` of the frames before it.
Image last_frame(const RunSetup& setup, const std::filesystem::path& folder, std::size_t warmup,
                 const RunObserver& observer = {}) {
    RunOptions options = setup.options;
    options.frames.assign(setup.options.frames.end() - std::ptrdiff_t(warmup) - 1,
                          setup.options.frames.end());
    options.warmup_frames = int(warmup);
    OutputOptions outputs;
    outputs.patterns = {(folder / "frame.exr").string()};
    outputs.color_type = PixelType::float32;
    // A frame that is only for history fails none of the run; the error would be that of fewer frames.
    RunObserver strict = observer;
    strict.frame_failed = [](const std::string& why) {
        throw Error(ErrorKind::capture, why + "; a warm-up is measured on frames that can all be read");
    };
    const std::atomic<bool> stop = false;
    run_frames(
        {setup.context, setup.pipeline, setup.sequence, setup.reader, options, outputs, setup.data_folder},
        strict, stop);
    return ExrFile(folder / "frame.exr").read_floats(0, std::vector<std::string>{"R", "G", "B"});
}

double difference(const Image& uncut, const Image& cut) {
    constexpr double kPercentile = 0.99;
    std::vector<double> differences;
    double sum = 0;
    for (std::size_t i = 0; i < uncut.floats().size(); ++i) {
        differences.push_back(std::abs(double(uncut.floats()[i]) - double(cut.floats()[i])));
        sum += std::abs(double(uncut.floats()[i]));
    }
    const auto at = differences.begin() + std::ptrdiff_t(kPercentile * double(differences.size() - 1));
    std::nth_element(differences.begin(), at, differences.end());
    const double mean = sum / double(differences.size());
    return mean > 0 ? *at / mean : *at;
}

}  // namespace

LookWarmup warmup_of(const Pipeline& pipeline) {
    LookWarmup warmup;
    for (const PipelineStep& step : pipeline.steps) {
        if (!step.manifest->has_history()) continue;
        if (!step.manifest->warmup) {
            warmup.undeclared.push_back(step.name);
            continue;
        }
        warmup.frames += step.manifest->warmup->frames;
        warmup.error += step.manifest->warmup->error;
    }
    return warmup;
}

std::vector<WarmupError> measure_warmup(const RunSetup& setup, const std::filesystem::path& folder,
                                        const RunObserver& observer) {
    const std::size_t before = setup.options.frames.size() - 1;
    const Image uncut = last_frame(setup, folder, before, observer);
    std::vector<WarmupError> errors;
    for (std::size_t warmup = 0; warmup < before; warmup = warmup ? warmup * 2 : 1)
        errors.push_back({int(warmup), difference(uncut, last_frame(setup, folder, warmup))});
    return errors;
}

}  // namespace aftershade
