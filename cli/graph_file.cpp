#include "cli/graph_file.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "framework/base/atomic_file.h"
#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/base/side_file.h"

namespace aftershade::cli {

namespace {

constexpr const char* kNeedsDot =
    "an .svg needs Graphviz's 'dot' (Debian package graphviz); write a .dot instead";

void run_dot(const std::string& dot_file, const std::string& svg_file) {
    std::string name = "dot", type = "-Tsvg", output = "-o" + svg_file, input = dot_file;
    char* arguments[] = {name.data(), type.data(), output.data(), input.data(), nullptr};
    pid_t child = 0;
    int status = 0;
    if (posix_spawnp(&child, "dot", nullptr, nullptr, arguments, environ) != 0 ||
        waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Error(ErrorKind::output, std::string("--graph: ") + kNeedsDot);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw Error(ErrorKind::output, path.string() + ": cannot be written");
}

}  // namespace

void require_graph_writer(const std::string& path) {
    if (path.ends_with(".svg") && program_on_path("dot").empty())
        throw Error(ErrorKind::output, "--graph " + path + ": " + kNeedsDot);
}

void write_graph(const std::string& path, const std::string& dot) {
    if (!path.ends_with(".svg")) return write_text_file(path, dot);
    AtomicFile picture(path);
    const std::filesystem::path file(path + ".dot");
    const AtomicFile source(path_below(file.parent_path(), file.filename()));  // never committed, so it goes
    write_text(source.temporary_path(), dot);
    run_dot(source.temporary_path().string(), picture.temporary_path().string());
    picture.commit();
}

}  // namespace aftershade::cli
