#include "framework/effect/glsl_tokens.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "framework/document/units.h"

namespace aftershade {

namespace {

enum class CharKind : unsigned char { other, space, word };

constexpr std::array<CharKind, 256> kCharKinds = [] {
    std::array<CharKind, 256> kinds{};
    for (const unsigned char c : std::string_view(" \t\n\v\f\r")) kinds[c] = CharKind::space;
    for (int c = '0'; c <= '9'; ++c) kinds[std::size_t(c)] = CharKind::word;
    for (int c = 'a'; c <= 'z'; ++c)
        kinds[std::size_t(c)] = kinds[std::size_t(c - 'a' + 'A')] = CharKind::word;
    kinds['_'] = CharKind::word;
    return kinds;
}();

CharKind char_kind(char c) {
    return kCharKinds[static_cast<unsigned char>(c)];
}

const std::string kNoFile;

/// Takes a shader apart. `take` gets each token in turn; once it returns true, no other.
template <typename Take>
class Tokenizer {
public:
    Tokenizer(const ShaderSource& source, const Take& take) : source_(source), take_(take) {}

    void run(bool all) {
        std::size_t begin = 0;
        const std::string_view text = source_.text;
        for (std::size_t i = 0; i < source_.lines.size() && !is_over_; ++i) {
            const SourceLine& line = source_.lines[i];
            const std::string& file = line.file.text();
            const std::size_t end = text.find('\n', begin);
            if (all || file != "<generated>") {
                file_ = all ? &kNoFile : &file;
                line_ = all ? int(i) + 1 : line.line;
                add_line(text.substr(begin, end - begin));
            }
            begin = end + 1;
        }
    }

private:
    void add_line(std::string_view text) {
        for (std::size_t at = 0; at < text.size() && !is_over_;) {
            const char next = at + 1 < text.size() ? text[at + 1] : ' ';
            if (in_comment_) {
                const std::size_t end = text.find("*/", at);
                if (end == std::string_view::npos) return;
                in_comment_ = false;
                at = end + 2;
            } else if (text[at] == '/' && next == '/') {
                return;
            } else if (text[at] == '/' && next == '*') {
                in_comment_ = true;
                at += 2;
            } else {
                at = add_token(text, at);
            }
        }
    }

    std::size_t add_token(std::string_view text, std::size_t at) {
        const CharKind kind = char_kind(text[at]);
        std::size_t end = at + 1;
        // A number takes its letters along: 1e5, 0xff, 2u.
        while (kind == CharKind::word && end < text.size() && char_kind(text[end]) == kind) ++end;
        if (kind != CharKind::space)
            is_over_ = take_(Token{text.substr(at, end - at), file_, line_, int(at) + 1});
        return end;
    }

    const ShaderSource& source_;
    const Take& take_;
    const std::string* file_ = nullptr;
    int line_ = 0;
    bool in_comment_ = false;
    bool is_over_ = false;
};

std::vector<Token> tokens_of(const ShaderSource& source, bool all) {
    constexpr std::size_t kBytesPerToken = 6;  // about, with blanks and comments
    std::vector<Token> tokens;
    tokens.reserve(source.text.size() / kBytesPerToken);
    const auto take = [&](const Token& token) {
        tokens.push_back(token);
        return false;
    };
    Tokenizer(source, take).run(all);
    return tokens;
}

}  // namespace

std::vector<Token> glsl_tokens(const ShaderSource& source) {
    return tokens_of(source, false);
}

std::vector<Token> all_glsl_tokens(const ShaderSource& source) {
    return tokens_of(source, true);
}

bool has_any_word(const ShaderSource& source, std::initializer_list<std::string_view> words) {
    bool is_found = false;
    const auto take = [&](const Token& token) {
        return is_found = std::ranges::find(words, token.text) != words.end();
    };
    Tokenizer(source, take).run(true);
    return is_found;
}

void BraceDepth::pass_directive(std::string_view kind) {
    if (kind.starts_with("if")) at_ifs_.push_back(depth_);
    else if (kind.starts_with("el") && !at_ifs_.empty()) depth_ = at_ifs_.back();
    else if (kind == "endif" && !at_ifs_.empty()) at_ifs_.pop_back();
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
                              tokens[i - 1].is_word() && tokens[i - 2].may_be_type();
        if (!declares) continue;
        const std::string number(tokens[i + 1].text);
        const auto elements = parse_number(number);
        if (elements && *elements > double(kMaxShaderArrayElements))
            diagnostics.error(tokens[i + 1].place(), "an array of " + number + " elements; the limit is " +
                                                         std::to_string(kMaxShaderArrayElements) +
                                                         " (declare a buffer or a texture for more)");
    }
}

}  // namespace aftershade
