// Manual pages in man(7), made from the declarations of the command line.
#pragma once

#include <map>
#include <string>

#include "cli/command_tree.h"

namespace aftershade::cli {

/// Page of section 1 for each command by its file name: "aftershade.1", "aftershade-golden-run.1". Long lines
/// of options' descriptions are left to man, which fills them.
std::map<std::string, std::string> man_pages(const Command& root, const std::string& version);

}  // namespace aftershade::cli
