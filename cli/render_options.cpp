#include "cli/render_options.h"

#include <CLI/CLI.hpp>
#include <spawn.h>
#include <sys/wait.h>

#include <charconv>
#include <fstream>

#include "framework/core/atomic_file.h"
#include "framework/core/error.h"

extern char** environ;

namespace aftershade::cli {

namespace {

/// The n of "1/n", "1" or a decimal such as "0.5" that is one.
int parse_scale(const std::string& text) {
    constexpr int kMost = 64;
    for (int n = 1; n <= kMost; ++n)
        if (text == "1/" + std::to_string(n)) return n;
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size() || value <= 0 || value > 1) return 0;
    const int n = int(1 / value + 0.5);
    return n <= kMost && std::abs(value * n - 1) < 1e-9 ? n : 0;
}

/// "x,y,w,h" as a window.
std::optional<Window> parse_region(const std::string& text) {
    int numbers[4] = {0, 0, 0, 0};
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (int i = 0; i < 4; ++i) {
        const auto [next, failure] = std::from_chars(at, end, numbers[i]);
        if (failure != std::errc{}) return std::nullopt;
        at = next;
        if (i < 3 && (at == end || *at++ != ',')) return std::nullopt;
    }
    if (at != end || numbers[2] < 1 || numbers[3] < 1) return std::nullopt;
    return Window{numbers[0], numbers[1], numbers[0] + numbers[2] - 1, numbers[1] + numbers[3] - 1};
}

void run_dot(const std::string& dot_file, const std::string& svg_file) {
    std::string name = "dot", type = "-Tsvg", output = "-o" + svg_file, input = dot_file;
    char* arguments[] = {name.data(), type.data(), output.data(), input.data(), nullptr};
    pid_t child = 0;
    int status = 0;
    if (posix_spawnp(&child, "dot", nullptr, nullptr, arguments, environ) != 0 ||
        waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Error(ExitCode::output,
                    "--graph: an .svg needs Graphviz's 'dot' (Debian package graphviz); write "
                    "a .dot instead");
}

}  // namespace

void add_render_options(CLI::App& app, RenderOptions& options) {
    app.add_option("--var", options.variables, "name=value, above the look's own \"vars\"; repeatable")
        ->allow_extra_args(false);
    app.add_option("--scale", options.scale, "Render at 1/n of the size; values in px scale along")
        ->capture_default_str();
    app.add_option("--region", options.region, "x,y,w,h: only these px of the display window, at full scale");
    app.add_option("--region-margin", options.region_margin_px,
                   "px rendered around the region for effects that look around; not written")
        ->check(CLI::Range(0, 16384))
        ->capture_default_str();
    app.add_option("--history-in", options.history_in,
                   "Go on from the history that a run over the frames before wrote");
    app.add_option("--history-out", options.history_out,
                   "Write the history after the last frame, for the next chunk of the sequence");
    app.add_option("--graph", options.graph, "Draw the frame graph of the last frame: .dot or .svg");
}

LookVariables parse_variables(const RenderOptions& options, Diagnostics& diagnostics) {
    LookVariables variables;
    for (const std::string& text : options.variables) {
        const Place place{"--var " + text};
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            diagnostics.error(place, "expected name=value");
            continue;
        }
        if (!variables.emplace(text.substr(0, equals), parse_command_value(text.substr(equals + 1), place))
                 .second)
            diagnostics.error(place, "this variable is given twice");
    }
    return variables;
}

void apply_render_options(const RenderOptions& options, RunOptions& run, Diagnostics& diagnostics) {
    run.scale_divisor = parse_scale(options.scale);
    if (run.scale_divisor == 0) {
        diagnostics.error({"--scale " + options.scale}, "must be 1, 1/2, 1/3 ... or 1/64");
        run.scale_divisor = 1;
    }
    run.region_margin_px = options.region_margin_px;
    if (!options.region.empty()) {
        run.region = parse_region(options.region);
        if (!run.region)
            diagnostics.error({"--region " + options.region},
                              "must be x,y,w,h in px from the display window's top left, w and h at least 1");
    }
    run.history_in = options.history_in;
    run.history_out = options.history_out;
    if (!options.graph.empty() && !options.graph.ends_with(".dot") && !options.graph.ends_with(".svg"))
        diagnostics.error({"--graph " + options.graph}, "must end in .dot or .svg");
}

bool changes_window(const RenderOptions& options) {
    return parse_scale(options.scale) != 1 || !options.region.empty();
}

void write_graph(const std::string& path, const std::string& dot) {
    AtomicFile file(path);
    const bool is_svg = path.ends_with(".svg");
    const std::string dot_file = file.temporary_path().string() + (is_svg ? ".dot" : "");
    std::ofstream out(dot_file, std::ios::binary);
    out << dot;
    out.close();
    if (!out) throw Error(ExitCode::output, path + ": cannot be written");
    if (is_svg) {
        struct Removal {
            std::string file;
            ~Removal() {
                std::error_code failure;
                std::filesystem::remove(file, failure);
            }
        } const removal{dot_file};
        run_dot(dot_file, file.temporary_path().string());
    }
    file.commit();
}

}  // namespace aftershade::cli
