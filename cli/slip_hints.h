// Suggestions for a command line that cannot be read.
#pragma once

#include <string>
#include <vector>

namespace aftershade::cli {

/// "options come after the command: ..."; "" where no usual slip is seen. `words` are those after the
/// program's name, `verbs` the names of the commands.
std::string slip_hint(const std::vector<std::string>& words, const std::vector<std::string>& verbs);

/// The pattern of the sequence that a frame's file name or a shell pattern belongs to: gbuffer_0003.exr and
/// gbuffer_*.exr become gbuffer_####.exr. "" where the name has neither digits nor *.
std::string frame_pattern(const std::string& name);

}  // namespace aftershade::cli
