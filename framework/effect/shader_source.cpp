#include "framework/effect/shader_source.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/path_bounds.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/isf/isf_types.h"

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

bool is_version_directive(std::string_view line) {
    const auto is_part = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return take_directive(line, "version") && (line.empty() || !is_part(static_cast<unsigned char>(line[0])));
}

/// Expands includes into one text and remembers where each line came from: Mesa keeps the line of #line but
/// always prints source string 0, so a table of our own is the only way back.
class Assembler {
public:
    Assembler(const ShaderContext& context, Diagnostics& diagnostics, ShaderFile file)
        : context_(context),
          diagnostics_(diagnostics),
          file_(file),
          texts_(context.texts ? *context.texts : own_texts_) {}

    ShaderSource assemble() {
        const fs::path file = shader_path(*context_.pass, file_, context_.glsl_folder);
        add_file(file, Place{file.string()});
        if (!has_version_ || !has_pass_)
            diagnostics_.error({file.string(), 1, 1},
                               "a shader begins with '#version 450 core' and then has '#include <pass>'");
        check_shader_size(source_, diagnostics_);
        return std::move(source_);
    }

    /// Without the host's lines.
    ShaderSource author_text() {
        has_interface_ = false;
        const fs::path file = shader_path(*context_.pass, file_, context_.glsl_folder);
        add_file(file, Place{file.string()});
        return std::move(source_);
    }

private:
    void add_line(std::string_view text, const FileName& file, int line) {
        if (is_too_large_) return;
        if (source_.lines.size() == kMaxShaderLines || source_.text.size() + text.size() >= kMaxShaderBytes) {
            is_too_large_ = true;
            diagnostics_.error({file.text(), line, 1},
                               "with its includes the shader has more than " +
                                   std::to_string(kMaxShaderLines) + " lines or " +
                                   std::to_string(kMaxShaderBytes) +
                                   " bytes, which is the limit (split the work into several passes)");
            return;
        }
        source_.text += text;
        source_.text += '\n';
        source_.lines.push_back({file, line});
    }

    void add_file(const fs::path& file, const Place& from) {
        if (!included_.insert(file).second) return;
        if (const std::string* text = context_.manifest->find_generated(file))
            return is_foreign(file.string()) ? add_text(*text, file.string(), 0)
                                             : add_text(*text, context_.manifest->document.string(), 1);
        const ShaderTexts::File& read = texts_.of(file);
        if (!read.out_of_bounds.empty()) {
            diagnostics_.error(from, file.string() + " " + read.out_of_bounds);
            return;
        }
        if (depth_ == kMaxIncludeDepth) {
            diagnostics_.error(from, "includes go deeper than " + std::to_string(kMaxIncludeDepth) +
                                         " files, which is the limit (include from fewer files)");
            return;
        }
        if (!read.fault.empty()) {
            diagnostics_.error(from, "cannot read " + file.string() +
                                         (read.fault == "no such file" ? "" : ": " + read.fault));
            return;
        }
        add_text(read.text, file.string(), 0);
    }

    /// `number` 0: the lines count from 1; else the number of each, of a text that is no file.
    void add_text(std::string_view text, const FileName& name, int number) {
        ++depth_;
        std::size_t at = 0;
        for (int line_number = 1; at < text.size() && !is_too_large_; ++line_number) {
            const std::size_t end = std::min(text.find('\n', at), text.size());
            std::string_view line = text.substr(at, end - at);
            if (line.ends_with('\r')) line.remove_suffix(1);
            add_source_line(line, name, number > 0 ? number : line_number);
            at = end + 1;
        }
        --depth_;
    }

    void add_source_line(std::string_view line, const FileName& file, int number) {
        if (const auto include = parse_include(line)) {
            add_include(include->is_shared, include->name, {file.text(), number, 1});
            return;
        }
        if (number == 1 && is_foreign(file.text()) && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
        // Files of other hosts may name the versions that they are for, and extensions that 4.50 has.
        std::string_view rest = line;
        if ((is_version_directive(line) || take_directive(rest, "extension")) && is_foreign(file.text()))
            return add_line("", file, number);
        if (is_version_directive(line)) {
            if (source_.lines.empty() && line == "#version 450 core") has_version_ = true;
            else
                diagnostics_.error({file.text(), number, 1},
                                   "'#version 450 core' must appear once, as the first line of a shader");
        }
        add_line(line, file, number);
    }

    bool is_foreign(const std::string& file) const { return is_isf_shader(file) && !source_.lines.empty(); }

    void add_include(bool shared, const std::string& name, const Place& place) {
        if (shared && name == "pass") {
            if (!std::exchange(has_pass_, true) && has_interface_)
                add_generated(interface_glsl(context_, file_), place.line);
            return;
        }
        if (shared && name == "predicate" && context_.pass->lists()) return add_predicate(place);
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

    void add_generated(const std::string& text, int line) {
        std::istringstream lines(text);
        for (std::string each; std::getline(lines, each);) add_line(each, generated_, line);
    }

    /// What glsl/host/list_tiles.comp asks of each tile.
    void add_predicate(const Place& place) {
        const TileListSpec& list = *context_.manifest->tile_list_of(*context_.pass);
        if (!list.of) add_file(list.folder / list.predicate, place);
        std::string listed = list.name + "(tile)";
        if (list.of)
            listed = "texelFetch(" + (list.has_common_text() ? kListedSampler : list.of->texture) +
                     ", tile, 0)." + "rgba"[list.of->channel] + " > 0.0";
        add_generated("bool is_listed(ivec2 tile) { return " + listed + "; }\n", place.line);
    }

    static bool is_plain_name(const std::string& name) {
        return !name.empty() && name.find('/') == std::string::npos && !name.starts_with('.');
    }

    const ShaderContext& context_;
    Diagnostics& diagnostics_;
    const ShaderFile file_;
    ShaderTexts own_texts_;
    ShaderTexts& texts_;
    ShaderSource source_;
    const FileName generated_ = "<generated>";
    std::set<fs::path> included_;
    int depth_ = 0;
    bool is_too_large_ = false;
    bool has_version_ = false;
    bool has_pass_ = false;
    bool has_interface_ = true;
};

}  // namespace

const ShaderTexts::File& ShaderTexts::of(const fs::path& file) {
    const auto [found, is_new] = files_.try_emplace(file.string());
    File& read = found->second;
    if (!is_new) return read;
    // The name is plain, but a link may lead anywhere.
    read.out_of_bounds = out_of_bounds(file, file.parent_path());
    if (read.out_of_bounds.empty()) read.text = read_regular_file(file, kMaxShaderFileBytes, read.fault);
    return read;
}

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

fs::path shader_path(const PassSpec& pass, ShaderFile file, const fs::path& glsl_folder) {
    if (pass.lists()) return glsl_folder / "host" / "list_tiles.comp";
    if (file == ShaderFile::main) return pass.folder / pass.shader;
    return pass.vertex() ? pass.folder / *pass.vertex() : glsl_folder / "host" / "tiles.vert";
}

ShaderSource assemble_shader(const ShaderContext& context, Diagnostics& diagnostics, ShaderFile file) {
    return Assembler(context, diagnostics, file).assemble();
}

ShaderSource author_text(const EffectManifest& manifest, const PassSpec& pass, const fs::path& glsl_folder,
                         Diagnostics& diagnostics, ShaderFile file, ShaderTexts* texts) {
    const ShaderContext context{&manifest, &pass, {}, {}, glsl_folder, nullptr, nullptr, texts};
    return Assembler(context, diagnostics, file).author_text();
}

}  // namespace aftershade
