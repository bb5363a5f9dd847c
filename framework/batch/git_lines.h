// What git says of the folder of a suite or of a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aftershade {

/// The lines that `git -C folder WORDS` prints; none where git is absent, fails, or takes 10 s. Paths among
/// the words are names, never patterns. The repository is the folder's, also in a hook of another one.
std::vector<std::string> lines_of_git(const std::filesystem::path& folder,
                                      const std::vector<std::string>& words);

}  // namespace aftershade
