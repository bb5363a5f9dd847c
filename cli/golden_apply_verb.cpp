#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/compare_options.h"
#include "cli/golden_options.h"
#include "cli/interrupt.h"
#include "framework/base/atomic_file.h"
#include "framework/base/text.h"
#include "framework/document/document.h"
#include "framework/golden/golden_apply.h"
#include "framework/golden/golden_commits.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

struct ApplyArguments {
    GoldenOptions golden;
    std::string file;
    std::optional<std::string> commits, author, approvers;
};

/// Prints why tags of some commits do not count.
std::vector<GoldenDecision> decisions_of_revisions(const fs::path& folder, const std::string& revisions) {
    const std::vector<TaggedCommit> commits = commits_of_git(folder, revisions);
    if (commits.empty())
        throw CodedError(kCompareUsage, "--commits " + revisions + ": `git log` in " + folder.string() +
                                            " gives no commit; name one, or a range such as main..HEAD");
    std::vector<std::string> notes;
    std::vector<GoldenDecision> decisions = decisions_of_commits(commits, notes);
    for (const std::string& note : notes) std::cerr << "note: " << note << "\n";
    return decisions;
}

std::vector<GoldenDecision> read_decisions(const ApplyArguments& arguments, const fs::path& folder,
                                           Diagnostics& diagnostics) {
    if (arguments.file.empty() == !arguments.commits)
        throw CodedError(kCompareUsage,
                         "golden apply-approvals takes either a FILE of decisions or --commits");
    std::vector<GoldenDecision> decisions =
        arguments.commits
            ? decisions_of_revisions(folder, *arguments.commits)
            : parse_decisions(read_text_file(arguments.file, ErrorKind::capture, kMaxDocumentBytes),
                              arguments.file, diagnostics);
    if (arguments.author)
        for (GoldenDecision& decision : decisions) decision.by = *arguments.author;
    return decisions;
}

/// "" is what a variable of CI gives that is not set: the file's word and the suite's list must not count
/// then.
void refuse_empty(const std::optional<std::string>& value, const std::string& option,
                  const std::string& remedy) {
    if (value && trimmed(*value).empty())
        throw CodedError(kCompareUsage, option + ": is empty; " + remedy + ", or leave the option out");
}

ExitCode apply(const ApplyArguments& arguments) {
    refuse_empty(arguments.commits, "--commits", "name commits, such as HEAD or main..HEAD");
    refuse_empty(arguments.author, "--author", "name who decided: 'Ada <ada@example.org>'");
    refuse_empty(arguments.approvers, "--approvers", "name the file of who may approve");
    const std::atomic<bool>& stop = watch_for_interrupt();
    GoldenSetup setup = prepare_golden(arguments.golden);
    setup.context.suite = &setup.suite;
    const fs::path folder = setup.suite.folder();
    Diagnostics diagnostics;
    GoldenApplyOptions options;
    options.any_renderer = arguments.golden.any_renderer;
    options.approvers = read_approvers(
        arguments.approvers ? fs::path(*arguments.approvers) : folder / "approvers.json", diagnostics);
    const std::vector<GoldenDecision> decisions = resolve_decisions(
        setup.suite, read_decisions(arguments, folder, diagnostics), options.approvers, diagnostics);
    if (diagnostics.has_errors()) throw CodedError(kCompareUsage, diagnostics);
    options.approve = approve_options_of(setup, arguments.golden, approve_command(setup));
    const GoldenApplied applied = apply_decisions(setup.suite, decisions, options, {}, stop);
    if (applied.approval.interrupted) {
        std::cerr << "interrupted; the cases that are not listed were not written\n";
        print_approval(applied.approval);
        return ExitCode::interrupted;
    }
    print_approval(applied.approval);
    for (const GoldenDecision& decision : applied.rejections)
        std::cerr << printable_lines(fmt::format("REJECTED {} by {}: {}", decision.test, decision.by,
                                                 decision.note.empty() ? "no note" : decision.note))
                  << "\n";
    if (decisions.empty()) std::cerr << "no decision: nothing was written\n";
    return applied.rejections.empty() ? ExitCode(int(applied.approval.verdict))
                                      : ExitCode(int(std::max(applied.approval.verdict, Verdict::failure)));
}

}  // namespace

std::function<ExitCode()> add_golden_apply(CLI::App& golden) {
    auto arguments = std::make_shared<ApplyArguments>();
    auto* const verb = golden.add_subcommand(
        "apply-approvals",
        "Approve the cases that a file or commit messages name, if approvers.json allows it");
    verb->add_option("suite", arguments->golden.suite, "A golden.json or its folder")->required();
    verb->add_option("file", arguments->file,
                     "Decisions (JSON), as the report's page downloads them or golden serve keeps them");
    verb->add_option("--commits", arguments->commits,
                     "Take the lines 'golden: approve CASE...' of these commits, such as HEAD or main..HEAD")
        ->type_name("REVISIONS");
    verb->add_option("--author", arguments->author,
                     "Who decided, instead of the names in FILE: 'Ada <ada@example.org>'")
        ->type_name("NAME");
    verb->add_option("--approvers", arguments->approvers,
                     "Who may approve (default: approvers.json in the suite's folder)")
        ->type_name("FILE");
    add_any_renderer_option(*verb, arguments->golden);
    add_golden_drawing_options(*verb, arguments->golden);
    return [arguments] { return apply(*arguments); };
}

}  // namespace aftershade::cli
