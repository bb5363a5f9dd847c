#include "framework/golden/golden_apply.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/golden/approved_image.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// What stands against the image that a case draws now. The reviewer saw one new image beside one approved.
std::string why_not(const GoldenDecision& decision, const GoldenApplyOptions& options,
                    const RenderedImage& image, const std::vector<ApprovedImage>& approved) {
    if (decision.images.empty()) return "";
    const auto seen = std::ranges::find(decision.images, image.name, &SeenImage::name);
    if (seen == decision.images.end())
        return "is not among the images that were reviewed; run the suite again and review it";
    constexpr const char* kOtherPicture =
        "the case draws another picture here than the one that was reviewed; run the suite again here and "
        "review it";
    if (file_hash(image.file) != seen->test) return kOtherPicture;
    // The hash finds changes, and does not resist intent: where the file is at hand its bytes decide.
    if (options.seen_bytes && options.seen_bytes(decision.test, image.name) !=
                                  read_text_file(image.file, ErrorKind::output, std::uintmax_t(1) << 30))
        return kOtherPicture;
    // Another reviewer of the same report may have written the new one since approve compared the bits.
    const auto is_seen = [&](const ApprovedImage& other) {
        const std::string hash = file_hash(other.file);
        return hash == seen->reference || hash == seen->test;
    };
    if ((!seen->reference.empty() || !approved.empty()) && std::ranges::none_of(approved, is_seen))
        return "another image was approved since the review; run the suite again and review it";
    return "";
}

void add_to(GoldenApproval& all, GoldenApproval more) {
    const auto append = [](auto& to, auto& from) {
        to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    };
    append(all.written, more.written);
    append(all.renewed, more.renewed);
    append(all.outdated, more.outdated);
    append(all.cases, more.cases);
    all.unchanged += more.unchanged;
    all.verdict = std::max(all.verdict, more.verdict);
    all.interrupted |= more.interrupted;
}

}  // namespace

std::vector<GoldenDecision> resolve_decisions(const GoldenSuite& suite,
                                              const std::vector<GoldenDecision>& decisions,
                                              const std::optional<GoldenApprovers>& approvers,
                                              Diagnostics& diagnostics) {
    std::vector<GoldenDecision> resolved;
    for (const GoldenDecision& decision : decisions) {
        bool fits = false;
        for (const GoldenCase& test : suite.cases) {
            // What was seen is of one case; a name that is not one must not be taken for a glob.
            if (decision.images.empty() ? !fits_filter(test, {decision.test}) : test.name != decision.test)
                continue;
            fits = true;
            if (approvers && !approvers->may(decision.by, test.name))
                diagnostics.error(
                    {"case '" + test.name + "'"},
                    fmt::format("'{}' may not decide about it; approvers.json names who may", decision.by));
            std::erase_if(resolved, [&](const auto& other) { return other.test == test.name; });
            resolved.push_back(decision);
            resolved.back().test = test.name;
        }
        if (!fits)
            diagnostics.error({"decision about '" + decision.test + "'"}, no_case_fits(suite, decision.test));
    }
    return resolved;
}

GoldenApplied apply_decisions(const GoldenSuite& suite, const std::vector<GoldenDecision>& resolved,
                              const GoldenApplyOptions& options, const GoldenListener& listener,
                              const std::atomic<bool>& interrupt) {
    GoldenApplied result;
    // One approval for each name, which its sidecars have.
    std::map<std::tuple<std::string, bool>, std::map<std::string, const GoldenDecision*>> groups;
    for (const GoldenDecision& decision : resolved)
        if (decision.approves) groups[{decision.by, decision.adds}][decision.test] = &decision;
        else result.rejections.push_back(decision);
    for (const auto& [key, cases] : groups) {
        GoldenApproveOptions approve = options.approve;
        std::tie(approve.approver, approve.add) = key;
        approve.run.filters.clear();
        for (const auto& [name, decision] : cases) approve.run.filters.push_back(name);
        if (!options.any_renderer)
            if (const std::string why = foreign_goldens(suite, approve.run); !why.empty())
                throw Error(ErrorKind::usage, why);
        approve.why_not = [&](const GoldenCase& test, const RenderedImage& image,
                              const std::vector<ApprovedImage>& approved) {
            return why_not(*cases.at(test.name), options, image, approved);
        };
        GoldenApproval approval = approve_goldens(suite, approve, listener, interrupt);
        for (const GoldenCaseResult& test : approval.cases) {
            if (approval.interrupted) break;
            if (test.verdict <= Verdict::warning && test.skipped.empty())
                result.applied.push_back(*cases.at(test.test->name));
            else if (!test.skipped.empty())
                result.kept.push_back(test.test->name + ": is skipped: " + test.skipped);
            else
                for (const std::string& message : test.messages)
                    result.kept.push_back(test.test->name + ": " + message);
        }
        add_to(result.approval, std::move(approval));
        if (result.approval.interrupted) break;
    }
    return result;
}

}  // namespace aftershade
