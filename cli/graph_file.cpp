#include "cli/graph_file.h"

#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>

#include "framework/core/atomic_file.h"
#include "framework/core/error.h"

extern char** environ;

namespace aftershade::cli {

namespace {

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
