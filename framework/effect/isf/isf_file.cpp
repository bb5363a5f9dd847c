#include "framework/effect/isf/isf_file.h"

#include <algorithm>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/path_bounds.h"
#include "framework/base/text.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/isf/isf_document.h"
#include "framework/effect/shader_source.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// The first comment that begins with a brace: the bytes between its ends. npos: there is none.
std::pair<std::size_t, std::size_t> find_json(const std::string& text) {
    for (std::size_t at = 0; (at = text.find("/*", at)) != std::string::npos;) {
        const std::size_t begin = at + 2, end = text.find("*/", begin);
        if (const std::size_t first = text.find_first_not_of(" \t\r\n", begin);
            first != std::string::npos && text[first] == '{')
            return {begin, end};
        if (end == std::string::npos) break;
        at = end + 2;
    }
    return {std::string::npos, std::string::npos};
}

/// Lone carriage returns end lines, too, and what is not UTF-8 may stand in comments.
std::string as_document(std::string text) {
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n')) text[i] = '\n';
    return text;
}

/// What only a vertex shader can fill.
std::optional<Place> place_of_varying(const IsfFile& file) {
    ShaderSource source{file.text, {}};
    for (int line = 1; line <= 1 + std::ranges::count(file.text, '\n'); ++line)
        source.lines.push_back({file.path.string(), line});
    for (const Token& token : glsl_tokens(source))
        if (token.text == "varying") return token.place();
    return std::nullopt;
}

}  // namespace

std::optional<IsfFile> parse_isf(const fs::path& path, std::string text, Diagnostics& diagnostics) {
    IsfFile file;
    file.path = path;
    file.text = as_document(std::move(text));
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
    std::string blanked = printable_lines(std::string_view(file.text).substr(0, end));
    for (std::size_t i = 0; i < blanked.size(); ++i)
        if (blanked[i] == '\t' || (i < begin && blanked[i] != '\n')) blanked[i] = ' ';
    if (const auto document = parse_document(blanked, path.string(), diagnostics)) {
        read_isf_document(*document, file, diagnostics);
        const std::string_view body = std::string_view(file.text).substr(end);
        if (body.find("main") == std::string_view::npos)
            diagnostics.error({path.string(), line_at(end), 1}, "the shader has no main()");
    }
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return file;
}

std::optional<IsfFile> read_isf(const fs::path& path, Diagnostics& diagnostics) {
    const auto read = [&](const fs::path& file) -> std::optional<std::string> {
        std::string fault = out_of_bounds(file, file.parent_path());
        std::string text;
        if (fault.empty()) text = read_regular_file(file, kMaxShaderFileBytes, fault);
        if (fault.empty()) return text;
        diagnostics.error({file.string()}, fault);
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
    fs::path vertex = path;
    vertex.replace_extension(".vs");
    std::error_code failure;
    if (!fs::exists(vertex, failure)) {
        if (const auto varying = place_of_varying(*file)) {
            diagnostics.error(*varying, "the shader has a varying, but there is no vertex shader '" +
                                            vertex.filename().string() + "' that would set it");
            return std::nullopt;
        }
        return file;
    }
    auto vertex_text = read(vertex);
    if (!vertex_text) return std::nullopt;
    file->vertex_file = vertex.filename().string();
    file->vertex_text = std::move(*vertex_text);
    return file;
}

}  // namespace aftershade
