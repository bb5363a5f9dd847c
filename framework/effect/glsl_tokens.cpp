#include "framework/effect/glsl_tokens.h"

#include <cctype>
#include <string_view>
#include <utility>

#include "framework/core/units.h"

namespace aftershade {

namespace {

class Tokens {
public:
    Tokens(const ShaderSource& source, bool all) {
        constexpr std::size_t kBytesPerToken = 6;  // about, with blanks and comments
        tokens_.reserve(source.text.size() / kBytesPerToken);
        std::size_t begin = 0;
        for (std::size_t i = 0; i < source.lines.size(); ++i) {
            const SourceLine& line = source.lines[i];
            const std::size_t end = source.text.find('\n', begin);
            if (all) begin_line("", int(i) + 1);
            else if (line.file != "<generated>") begin_line(line.file, line.line);
            if (all || line.file != "<generated>")
                add_line(std::string_view(source.text).substr(begin, end - begin));
            begin = end + 1;
        }
    }
    std::vector<Token> take() { return std::move(tokens_); }

private:
    void begin_line(const std::string& file, int line) {
        if (!file_ || *file_ != file) file_ = std::make_shared<const std::string>(file);
        line_ = line;
    }

    void add_line(std::string_view text) {
        for (std::size_t at = 0; at < text.size();) {
            if (in_comment_) {
                const std::size_t end = text.find("*/", at);
                if (end == std::string_view::npos) return;
                in_comment_ = false;
                at = end + 2;
            } else if (text.substr(at, 2) == "//") {
                return;
            } else if (text.substr(at, 2) == "/*") {
                in_comment_ = true;
                at += 2;
            } else {
                at = add_token(text, at);
            }
        }
    }

    std::size_t add_token(std::string_view text, std::size_t at) {
        const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
        std::size_t end = at + 1;
        // A number takes its letters along: 1e5, 0xff, 2u.
        while (is_part(text[at]) && end < text.size() && is_part(text[end])) ++end;
        if (!std::isspace(static_cast<unsigned char>(text[at])))
            tokens_.push_back({std::string(text.substr(at, end - at)), file_, line_, int(at) + 1});
        return end;
    }

    std::vector<Token> tokens_;
    std::shared_ptr<const std::string> file_;
    int line_ = 0;
    bool in_comment_ = false;
};

}  // namespace

std::vector<Token> glsl_tokens(const ShaderSource& source) {
    return Tokens(source, false).take();
}

std::vector<Token> all_glsl_tokens(const ShaderSource& source) {
    return Tokens(source, true).take();
}

void check_shader_size(const ShaderSource& source, Diagnostics& diagnostics) {
    constexpr std::string_view kOperators = "+-*/%<>=&|^?!", kEnds = ",;{}";
    std::vector<std::size_t> terms = {0};  // of each open bracket, outermost first
    const std::vector<Token> tokens = glsl_tokens(source);
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const char c = tokens[i].text[0];
        if (c == '(' || c == '[') terms.push_back(0);
        else if ((c == ')' || c == ']') && terms.size() > 1) terms.pop_back();
        else if (kEnds.find(c) != std::string_view::npos) terms.back() = 0;
        else if (kOperators.find(c) != std::string_view::npos && ++terms.back() == kMaxShaderTerms)
            diagnostics.error(tokens[i].place(),
                              "an expression has more than " + std::to_string(kMaxShaderTerms) +
                                  " operators, which is the limit (write it as a loop, or as "
                                  "several statements)");
        // "float v[9]": an index of a buffer may be as large as it likes.
        const bool declares = c == '[' && i > 1 && i + 2 < tokens.size() && tokens[i + 2].text == "]" &&
                              tokens[i - 1].is_word() && tokens[i - 2].is_word() &&
                              tokens[i - 2].text != "return";
        if (!declares) continue;
        const auto elements = parse_number(tokens[i + 1].text);
        if (elements && *elements > double(kMaxShaderArrayElements))
            diagnostics.error(tokens[i + 1].place(), "an array of " + tokens[i + 1].text +
                                                         " elements; the limit is " +
                                                         std::to_string(kMaxShaderArrayElements) +
                                                         " (declare a buffer or a texture for more)");
    }
}

}  // namespace aftershade
