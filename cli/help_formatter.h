// What `--help` looks like: at most 100 columns, names on the left, what an option does on the right.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace aftershade::cli {

/// CLI11 2.1 wraps nothing and prints choices, limits and defaults between name and description.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_option(const CLI::Option* option, bool is_positional) const override;
    std::string make_group(std::string group, bool is_positional,
                           std::vector<const CLI::Option*> options) const override;
    std::string make_subcommand(const CLI::App* subcommand) const override;
    std::string make_usage(const CLI::App* app, std::string name) const override;
    std::string make_footer(const CLI::App* app) const override;
};

}  // namespace aftershade::cli
