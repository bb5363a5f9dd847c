#include "framework/golden/golden_run.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "framework/base/data_path.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/scratch_folder.h"
#include "framework/golden/approved_image.h"
#include "framework/golden/bound_case.h"
#include "framework/golden/capture_hash.h"
#include "framework/golden/golden_render.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

// Whether a golden case gives the same bits each time that it is drawn, and where it first does not.

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

/// Draws the case `runs` - 1 more times, in folders below `work`. "" where each has the bits of `first`; else
/// a sentence with the image that differs, and the first texture of a pass that does. Throws
/// Error(ErrorKind::output).
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

constexpr const char* kInterrupted = "interrupted";

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void skip(GoldenCaseResult& result, const std::string& why, const GoldenRunOptions& options) {
    result.skipped = why;
    if (!options.no_skip) return;
    result.verdict = Verdict::failure;
    result.messages.push_back("skipped, and --no-skip: " + why);
}

/// A limit for a layer that no image has would be held to nothing, unseen.
void check_layers(GoldenCaseResult& result) {
    std::set<std::string> labels;
    for (const GoldenImage& image : result.images) {
        if (!image.comparison) return;  // which layers there are is not known
        labels.insert(image.comparison->labels.begin(), image.comparison->labels.end());
    }
    const std::vector<std::string> known(labels.begin(), labels.end());
    for (const auto& [label, levels] : result.test->rules.layers) {
        if (labels.contains(label)) continue;
        result.verdict = std::max(result.verdict, Verdict::failure);
        result.messages.push_back("tolerance.layers: no image of the case has a layer '" + label + "'" +
                                  did_you_mean(label, known) + " (the layers are " +
                                  list_of_names(known, "and") + ")");
    }
}

/// A failure of images is a warning until the day is over. One of files is none that a picture decides.
void quarantine(GoldenCaseResult& result) {
    const Quarantine& quarantine = result.test->quarantine;
    if (quarantine.until.empty() || result.verdict <= Verdict::warning) return;
    const bool is_over = quarantine.until < day_of_today();
    result.messages.push_back(fmt::format("quarantine {} {}: {}", is_over ? "ended" : "until",
                                          quarantine.until, quarantine.reason));
    if (!is_over && result.verdict != Verdict::file_error) result.verdict = Verdict::warning;
}

void run_case(const GoldenRunOptions& options, const fs::path& work, ReportPictures* pictures,
              const std::atomic<bool>& interrupt, GoldenCaseResult& result, bool& interrupted) {
    const GoldenCase& test = *result.test;
    if (!test.skip.empty()) return skip(result, test.skip, options);
    if (is_unfetched(test, options, result.verdict, result.messages)) return;
    const RenderedCase rendered = render_case(test, options.render, work, interrupt);
    interrupted = rendered.interrupted;
    if (!rendered.absent.empty()) return skip(result, rendered.absent, options);
    result.command = rendered.command;
    if (interrupted) return;
    result.verdict = rendered.verdict;
    result.messages = rendered.messages;
    for (const RenderedImage& image : rendered.images)
        with_case_faults(result.verdict, result.messages, [&] {
            result.images.push_back(judge_image(test, image, result.sources, options.environment, pictures));
            result.verdict = std::max(result.verdict, result.images.back().verdict);
        });
    if (result.images.size() == rendered.images.size()) check_layers(result);
    if (options.runs == 1 || rendered.images.empty()) return;
    const std::string difference =
        difference_of_runs(test, options.render, rendered, options.runs, work, interrupt);
    interrupted = interrupt;
    if (difference.empty()) return;
    result.verdict = std::max(result.verdict, Verdict::failure);
    result.messages.push_back(difference);
}

}  // namespace

bool GoldenSuiteResult::all_skipped() const {
    return std::ranges::all_of(cases, [](const GoldenCaseResult& test) { return !test.skipped.empty(); });
}

void for_each_in_folders(std::size_t count, int jobs,
                         const std::function<void(std::size_t, const fs::path&)>& work) {
    const ScratchFolder folder;
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> failed = false;
    std::exception_ptr failure;
    std::mutex mutex;
    const auto turn = [&] {
        for (std::size_t i = next++; i < count && !failed; i = next++) try {
                const fs::path own = folder.path() / std::to_string(i);
                fs::create_directory(own);
                work(i, own);
                fs::remove_all(own);
            } catch (...) {
                const std::scoped_lock lock(mutex);
                if (!failed.exchange(true)) failure = std::current_exception();
            }
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < std::min<int>(jobs, int(count)); ++i) threads.emplace_back(turn);
    turn();
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

bool is_unfetched(const GoldenCase& test, const GoldenRunOptions& options, Verdict& verdict,
                  std::vector<std::string>& messages) {
    const auto unfetched = options.unfetched.find(test.name);
    if (unfetched == options.unfetched.end()) return false;
    verdict = Verdict::file_error;
    messages = unfetched->second;
    return true;
}

void with_case_faults(Verdict& verdict, std::vector<std::string>& messages,
                      const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::capture) throw;
        verdict = Verdict::file_error;
        messages.emplace_back(error.what());
    }
}

std::vector<std::string> look_hashes(const std::vector<const GoldenCase*>& cases,
                                     const GoldenRenderOptions& options) {
    LookHasher hasher(effect_folders(options.effect_paths), data_path() / "glsl",
                      {options.plugin_paths.begin(), options.plugin_paths.end()});
    std::vector<std::string> hashes;
    for (const GoldenCase* test : cases) hashes.push_back(hasher.hash(*test));
    return hashes;
}

GoldenSuiteResult run_golden_suite(const GoldenSuite& suite, const GoldenRunOptions& options,
                                   const GoldenListener& listener, const std::atomic<bool>& interrupt) {
    const auto start = Clock::now();
    GoldenSuiteResult result;
    result.started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    std::vector<const GoldenCase*> cases;
    for (const GoldenCase& test : suite.cases)
        if (fits_filter(test, options.filters)) cases.push_back(&test);
    const std::vector<std::string> looks = look_hashes(cases, options.render);
    CaptureHasher captures;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        result.cases.emplace_back();
        result.cases.back().test = cases[i];
        result.cases.back().sources = {looks[i], "", options.program};
        result.cases.back().skipped = kInterrupted;  // until it has run
    }
    std::optional<ReportPictures> pictures;
    if (!options.report.empty()) pictures.emplace(options.report / "images");
    std::mutex telling;
    int done = 0;
    for_each_in_folders(cases.size(), options.jobs, [&](std::size_t i, const fs::path& work) {
        if (interrupt) return;
        const auto begin = Clock::now();
        bool interrupted = false;
        result.cases[i].skipped.clear();
        if (cases[i]->skip.empty()) result.cases[i].sources.capture = captures.hash(*cases[i]);
        run_case(options, work, pictures ? &*pictures : nullptr, interrupt, result.cases[i], interrupted);
        if (result.cases[i].skipped.empty() && !interrupted) quarantine(result.cases[i]);
        if (interrupted) result.cases[i].skipped = kInterrupted;
        result.cases[i].seconds = seconds_since(begin);
        const std::scoped_lock lock(telling);
        if (!interrupted && listener) listener(result.cases[i], ++done, int(cases.size()));
    });
    result.interrupted = interrupt;
    if (pictures && !interrupt) pictures->remove_old();
    result.orphans = orphaned_goldens(suite, options.filters);
    if (!result.orphans.empty()) result.verdict = Verdict::failure;
    for (const GoldenCaseResult& test : result.cases) result.verdict = std::max(result.verdict, test.verdict);
    if (result.all_skipped()) result.verdict = std::max(result.verdict, Verdict::warning);
    result.seconds = seconds_since(start);
    return result;
}

}  // namespace aftershade
