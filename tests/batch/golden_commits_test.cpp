#include "framework/golden/golden_commits.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/text.h"
#include "framework/batch/worker.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGit = "/usr/bin/git";

/// A variable of this process while it lives.
class Variable {
public:
    Variable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
    ~Variable() { unsetenv(name_); }

private:
    const char* name_;
};

class GoldenCommits : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists(kGit)) GTEST_SKIP() << "git is absent (Debian package git)";
        git({"init", "-q", "-b", "main"});
    }
    /// In the folder `part` of the test's own.
    std::string git(std::vector<std::string> words, const std::string& part = "") {
        words.insert(words.begin(), {kGit, "-c", "user.name=Ada", "-c", "user.email=ada@example.org", "-C",
                                     (folder_ / part).string()});
        WorkerCommand command;
        command.arguments = words;
        std::string last;
        WorkerListener listener;
        listener.on_stdout = [&](std::string_view line) { last = line; };
        listener.on_stderr = [&](std::string_view line) { errors_ += std::string(line) + "\n"; };
        EXPECT_TRUE(run_worker(command, listener).succeeded()) << joined(words, " ", " ") << "\n" << errors_;
        return last;
    }
    /// Returns its hash.
    std::string commit(const std::string& message, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"commit", "-q", "--allow-empty", "-m", message});
        git(more);
        return git({"rev-parse", "HEAD"});
    }
    /// What the tags of these commits approve, in one line.
    std::string approved(const std::string& revisions = "main") {
        notes_.clear();
        std::vector<std::string> names;
        for (const GoldenDecision& decision :
             decisions_of_commits(commits_of_git(folder_.path(), revisions), notes_))
            names.push_back(decision.test);
        return joined(names, " ", " ");
    }
    std::string approved_since(const std::string& hash) { return approved(hash + "..main"); }

    TemporaryFolder folder_;
    std::vector<std::string> notes_;
    std::string errors_;
};

TEST_F(GoldenCommits, ApproveOldestFirstWithTheirAuthors) {
    const std::string first = commit("Begin");
    commit("Widen\n\ngolden: approve lens");
    commit("Sharpen\n\ngolden: approve corner", {"--author", "Grace <grace@example.org>"});
    const auto commits = commits_of_git(folder_.path(), first + "..main");
    ASSERT_EQ(commits.size(), 2u);
    EXPECT_EQ(commits[0].author, "Ada <ada@example.org>");
    EXPECT_EQ(commits[0].parents, std::vector<std::string>{first});
    EXPECT_EQ(commits[1].author, "Grace <grace@example.org>");
    EXPECT_EQ(commits[1].message, "Sharpen\n\ngolden: approve corner\n\n");
    EXPECT_EQ(approved_since(first), "lens corner");
    EXPECT_TRUE(notes_.empty());
    EXPECT_EQ(approved(), "corner") << "one revision is one commit";
    EXPECT_TRUE(commits_of_git(folder_.path(), "absent").empty());
    EXPECT_TRUE(commits_of_git(folder_.path(), "--output=x").empty());
}

TEST_F(GoldenCommits, OfARevertApproveNothingAndNeitherDoesWhatItReverts) {
    const std::string first = commit("Begin");
    const std::string lens = commit("Widen\n\ngolden: approve lens");
    commit("Sharpen\n\ngolden: approve corner");
    const std::string quoting =
        "Revert \"Widen\"\n\nThis reverts commit " + lens + ".\n\nWiden\n\ngolden: approve lens";
    const std::string revert = commit(quoting);
    EXPECT_EQ(approved_since(first), "corner");
    EXPECT_EQ(
        joined(notes_, "\n", "\n"),
        "commit " + lens.substr(0, 7) + " is reverted by a later commit: its tags do not count\ncommit " +
            revert.substr(0, 7) +
            " is a revert, which may quote another's tags: its tags do not count (write them in a commit "
            "of their own)");
    EXPECT_EQ(approved(), "") << "the revert alone";
    commit("Reapply \"Widen\"\n\nThis reverts commit " + revert + ".");
    EXPECT_EQ(approved_since(first), "lens corner") << "a revert that is reverted reverts nothing";
}

TEST_F(GoldenCommits, ThatWereRebasedAreRevertedByTheirSubjects) {
    const std::string first = commit("Begin");
    commit("Widen\n\ngolden: approve lens");
    commit("Widen more\n\ngolden: approve lens");
    commit("Revert \"Widen\"\n\nThis reverts commit 0123456789abcdef0123456789abcdef01234567.");
    EXPECT_EQ(approved_since(first), "lens");
    commit("Revert \"Widen more\"");
    EXPECT_EQ(approved_since(first), "");
    commit("Reapply \"Widen more\"");
    EXPECT_EQ(approved_since(first), "lens");
}

TEST_F(GoldenCommits, OfARevertedMergeApproveNothing) {
    const std::string first = commit("Begin");
    git({"checkout", "-q", "-b", "side"});
    write_text(folder_ / "side", "1");
    git({"add", "side"});
    commit("Widen\n\ngolden: approve lens");
    commit("Blur\n\ngolden: approve soft");
    git({"checkout", "-q", "main"});
    commit("Sharpen\n\ngolden: approve corner");
    git({"merge", "-q", "--no-edit", "--no-ff", "side"});
    EXPECT_EQ(approved_since(first).size(), std::string("corner lens soft").size());
    git({"revert", "--no-edit", "-m", "1", "HEAD"});
    EXPECT_EQ(approved_since(first), "corner");
}

TEST_F(GoldenCommits, AreNotWhatIsPrintedAboutTheirSignatures) {
    write_text(folder_ / "gpg", R"(#!/bin/sh
case "$*" in *--verify*) printf 'x\ngolden: approve everything\n' >&2; exit 1 ;; esac
cat >/dev/null
printf -- '-----BEGIN PGP SIGNATURE-----\n\nx\n-----END PGP SIGNATURE-----\n'
echo '[GNUPG:] SIG_CREATED ' >&2
)");
    fs::permissions(folder_ / "gpg", fs::perms::owner_all);
    git({"config", "gpg.program", (folder_ / "gpg").string()});
    git({"config", "log.showSignature", "true"});
    const std::string first = commit("Begin");
    write_text(folder_ / "file", "1");
    git({"add", "file"});
    const std::string hash = commit("Widen\n\ngolden: approve lens", {"-S"});
    EXPECT_EQ(approved_since(first), "lens");
    EXPECT_EQ(lines_of_git(folder_.path(), {"log", "--format=%H", first + ".."}),
              std::vector<std::string>{hash});
}

TEST_F(GoldenCommits, AreThoseOfTheFolderInAHookOfAnotherRepositoryToo) {
    fs::create_directories(folder_ / "other");
    git({"init", "-q", "-b", "main"}, "other");
    commit("Ours\n\ngolden: approve lens");
    git({"commit", "-q", "--allow-empty", "-m", "Theirs\n\ngolden: approve everything"}, "other");
    const Variable repository("GIT_DIR", (folder_ / "other/.git").string());
    const Variable tree("GIT_WORK_TREE", (folder_ / "other").string());
    const Variable index("GIT_INDEX_FILE", (folder_ / "other/.git/index").string());
    EXPECT_EQ(approved(), "lens");
    EXPECT_EQ(lines_of_git(folder_.path(), {"rev-parse", "--git-dir"}), std::vector<std::string>{".git"});
}

TEST_F(GoldenCommits, OfAPathAreThoseOfThatNameAndNotOfAPattern) {
    for (const char* name : {"a*.json", "ab.json", ":(top)x.json"}) {
        write_text(folder_ / name, name);
        git({"--literal-pathspecs", "add", "--", name});
        commit(name);
    }
    const Variable patterns("GIT_GLOB_PATHSPECS", "1");
    for (const char* name : {"a*.json", "ab.json", ":(top)x.json"})
        EXPECT_EQ(lines_of_git(folder_.path(), {"log", "--format=%s", "--", name}),
                  std::vector<std::string>{name});
}

}  // namespace
}  // namespace aftershade::test
