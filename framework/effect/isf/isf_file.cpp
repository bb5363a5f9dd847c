#include "framework/effect/isf/isf_file.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/path_bounds.h"
#include "framework/base/text.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/isf/isf_document.h"
#include "framework/effect/isf/isf_text.h"
#include "framework/effect/shader_source.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// The first comment that begins with a brace: the bytes between its ends. npos: there is none.
std::pair<std::size_t, std::size_t> find_json(const std::string& text) {
    for (std::size_t at = 0; (at = text.find('/', at)) != std::string::npos;) {
        if (text.compare(at, 2, "//") == 0) at = text.find('\n', at);
        if (at == std::string::npos) break;
        if (text.compare(at, 2, "/*") != 0) {
            ++at;
            continue;
        }
        const std::size_t begin = at + 2, end = text.find("*/", begin);
        if (const std::size_t first = text.find_first_not_of(" \t\r\n", begin);
            first != std::string::npos && text[first] == '{')
            return {begin, end};
        if (end == std::string::npos) break;
        at = end + 2;
    }
    return {std::string::npos, std::string::npos};
}

/// Lone carriage returns end lines, too, and a byte order mark is a blank wherever it stands.
std::string as_document(std::string text) {
    for (std::size_t at = 0; (at = text.find("\xEF\xBB\xBF", at)) != std::string::npos;)
        text.replace(at, 3, 3, ' ');
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n')) text[i] = '\n';
    return text;
}

/// Hosts take a comma before a closing bracket. A blank in its place keeps the columns.
void blank_last_commas(std::string& json) {
    std::size_t comma = std::string::npos;
    bool is_in_text = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (is_in_text) {
            if (c == '\\') ++i;
            is_in_text = c != '"';
            continue;
        }
        if (json.compare(i, 2, "//") == 0) i = std::min(json.find('\n', i), json.size());
        else if (!std::isspace(static_cast<unsigned char>(c))) {
            if ((c == ']' || c == '}') && comma != std::string::npos) json[comma] = ' ';
            comma = c == ',' ? i : std::string::npos;
            is_in_text = c == '"';
        }
    }
}

ShaderSource source_of(const std::string& text, const std::string& path) {
    ShaderSource source{text, {}};
    for (int line = 1; line <= 1 + std::ranges::count(text, '\n'); ++line)
        source.lines.push_back({path, line});
    return source;
}

/// What only a vertex shader can fill: "varying vec2 at;", in later GLSL "in vec2 at;". One that nothing
/// reads needs no value.
std::optional<Place> place_of_varying(const IsfFile& file) {
    const ShaderSource source = source_of(file.text, file.path.string());
    const std::vector<Token> tokens = glsl_tokens(source);
    std::vector<const Token*> declared;
    std::set<std::string_view> read;
    int depth = 0;
    for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
        const std::string_view token = tokens[i].text;
        if (token == "(" || token == "{") ++depth;
        if (token == ")" || token == "}") --depth;
        const bool is_varying = token == "varying" || (token == "in" && depth == 0);
        if (!is_varying) read.insert(token);
        else
            for (++i; i + 1 < tokens.size() && tokens[i].text != ";"; ++i)
                if (const std::string_view next = tokens[i + 1].text;
                    tokens[i].is_word() && (next == "," || next == ";" || next == "["))
                    declared.push_back(&tokens[i]);
    }
    for (const Token* token : declared)
        if (read.contains(token->text) && !IsfTexts::is_of_isf(token->text)) return token->place();
    return std::nullopt;
}

/// A shader has one function main. A macro or a comment of its name is none. `begin`: of the shader in its
/// file.
void check_main(const std::string& file, const Place& begin, Diagnostics& diagnostics) {
    const ShaderSource source = source_of(file, begin.file);
    const std::vector<Token> tokens = glsl_tokens(source);
    const Token* other = nullptr;
    const auto text = [&](std::size_t i) { return i < tokens.size() ? tokens[i].text : ""; };
    for (std::size_t i = 1; i < tokens.size(); ++i) {
        if (tokens[i].text != "main") continue;
        const bool is_in_macro = std::ranges::any_of(tokens, [&](const Token& token) {
            return token.line == tokens[i].line && token.text == "define";
        });
        if (is_in_macro && text(i - 1) != "define") return;
        if (is_in_macro)
            return diagnostics.error(tokens[i].place(),
                                     "main is a macro here, so that the shader has no main() "
                                     "(give the macro another name)");
        if (text(i + 1) != "(" || !tokens[i - 1].may_be_type()) continue;
        const std::size_t close = i + (text(i + 2) == "void" ? 3 : 2);
        if (text(i - 1) == "void" && text(close) == ")") return;
        if (!other) other = &tokens[i];
    }
    if (other)
        diagnostics.error(other->place(),
                          "main() takes nothing and returns nothing (write it as void main())");
    else diagnostics.error(begin, "the shader has no main()");
}

/// Pictures from elsewhere are the manifest's fault.
void check_import(const IsfImport& import, const fs::path& folder, Diagnostics& diagnostics) {
    const fs::path picture(import.path);
    const bool is_elsewhere = picture.is_absolute() || *picture.lexically_normal().begin() == "..";
    std::error_code failure;
    if (!is_elsewhere && !fs::exists(folder / picture, failure))
        diagnostics.error(import.place, "the import '" + import.label + "' names '" +
                                            import.path.substr(0, 200) +
                                            "', which is not beside the file (copy it there)");
}

/// The file's name with .vs; "": there is none.
fs::path vertex_path(fs::path path) {
    std::error_code failure;
    for (const char* ending : {".vs", ".VS", ".Vs", ".vS"})
        if (fs::exists(path.replace_extension(ending), failure)) return path;
    return {};
}

}  // namespace

std::optional<IsfFile> parse_isf(const fs::path& path, std::string text, Diagnostics& diagnostics) {
    IsfFile file;
    file.path = path;
    file.written_text = std::move(text);
    file.text = as_document(file.written_text);
    const int errors_before = diagnostics.error_count();
    const auto [begin, end] = find_json(file.text);
    const auto line_at = [&](std::size_t at) {
        return 1 + int(std::count(file.text.begin(), file.text.begin() + std::ptrdiff_t(at), '\n'));
    };
    if (begin == std::string::npos || end == std::string::npos) {
        diagnostics.error(
            {path.string(), begin == std::string::npos ? 1 : line_at(begin), 1},
            begin == std::string::npos
                ? "an ISF file begins with a comment that holds its JSON, /*{ ... }*/, and this "
                  "one has none"
                : "the comment with the JSON is not closed: */ is missing");
        return std::nullopt;
    }
    // Blanks in the place of what is before keep its lines and columns; hosts take tabs within texts.
    std::string blanked = file.text.substr(0, end);
    std::ranges::replace(blanked, '\r', ' ');
    blanked = printable_lines(blanked);
    for (std::size_t i = 0; i < blanked.size(); ++i)
        if (blanked[i] == '\t' || (i < begin && blanked[i] != '\n')) blanked[i] = ' ';
    blank_last_commas(blanked);
    if (const auto document = parse_document(blanked, path.string(), diagnostics, SameKeys::keep_last)) {
        read_isf_document(*document, file, diagnostics);
        check_main(file.text, {path.string(), line_at(end), 1}, diagnostics);
    }
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return file;
}

std::optional<IsfFile> read_isf(const fs::path& path, Diagnostics& diagnostics) {
    const auto read = [&](const fs::path& file) -> std::optional<std::string> {
        std::string fault = out_of_bounds(file, file.parent_path());
        std::string text;
        if (fault.empty()) text = read_regular_file(file, kMaxShaderFileBytes, fault);
        Place place{file.string()};
        if (const std::size_t nul = text.find('\0'); fault.empty() && nul != std::string::npos) {
            fault = "a NUL byte: an ISF file is text (remove it)";
            place.line = 1 + int(std::ranges::count(as_document(text.substr(0, nul)), '\n'));
            place.column = 1;
        }
        if (fault.empty()) return text;
        diagnostics.error(place, fault);
        return std::nullopt;
    };
    diagnostics.note_document(path);
    if (path.filename().string().find('"') != std::string::npos ||
        path.filename().string().starts_with('.')) {
        diagnostics.error({path.string()},
                          "the name of an ISF file has no quotation mark and does not begin with "
                          "a dot (rename it)");
        return std::nullopt;
    }
    auto text = read(path);
    auto file = text ? parse_isf(path, std::move(*text), diagnostics) : std::nullopt;
    if (!file) return std::nullopt;
    const int errors_before = diagnostics.error_count();
    for (const IsfImport& import : file->imports) check_import(import, path.parent_path(), diagnostics);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    const fs::path vertex = vertex_path(path);
    if (vertex.empty()) {
        if (const auto varying = place_of_varying(*file)) {
            diagnostics.error(*varying, "the shader has a varying, but there is no vertex shader '" +
                                            fs::path(path).replace_extension(".vs").filename().string() +
                                            "' that would set it");
            return std::nullopt;
        }
        return file;
    }
    auto vertex_text = read(vertex);
    if (!vertex_text) return std::nullopt;
    file->vertex_file = vertex.filename().string();
    file->vertex_text = as_document(*vertex_text);
    file->written_vertex_text = std::move(*vertex_text);
    check_main(file->vertex_text, {vertex.string(), 1, 1}, diagnostics);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return file;
}

}  // namespace aftershade
