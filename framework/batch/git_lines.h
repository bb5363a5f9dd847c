// What git says of the folder of a suite or of a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aftershade {

/// The lines that `git -C folder WORDS` prints; none where git is absent, fails, or takes 10 s.
std::vector<std::string> lines_of_git(const std::filesystem::path& folder,
                                      const std::vector<std::string>& words);

}  // namespace aftershade
