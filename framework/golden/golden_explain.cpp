#include "framework/golden/golden_explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "framework/base/text.h"
#include "framework/golden/capture_hash.h"
#include "framework/golden/case_trace.h"
#include "framework/golden/golden_commits.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

using Texts = std::map<std::string, std::string>;

/// Names that either has, and where they differ.
std::set<std::string> differing(const Texts& before, const Texts& now) {
    std::set<std::string> names;
    for (const auto* texts : {&before, &now})
        for (const auto& [name, text] : *texts) {
            const auto old = before.find(name), own = now.find(name);
            if (old == before.end() || own == now.end() || old->second != own->second) names.insert(name);
        }
    return names;
}

std::string step_of(const std::string& value) {
    return value.substr(0, value.find('.'));
}

OriginChange change_of_file(const std::string& name, const CaseOrigin& before, const CaseParts& now) {
    const auto part = now.files.find(name);
    if (part == now.files.end()) return {kind_of_file(name) + " " + name + " is no longer read", "", {}, {}};
    return {part->second.kind + " " + name + (before.files.contains(name) ? " has changed" : " is new"),
            part->second.document,
            part->second.steps,
            {}};
}

OriginChange change_of_value(const std::string& name, const CaseOrigin& before, const CaseParts& now) {
    const auto part = now.values.find(name);
    const auto old = before.values.find(name);
    if (part == now.values.end())
        return {"parameter " + name + " is no longer set, was " + old->second, "", {step_of(name)}, {}};
    const std::string& value = now.origin.values.at(name);
    return {fmt::format("{} {} is {}, {}", part->second.kind, name, value,
                        old == before.values.end() ? "was not set" : "was " + old->second),
            part->second.document,
            part->second.steps,
            {}};
}

std::string names_of(const std::vector<StepHashes>& steps) {
    std::vector<std::string> names;
    for (const StepHashes& step : steps) names.push_back(step.step);
    return joined(names, ", ");
}

/// Everything that differs between the approval and now.
std::vector<OriginChange> changes_between(const GoldenSidecar& approved, const CaseParts& now,
                                          const GoldenSources& sources, const GoldenCase& test) {
    const CaseOrigin& before = approved.origin;
    std::vector<OriginChange> changes;
    if (names_of(before.steps) != names_of(now.origin.steps))
        changes.push_back(
            {fmt::format("the steps are {}; were {}", names_of(now.origin.steps), names_of(before.steps)),
             test.look.empty() ? test.file : test.look,
             {},
             {}});
    for (const std::string& name : differing(before.values, now.origin.values))
        changes.push_back(change_of_value(name, before, now));
    for (const std::string& name : differing(before.files, now.origin.files))
        changes.push_back(change_of_file(name, before, now));
    const auto is_capture = [](const auto& file) { return file.second.kind == "capture"; };
    const bool known = std::ranges::any_of(now.files, [&](const auto& file) {
        const auto old = before.files.find(file.first);
        return is_capture(file) &&
               (old == before.files.end() || old->second != now.origin.files.at(file.first));
    });
    if (!known && !sources.capture.empty() && !approved.sources.capture.empty() &&
        sources.capture != approved.sources.capture &&
        std::ranges::none_of(changes, [](const auto& change) { return change.text.starts_with("profile"); }))
        changes.push_back({"the capture's files of other frames have changed", "", {}, {}});
    return changes;
}

/// The first step with other pixels, by the hashes of the sidecar.
void find_step(const std::vector<StepHashes>& before, const std::vector<StepHashes>& now,
               GoldenExplanation& result) {
    for (const StepHashes& step : now) {
        const auto old = std::ranges::find(before, step.step, &StepHashes::step);
        const std::set<std::string> outputs =
            differing(old == before.end() ? Texts() : old->outputs, step.outputs);
        if (!outputs.empty()) {
            result.step = step.step;
            result.outputs.assign(outputs.begin(), outputs.end());
            return;
        }
        ++result.steps_before;
    }
    result.notes.emplace_back(
        "every step gave the approved bits, so the difference is in how the image is written");
}

/// Where hashes do not help: the first step that something has changed of.
void find_step_by_changes(const std::vector<OriginChange>& changes, const CaseParts& now,
                          GoldenExplanation& result) {
    for (const StepHashes& step : now.origin.steps)
        for (const OriginChange& change : changes)
            if (change.steps.contains(step.step)) {
                result.step = step.step;
                return;
            }
}

/// Commits since the one that approved the image, or else the last; "not committed" where there is more.
std::vector<std::string> commits_of(const fs::path& document, const fs::path& sidecar) {
    if (document.empty()) return {};
    constexpr const char* kFormat = "--format=%h %as %an: %s";
    const fs::path folder = fs::absolute(document).parent_path();
    const std::string name = document.filename().string();
    std::vector<std::string> commits;
    if (!lines_of_git(folder, {"status", "--porcelain", "--", name}).empty())
        commits.emplace_back("not committed");
    const std::vector<std::string> approval =
        lines_of_git(sidecar.parent_path(), {"log", "-1", "--format=%H", "--", sidecar.filename().string()});
    // The oldest commit of a shallow clone seems to have made every file.
    const bool is_shallow =
        lines_of_git(folder, {"rev-parse", "--is-shallow-repository"}) == std::vector<std::string>{"true"};
    std::vector<std::string> since;
    if (!approval.empty())
        since = lines_of_git(folder, {"log", "--max-count=5", kFormat, approval[0] + "..HEAD", "--", name});
    if (since.empty() && commits.empty())
        since = lines_of_git(
            folder, {"log", "-1", is_shallow ? "--min-parents=1" : "--min-parents=0", kFormat, "--", name});
    for (const std::string& commit : since) commits.push_back(printable(commit));
    if (commits.empty() && is_shallow)
        commits.emplace_back("in a commit that this shallow clone lacks (git fetch --unshallow)");
    return commits;
}

/// Puts the changes where they belong.
void divide(std::vector<OriginChange> changes, GoldenExplanation& result) {
    for (OriginChange& change : changes) {
        const bool fits = change.steps.empty() || result.step.empty() || change.steps.contains(result.step);
        change.commits = commits_of(change.document, sidecar_path(result.image.approved->file));
        (fits ? result.causes : result.others).push_back(std::move(change));
    }
}

void explain_image(const GoldenCase& test, const GoldenRunOptions& options, const CaseParts& now,
                   const GoldenSources& sources, const std::vector<StepHashes>& steps,
                   GoldenExplanation& result) {
    if (!result.image.approved || !result.image.approved->sidecar) {
        result.notes.push_back(result.image.approved ? "no sidecar records what made the approved image"
                                                     : "the image has no golden; approve it");
        return;
    }
    const GoldenSidecar& approved = *result.image.approved->sidecar;
    if (approved.origin == CaseOrigin{}) {
        for (const std::string& change : result.image.changes) result.causes.push_back({change, "", {}, {}});
        result.notes.emplace_back(
            "the sidecar has no hashes of steps and files; run golden approve --renew-sidecars where the "
            "case passes");
        return;
    }
    std::vector<OriginChange> changes = changes_between(approved, now, sources, test);
    const std::string machine = options.environment.difference(approved.environment);
    if (machine.empty() && !steps.empty()) find_step(approved.origin.steps, steps, result);
    else find_step_by_changes(changes, now, result);
    if (const auto effect = now.effects.find(result.step); effect != now.effects.end())
        result.effect = effect->second;
    if (!machine.empty()) changes.push_back({"the machine: " + machine, "", {}, {}});
    if (!sources.program.empty() && sources.program != approved.sources.program)
        changes.push_back(
            {"the program is Aftershade " + sources.program + " instead of " + approved.sources.program,
             "",
             {},
             {}});
    divide(std::move(changes), result);
    if (result.causes.empty())
        result.notes.emplace_back(
            "nothing that the sidecar records has changed; golden run --repeat 2 shows whether the case is "
            "deterministic");
}

}  // namespace

GoldenExplanation explain_case(const GoldenCase& test, const GoldenRunOptions& options,
                               const fs::path& suite_folder, const fs::path& work,
                               const std::atomic<bool>& interrupt) {
    GoldenExplanation result;
    if (is_unfetched(test, options, result.image.verdict, result.messages)) return result;
    CaptureHasher captures;
    const GoldenSources sources{look_hashes({&test}, options.render).front(), captures.hash(test),
                                options.program};
    CaseTracer tracer(options.render, suite_folder);
    TracedCase traced = render_traced(test, tracer.taps(test), options.render, work, interrupt);
    result.messages = traced.rendered.messages;
    result.image.verdict = traced.rendered.verdict;
    std::ranges::stable_sort(traced.rendered.images, {}, &RenderedImage::frame);
    for (const RenderedImage& rendered : traced.rendered.images) {
        GoldenImage image;
        with_case_faults(result.image.verdict, result.messages,
                         [&] { image = judge_image(test, rendered, sources, options.environment, nullptr); });
        if (image.bits_equal || image.name.empty()) continue;
        result.image = std::move(image);
        explain_image(test, options, tracer.parts(test, rendered.frame), sources,
                      traced.steps[rendered.frame], result);
        return result;
    }
    if (!traced.rendered.images.empty() || interrupt || traced.rendered.verdict == Verdict::same)
        return result;
    // Nothing was drawn: what has changed is known nevertheless.
    for (const std::string& stem : test.image_stems())
        for (const auto& entry : fs::directory_iterator(test.goldens)) {
            const auto frame = approved_frame(entry.path().filename().string(), stem);
            if (!frame || result.image.approved) continue;
            const std::string name = golden_image_name(stem, *frame);
            result.image.name = name, result.image.frame = *frame;
            with_case_faults(result.image.verdict, result.messages, [&] {
                result.image.approved = approved_images(test.goldens, name, options.environment).front();
            });
        }
    if (result.image.approved)
        explain_image(test, options, tracer.parts(test, result.image.frame), sources, {}, result);
    return result;
}

std::string text_of(const GoldenCase& test, const GoldenExplanation& explanation) {
    const GoldenImage& image = explanation.image;
    if (image.name.empty() && image.verdict == Verdict::same)
        return test.name + ": every image has the approved bits\n";
    std::string text = fmt::format("{}: {}{}\n", test.name, image.name.empty() ? "" : image.name + ": ",
                                   verdict_name(image.verdict));
    for (const std::string& message : explanation.messages) text += "    " + message + "\n";
    if (image.approved && image.approved->sidecar && !image.approved->sidecar->approved.empty())
        text += fmt::format(
            "  approved {}{}\n", image.approved->sidecar->approved,
            image.approved->sidecar->approver.empty() ? "" : " by " + image.approved->sidecar->approver);
    if (!explanation.step.empty() && !explanation.outputs.empty())
        text += fmt::format(
            "  first step that differs: '{}' (effect {}), output {}, frame {}; {} before it gave "
            "the approved bits\n",
            explanation.step, explanation.effect, joined(explanation.outputs, ", "), image.frame,
            counted(explanation.steps_before, "step"));
    else if (!explanation.step.empty())
        text += fmt::format("  first step that something has changed of: '{}' (effect {})\n",
                            explanation.step, explanation.effect);
    for (const auto& [word, changes] :
         {std::pair{"cause", &explanation.causes}, {"also changed, of other steps", &explanation.others}})
        for (const OriginChange& change : *changes) {
            text += fmt::format("  {}: {}\n", word, change.text);
            for (const std::string& commit : change.commits) text += "    " + commit + "\n";
        }
    for (const std::string& note : explanation.notes) text += "  note: " + note + "\n";
    return text;
}

}  // namespace aftershade
