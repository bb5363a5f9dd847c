#include "framework/golden/golden_commits.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>
#include <string_view>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/batch/worker.h"

namespace aftershade {

namespace {

constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr std::size_t kShortestHash = 7;

std::string_view subject_of(const TaggedCommit& commit) {
    return std::string_view(commit.message).substr(0, commit.message.find('\n'));
}

/// The hash after each of these words in the message.
std::vector<std::string> hashes_after(const std::string& message, std::string_view words) {
    std::vector<std::string> hashes;
    for (std::size_t at = 0; (at = message.find(words, at)) != message.npos;) {
        at += words.size();
        const std::size_t end = std::min(message.find_first_not_of(kHexDigits, at), message.size());
        if (end - at >= kShortestHash) hashes.push_back(message.substr(at, end - at));
    }
    return hashes;
}

/// What git makes of the subject of a commit that it reverts: again, of a revert, it is Reapply.
bool is_reverted_subject(std::string_view revert, std::string_view subject) {
    constexpr std::string_view kRevert = "Revert \"", kReapply = "Reapply \"";
    if (!revert.ends_with('"')) return false;
    revert.remove_suffix(1);
    if (revert.starts_with(kRevert)) return revert.substr(kRevert.size()) == subject;
    return revert.starts_with(kReapply) && subject.starts_with(kRevert) && subject.ends_with('"') &&
           revert.substr(kReapply.size()) ==
               subject.substr(kRevert.size(), subject.size() - kRevert.size() - 1);
}

bool is_revert(const TaggedCommit& commit) {
    const std::string_view subject = subject_of(commit);
    return subject.starts_with("Revert \"") || subject.starts_with("Reapply \"") ||
           !hashes_after(commit.message, "This reverts commit ").empty();
}

/// The hashes of those of the first `count` commits that one of `hashes` abbreviates, and of their ancestors.
std::set<std::string> with_ancestors(const std::vector<TaggedCommit>& commits, std::size_t count,
                                     const std::vector<std::string>& hashes) {
    std::set<std::string> found;
    for (std::size_t i = count; i-- > 0;) {
        const TaggedCommit& commit = commits[i];
        const auto begins = [&](const std::string& hash) { return commit.hash.starts_with(hash); };
        if (!found.contains(commit.hash) && std::ranges::none_of(hashes, begins)) continue;
        found.insert(commit.hash);
        found.insert(commit.parents.begin(), commit.parents.end());
    }
    return found;
}

/// Adds the hashes of what the commit at `index` reverts. A merge brings all that was merged with it.
void add_reverted(const std::vector<TaggedCommit>& commits, std::size_t index,
                  std::set<std::string>& reverted) {
    const TaggedCommit& revert = commits[index];
    const std::vector<std::string> named = hashes_after(revert.message, "This reverts commit ");
    const std::set<std::string> merged = with_ancestors(commits, index, named);
    const std::vector<std::string> mainline = hashes_after(revert.message, "changes made to ");
    const std::set<std::string> kept = with_ancestors(commits, index, mainline);
    for (std::size_t i = 0; i < index; ++i) {
        const TaggedCommit& commit = commits[i];
        const bool is_named = std::ranges::any_of(
            named, [&](const std::string& hash) { return commit.hash.starts_with(hash); });
        const bool is_merged =
            !mainline.empty() && merged.contains(commit.hash) && !kept.contains(commit.hash);
        if (is_named || is_merged || is_reverted_subject(subject_of(revert), subject_of(commit)))
            reverted.insert(commit.hash);
    }
}

}  // namespace

std::vector<TaggedCommit> commits_of_git(const std::filesystem::path& folder, const std::string& revisions) {
    // A commit begins with a line that begins with a NUL: no line of a message has one.
    const std::vector<std::string> log =
        lines_of_git(folder, {"log", "--reverse", "--topo-order", "--no-walk=unsorted",
                              "--format=%x00%H %P%n%an <%ae>%n%B", "--end-of-options", revisions, "--"});
    std::vector<TaggedCommit> commits;
    for (auto line = log.begin(); line != log.end();) {
        TaggedCommit& commit = commits.emplace_back();
        const std::vector<std::string_view> hashes = split(trimmed(std::string_view(*line++).substr(1)), ' ');
        commit.hash = hashes[0];
        commit.parents.assign(hashes.begin() + 1, hashes.end());
        if (line != log.end()) commit.author = *line++;
        for (; line != log.end() && !line->starts_with('\0'); ++line) commit.message += *line + '\n';
    }
    return commits;
}

std::vector<GoldenDecision> decisions_of_commits(const std::vector<TaggedCommit>& commits,
                                                 std::vector<std::string>& notes) {
    std::set<std::string> reverted;
    // From the newest on: a revert that is itself reverted reverts nothing.
    for (std::size_t i = commits.size(); i-- > 0;)
        if (is_revert(commits[i]) && !reverted.contains(commits[i].hash)) add_reverted(commits, i, reverted);
    std::vector<GoldenDecision> decisions;
    for (const TaggedCommit& commit : commits) {
        std::vector<GoldenDecision> own = decisions_of_message(commit.message, commit.author);
        if (own.empty()) continue;
        const std::string which = "commit " + commit.hash.substr(0, kShortestHash);
        if (is_revert(commit))
            notes.push_back(which +
                            " is a revert, which may quote another's tags: its tags do not count "
                            "(write them in a commit of their own)");
        else if (reverted.contains(commit.hash))
            notes.push_back(which + " is reverted by a later commit: its tags do not count");
        else std::ranges::move(own, std::back_inserter(decisions));
    }
    return decisions;
}

std::vector<std::string> lines_of_git(const std::filesystem::path& folder,
                                      const std::vector<std::string>& words) {
    WorkerCommand command;
    // A repository's own settings may name programs that a status starts, and have signatures printed among
    // commits. A status that renews the index would run a hook.
    command.arguments = {"/usr/bin/git",
                         "--literal-pathspecs",
                         "--no-optional-locks",
                         "-c",
                         "core.fsmonitor=false",
                         "-c",
                         "log.showSignature=false",
                         "-C",
                         std::filesystem::absolute(folder).string()};
    // Of `git rev-parse --local-env-vars`, which hooks have, those that lead to another repository; and those
    // that contradict literal paths.
    command.without = {"GIT_DIR",
                       "GIT_WORK_TREE",
                       "GIT_IMPLICIT_WORK_TREE",
                       "GIT_COMMON_DIR",
                       "GIT_INDEX_FILE",
                       "GIT_OBJECT_DIRECTORY",
                       "GIT_ALTERNATE_OBJECT_DIRECTORIES",
                       "GIT_CONFIG",
                       "GIT_GRAFT_FILE",
                       "GIT_SHALLOW_FILE",
                       "GIT_REPLACE_REF_BASE",
                       "GIT_PREFIX",
                       "GIT_NAMESPACE",
                       "GIT_GLOB_PATHSPECS",
                       "GIT_NOGLOB_PATHSPECS",
                       "GIT_ICASE_PATHSPECS"};
    command.arguments.insert(command.arguments.end(), words.begin(), words.end());
    command.limits.wall_time = std::chrono::seconds(10);
    std::vector<std::string> lines;
    WorkerListener listener;
    listener.on_stdout = [&](std::string_view line) { lines.emplace_back(line); };
    try {
        if (!run_worker(command, listener).succeeded()) lines.clear();
    } catch (const Error&) {
        return {};
    }
    return lines;
}

}  // namespace aftershade
