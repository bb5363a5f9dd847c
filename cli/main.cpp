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
    add("run", "Run a look over a capture and write the result", aftershade::cli::add_run);
    add("inspect", "Tell what a capture holds: parts, channels with their figures, roles, camera",
        aftershade::cli::add_inspect);
    add("compare", "Compare two pictures, layer by layer: how different, how visible, a verdict for scripts",
        aftershade::cli::add_compare);
    add("golden", "Render a suite of cases and compare them with approved images; approve new ones",
        aftershade::cli::add_golden);
    add("render", "Render a scene: captures, and the true pictures that effects approximate",
        aftershade::cli::add_render);
    add("list", "List the effects that there are", aftershade::cli::add_list);
    add("describe", "Tell what an effect takes, makes and can be told; what a scattering profile is",
        aftershade::cli::add_describe);
    add("new", "Make the folder of a new effect, which runs at once", aftershade::cli::add_new);
    add("check", "Check an effect or a look: documents, shaders, values; exit 1: no",
        aftershade::cli::add_check);
    add("schema", "Print the JSON Schema of looks, captures, effects, scenes or profiles, for editors",
        aftershade::cli::add_schema);
    add("docs", "Write the page of each effect from its manifest, and the scene reference",
        aftershade::cli::add_docs);
    add("doctor", "Tell which GL backends work on this machine, and why others do not",
        aftershade::cli::add_doctor);

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
