#include "framework/effect/shader_source.h"

#include <cctype>
#include <set>
#include <sstream>
#include <utility>

#include "framework/core/atomic_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

void skip_spaces(std::string_view& text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
}

/// Takes "#<word>" off the front, with any spaces around the '#'.
bool take_directive(std::string_view& line, std::string_view word) {
    skip_spaces(line);
    if (!line.starts_with('#')) return false;
    line.remove_prefix(1);
    skip_spaces(line);
    if (!line.starts_with(word)) return false;
    line.remove_prefix(word.size());
    return true;
}

bool is_version(std::string_view line) {
    const auto is_part = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return take_directive(line, "version") && (line.empty() || !is_part(static_cast<unsigned char>(line[0])));
}

/// Expands includes into one text and remembers where each line came from: Mesa keeps the line of #line but
/// always prints source string 0, so a table of our own is the only way back.
class Assembler {
public:
    Assembler(const ShaderContext& context, Diagnostics& diagnostics, ShaderFile file)
        : context_(context), diagnostics_(diagnostics), file_(file) {}

    ShaderSource assemble() {
        const PassSpec& pass = *context_.pass;
        const fs::path file = pass.folder / (file_ == ShaderFile::vertex ? pass.vertex : pass.shader);
        add_file(file, Place{file.string()});
        if (!has_version_ || !has_pass_)
            diagnostics_.error({file.string(), 1, 1},
                               "a shader begins with '#version 450 core' and then has '#include <pass>'");
        return std::move(source_);
    }

private:
    void add_line(const std::string& text, const std::string& file, int line) {
        source_.text += text + "\n";
        source_.lines.push_back({file, line});
    }

    void add_file(const fs::path& file, const Place& from) {
        if (!included_.insert(file).second) return;
        std::error_code failure;
        std::istringstream in(read_text_file(file, failure));
        if (failure) {
            diagnostics_.error(from, "cannot read " + file.string());
            return;
        }
        std::string line;
        for (int number = 1; std::getline(in, line); ++number) {
            if (line.ends_with('\r')) line.pop_back();
            add_source_line(line, {file.string(), number, 1});
        }
    }

    void add_source_line(const std::string& line, const Place& place) {
        if (const auto include = parse_include(line)) {
            add_include(include->is_shared, include->name, place);
        } else if (is_version(line)) {
            if (source_.lines.empty() && line == "#version 450 core") has_version_ = true;
            else diagnostics_.error(place, "'#version 450 core' stands once, as the first line of a shader");
            add_line(line, place.file, place.line);
        } else {
            add_line(line, place.file, place.line);
        }
    }

    void add_include(bool shared, const std::string& name, const Place& place) {
        if (shared && name == "pass") {
            if (std::exchange(has_pass_, true)) return;
            std::istringstream lines(interface_glsl(context_, file_));
            for (std::string line; std::getline(lines, line);) add_line(line, "<generated>", place.line);
            return;
        }
        // A shader cannot reach outside its own folder and glsl/.
        const std::size_t slash = shared ? name.find('/') : std::string::npos;
        const bool is_plain = slash == std::string::npos ? is_plain_name(name)
                                                         : is_plain_name(name.substr(0, slash)) &&
                                                               is_plain_name(name.substr(slash + 1));
        if (!is_plain) {
            diagnostics_.error(place, "'" + name + "' is not a plain file name");
            return;
        }
        add_file((shared ? context_.glsl_folder : fs::path(place.file).parent_path()) / name, place);
    }

    static bool is_plain_name(const std::string& name) {
        return !name.empty() && name.find('/') == std::string::npos && !name.starts_with('.');
    }

    const ShaderContext& context_;
    Diagnostics& diagnostics_;
    const ShaderFile file_;
    ShaderSource source_;
    std::set<fs::path> included_;
    bool has_version_ = false;
    bool has_pass_ = false;
};

}  // namespace

std::optional<ShaderInclude> parse_include(std::string_view line) {
    if (!take_directive(line, "include")) return std::nullopt;
    skip_spaces(line);
    if (!line.starts_with('<') && !line.starts_with('"')) return std::nullopt;
    const std::size_t end = line.find_first_of("\">", 1);
    if (end == std::string_view::npos) return std::nullopt;
    ShaderInclude include{std::string(line.substr(1, end - 1)), line.front() == '<'};
    line.remove_prefix(end + 1);
    skip_spaces(line);
    return line.empty() || line.starts_with("//") ? std::optional(std::move(include)) : std::nullopt;
}

ShaderSource assemble_shader(const ShaderContext& context, Diagnostics& diagnostics, ShaderFile file) {
    return Assembler(context, diagnostics, file).assemble();
}

}  // namespace aftershade
