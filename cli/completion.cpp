#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

#include "cli/shell_completion.h"
#include "cli/verbs.h"

namespace aftershade::cli {

Verb add_completion(CLI::App& app) {
    auto shell = std::make_shared<std::string>();
    app.add_option("shell", *shell, "bash, zsh or fish")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    app.footer(
        "bash: source <(aftershade completion bash)\n"
        "zsh:  source <(aftershade completion zsh), after compinit\n"
        "fish: aftershade completion fish | source");
    return [shell, &app] {
        const Command root = command_tree(*app.get_parent());
        const std::string script = *shell == "bash"  ? bash_completion(root)
                                   : *shell == "zsh" ? zsh_completion(root)
                                                     : fish_completion(root);
        std::fwrite(script.data(), 1, script.size(), stdout);
        return ExitCode::done;
    };
}

}  // namespace aftershade::cli
