// The program's commands and options as data, read from their declarations: man pages and completion scripts
// are made of it.
#pragma once

#include <string>
#include <vector>

#include "cli/cli11.h"

namespace aftershade::cli {

/// The type's name of options that take an effect's id, which shells complete.
inline constexpr const char* kEffectId = "EFFECT";

struct CommandOption {
    std::vector<std::string> names;    ///< "-o", "--output"; of a positional its one name, such as "look"
    std::string description;           ///< as `--help` prints it
    std::string type;                  ///< "TEXT", "INT", ...; "" for a flag
    std::string limits;                ///< what the value must keep, such as "1 to 100"; "" if anything goes
    std::vector<std::string> choices;  ///< the words that it takes, if it takes no others
    std::string default_value;         ///< "" if `--help` shows none
    std::string group;                 ///< heading in `--help`; "" under "Options"
    std::vector<std::string> needs, excludes;  ///< options that this one needs, and cannot go with
    bool positional = false;
    bool required = false;
    bool repeatable = false;

    bool takes_value() const { return !type.empty(); }
    bool is_number() const { return type == "INT" || type == "UINT" || type == "FLOAT"; }
    /// Declared by type_name(kEffectId).
    bool takes_effect_id() const { return type == kEffectId; }
};

struct Command {
    std::vector<std::string> path;  ///< {"golden", "run"}; {} for the program
    std::string description;
    std::string footer;                  ///< lines behind the options in `--help`
    std::vector<CommandOption> options;  ///< positionals first
    std::vector<Command> subcommands;
};

/// `app` and all of its subcommands; options that `--help` hides are left out.
Command command_tree(const CLI::App& app);

/// `root` and all below it, parents first.
std::vector<const Command*> all_commands(const Command& root);

/// "aftershade golden run", with `separator` between the words.
std::string command_name(const Command& command, const std::string& separator = " ");

}  // namespace aftershade::cli
