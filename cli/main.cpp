#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "aftershade/error.h"
#include "cli/compare_options.h"
#include "cli/exit_code.h"
#include "cli/first_steps.h"
#include "cli/help_formatter.h"
#include "cli/number_options.h"
#include "cli/plugin_options.h"
#include "cli/slip_hints.h"
#include "cli/verbs.h"
#include "framework/base/diagnostics.h"
#include "framework/base/memory_limit.h"
#include "framework/base/option.h"
#include "framework/base/status.h"
#include "framework/base/text.h"
#include "framework/effect/native/native_process.h"

using aftershade::ExitCode;

namespace {

/// The last word to the process that started this one, if it is a worker.
int end(int code) {
    aftershade::StatusWriter().end(code);
    return code;
}

/// CLI11 has its options by these names (tests/cli/option_names_test.cpp).
std::string command_spelling(aftershade::Option option, std::string_view value) {
    std::string text = "--" + std::string(aftershade::option_name(option));
    std::ranges::replace(text, '_', '-');
    if (option == aftershade::Option::output) text = "-o";
    return value.empty() ? text : text + " " + std::string(value);
}

int fail(ExitCode code, const char* message) {
    // Messages of documents bring their own "file:line:column: error: ".
    const bool has_place = std::string_view(message).find(": error: ") != std::string_view::npos;
    std::fprintf(stderr, "%s%s\n",
                 has_place ? "" : "aftershade: error: ", aftershade::printable_lines(message).c_str());
    return end(int(code));
}

/// At once: what libraries do at the end of a process may wait for ever after this.
[[noreturn]] void end_for_memory(const std::exception& error) {
    const int code = fail(ExitCode::memory, aftershade::out_of_memory_text(error).c_str());
    std::cout.flush();
    std::fflush(stdout);
    _exit(code);
}

/// An empty value is seldom a wish: it is the variable of a script that was never set, and would stand for
/// everything. An option that may stand without a value has an empty one then. Throws CLI::ValidationError.
void refuse_empty_values(const CLI::App& verb) {
    for (const CLI::Option* option : verb.get_options()) {
        if (option->get_items_expected_min() == 0) continue;
        for (const std::string& value : option->results())
            if (value.empty())
                throw CLI::ValidationError(option->get_name(),
                                           "the value is empty; leave the option out, or set the variable "
                                           "that it comes from");
    }
}

/// What is wrong with the first word that stands where a command is expected; "" where all name one.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
    const CLI::App* command = &app;
    for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
        const CLI::App* next = nullptr;
        std::vector<std::string> names;
        for (const CLI::App* below : command->get_subcommands([](const CLI::App*) { return true; })) {
            names.push_back(below->get_name());
            if (names.back() == argv[i]) next = below;
        }
        if (names.empty()) return "";
        if (!next)
            return "'" + std::string(argv[i]) + "' is not a command" +
                   aftershade::did_you_mean(argv[i], names,
                                            "; choose from " + aftershade::joined(names, " and "));
        command = next;
    }
    return "";
}

/// A folder for all that GL compiles: Mesa keeps LLVM's code in one of its own, unless that has been chosen
/// too.
void use_one_cache_folder(const CLI::App& verb) {
    const char* folder = std::getenv("AFTERSHADE_CACHE");
    const CLI::Option* read_only = verb.get_option_no_throw("--read-only");
    if ((read_only && read_only->count() > 0) || !folder || !*folder || std::string_view(folder) == "off")
        return;
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    constexpr int kKeepAnExistingOne = 0;
    setenv("MESA_SHADER_CACHE_DIR", std::filesystem::absolute(folder, failure).c_str(), kKeepAnExistingOne);
}

/// A stream that is closed would lend its number to the next file, which would then get what is printed.
/// Nothing can be written to the one in the place of standard output; what standard error does not take is
/// lost.
void hold_standard_streams() {
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(number, F_GETFD) < 0) open("/dev/null", number == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    const cookie_io_functions_t functions{nullptr,
                                          [](void*, const char* text, std::size_t count) {
                                              for (std::size_t done = 0; done < count;) {
                                                  const ssize_t written =
                                                      write(STDERR_FILENO, text + done, count - done);
                                                  if (written < 0 && errno != EINTR) break;
                                                  done += std::size_t(std::max<ssize_t>(written, 0));
                                              }
                                              return ssize_t(count);
                                          },
                                          nullptr, nullptr};
    // fmt::print throws where its stream takes nothing.
    if (std::FILE* const lossy = fopencookie(nullptr, "w", functions)) {
        std::setvbuf(lossy, nullptr, _IONBF, 0);
        stderr = lossy;
    }
}

bool stdout_is_whole() {
    std::cout.flush();
    return std::fflush(stdout) == 0 && std::cout && std::ferror(stdout) == 0;
}

/// What is not the program's own fault; "" where nothing says so.
std::string fault_outside(const std::exception& error) {
    constexpr int kNotUtf8 = 316;  // https://json.nlohmann.me/home/exceptions
    const auto* json = dynamic_cast<const nlohmann::json::type_error*>(&error);
    if (json && json->id == kNotUtf8)
        return "a name is not UTF-8, which JSON needs; rename the file or the option's value (" +
               std::string(error.what()) + ")";
    std::error_code absent;
    if (dynamic_cast<const std::filesystem::filesystem_error*>(&error) &&
        !std::filesystem::exists("/proc/self/exe", absent))
        return std::string("/proc is not mounted, and is needed here: ") + error.what();
    return "";
}

std::string stdout_fault(int number) {
    return std::string("standard output cannot be written: ") + std::strerror(number);
}

}  // namespace

int main(int argc, char** argv) {
    aftershade::spell_options_by(command_spelling);
    if (argc == 2 && std::string_view(argv[1]) == aftershade::cli::kNativeHostWord)
        return aftershade::serve_native_code(aftershade::kNativeDescriptor);
    hold_standard_streams();
    aftershade::prepare_for_memory_limit(int(ExitCode::memory));
    // A file above the shell's limit is then an output that cannot be written, not the end of the process.
    std::signal(SIGXFSZ, SIG_IGN);
    CLI::App app{"Run chains of GLSL effects over G-buffer captures, without a display.", "aftershade"};
    app.formatter(std::make_shared<aftershade::cli::HelpFormatter>());
    app.set_version_flag("--version", std::string("aftershade " AFTERSHADE_VERSION));
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done, 1 some frames failed, 2 wrong arguments or documents, 3 no readable frame or "
        "role, 4 no usable GL, 5 an effect failed, 6 an output could not be written, 7 out of memory, "
        "130 interrupted. compare and golden have their own.");
    std::map<CLI::App*, aftershade::cli::Verb> verbs;
    const auto add = [&](const char* name, const char* help, auto add_options) {
        CLI::App* verb = app.add_subcommand(name, help);
        verbs[verb] = add_options(*verb);
    };
#define AFTERSHADE_ADD_VERB(name, help) add(#name, help, aftershade::cli::add_##name);
    AFTERSHADE_VERBS(AFTERSHADE_ADD_VERB)
#undef AFTERSHADE_ADD_VERB
    aftershade::cli::refuse_odd_numbers(app);

    const auto keeps_idiffs_codes = [&] {
        return app.got_subcommand("compare") || app.got_subcommand("golden");
    };
    try {
        app.parse(argc, argv);
        refuse_empty_values(*app.get_subcommands().front());
        use_one_cache_folder(*app.get_subcommands().front());
    } catch (const CLI::Success& asked_for_help) {
        const int code = app.exit(asked_for_help);
        return stdout_is_whole() ? code : fail(ExitCode::output, stdout_fault(errno).c_str());
    } catch (const CLI::ParseError& error) {
        const ExitCode code = keeps_idiffs_codes() ? aftershade::cli::kCompareUsage : ExitCode::usage;
        if (const std::string fault = unknown_command(app, argc, argv); !fault.empty())
            return fail(code, fault.c_str());
        if (const CLI::App* run = app.get_subcommand("run");
            run->parsed() && aftershade::cli::print_first_steps(*run))
            return end(int(code));
        app.exit(error);
        std::vector<std::string> names;
        for (const auto& [verb, run] : verbs) names.push_back(verb->get_name());
        if (const auto hint = aftershade::cli::slip_hint({argv + 1, argv + argc}, names); !hint.empty())
            std::cerr << "hint: " << aftershade::printable(hint) << "\n";
        return end(int(code));
    }
    const auto fail_for_stdout = [&](int number) {
        constexpr ExitCode kIdiffsFileError{4};
        return fail(keeps_idiffs_codes() ? kIdiffsFileError : ExitCode::output, stdout_fault(number).c_str());
    };
    try {
        const ExitCode code = verbs.at(app.get_subcommands().front())();
        return stdout_is_whole() ? end(int(code)) : fail_for_stdout(errno);
    } catch (const aftershade::Error& error) {
        if (aftershade::is_out_of_memory(error)) end_for_memory(error);
        return fail(aftershade::cli::exit_code_of(error), error.what());
    } catch (const aftershade::host::Error& error) {
        if (error.kind() == aftershade::host::ErrorKind::memory) end_for_memory(std::bad_alloc());
        return fail(aftershade::cli::exit_code_of(error.kind()), error.what());
    } catch (const std::exception& error) {
        if (aftershade::is_out_of_memory(error)) end_for_memory(error);
        // So fmt::print reports a stream that takes nothing.
        const auto* system = dynamic_cast<const std::system_error*>(&error);
        if (system && std::ferror(stdout)) return fail_for_stdout(system->code().value());
        if (const std::string fault = fault_outside(error); !fault.empty())
            return fail(keeps_idiffs_codes() ? aftershade::cli::kCompareUsage : ExitCode::usage,
                        fault.c_str());
        return fail(
            ExitCode::effect,
            (std::string("a fault of the program itself: ") + error.what() + "; please report it").c_str());
    }
}
