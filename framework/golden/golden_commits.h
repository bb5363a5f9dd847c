// The tags of commits that approve cases of a golden suite, and what else git says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/golden/golden_decisions.h"

namespace aftershade {

struct TaggedCommit {
    std::string hash;
    std::vector<std::string> parents;  ///< hashes
    std::string author;                ///< "Ada <ada@example.org>"
    std::string message;
};

/// The commits that `revisions` names to git, a child after its parents; none where there are none.
std::vector<TaggedCommit> commits_of_git(const std::filesystem::path& folder, const std::string& revisions);

/// The decisions of the commits' tags, in the order of the commits. A revert may quote the tags of what it
/// reverts, so its own do not count, nor do those of a commit that a later one reverts: by its hash, or by
/// its subject, since a rebase changes hashes. `notes` gets a line for each commit whose tags do not count.
std::vector<GoldenDecision> decisions_of_commits(const std::vector<TaggedCommit>& commits,
                                                 std::vector<std::string>& notes);

/// The lines that `git -C folder WORDS` prints; none where git is absent, fails, or takes 10 s. Paths among
/// the words are names, never patterns. The repository is the folder's, also in a hook of another one.
std::vector<std::string> lines_of_git(const std::filesystem::path& folder,
                                      const std::vector<std::string>& words);

}  // namespace aftershade
