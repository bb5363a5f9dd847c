#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <map>
#include <new>

#include "cli/compare_options.h"
#include "cli/verbs.h"

using aftershade::ExitCode;

namespace {

int fail(ExitCode code, const char* message) {
    // Messages of documents bring their own "file:line:column: error: ".
    const bool has_place = std::string_view(message).find(": error: ") != std::string_view::npos;
    std::fprintf(stderr, "%s%s\n", has_place ? "" : "aftershade: error: ", message);
    return int(code);
}

}  // namespace

int main(int argc, char** argv) {
    // A file above the shell's limit is then an output that cannot be written, not the end of the process.
    std::signal(SIGXFSZ, SIG_IGN);
    CLI::App app{"Runs chains of shader effects over G-buffer captures, without a display.", "aftershade"};
    app.set_version_flag("--version", std::string("aftershade " AFTERSHADE_VERSION));
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done, 1 some frames failed, 2 wrong words or documents, 3 no readable frame or role,\n"
        "4 no usable GL, 5 an effect failed, 6 an output could not be written, 130 interrupted; compare "
        "and golden have their own.");
    std::map<CLI::App*, aftershade::cli::Verb> verbs;
    const auto add = [&](const char* name, const char* help, auto add_options) {
        CLI::App* verb = app.add_subcommand(name, help);
        verbs[verb] = add_options(*verb);
    };
#define AFTERSHADE_ADD_VERB(name, help) add(#name, help, aftershade::cli::add_##name);
    AFTERSHADE_VERBS(AFTERSHADE_ADD_VERB)
#undef AFTERSHADE_ADD_VERB

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked_for_help) {
        return app.exit(asked_for_help);
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        const bool as_idiff = app.got_subcommand("compare") || app.got_subcommand("golden");
        return int(as_idiff ? aftershade::cli::kCompareUsage : ExitCode::usage);
    }
    try {
        return int(verbs.at(app.get_subcommands().front())());
    } catch (const aftershade::Error& error) {
        return fail(error.exit_code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::effect, "out of memory");
    } catch (const std::exception& error) {
        return fail(ExitCode::effect, error.what());
    }
}
