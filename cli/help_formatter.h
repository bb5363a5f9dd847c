// The layout of `--help`: at most 100 columns, names on the left, effects of options on the right.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace aftershade::cli {

/// Prints a command as command_tree.h describes it. CLI11's own layout differs from version to version, wraps
/// nothing up to 2.4, and prints choices, limits and defaults between name and description.
class HelpFormatter : public CLI::FormatterBase {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace aftershade::cli
