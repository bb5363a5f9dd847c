#include "framework/effect/glsl_tokens.h"

#include <string_view>
#include <utility>

namespace aftershade {

namespace {

class Tokens {
public:
    explicit Tokens(const ShaderSource& source) {
        std::size_t begin = 0;
        for (const SourceLine& line : source.lines) {
            const std::size_t end = source.text.find('\n', begin);
            if (line.file != "<generated>")
                add_line(std::string_view(source.text).substr(begin, end - begin), line);
            begin = end + 1;
        }
    }
    std::vector<Token> take() { return std::move(tokens_); }

private:
    void add_line(std::string_view text, const SourceLine& line) {
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
                at = add_token(text, at, {line.file, line.line, int(at) + 1});
            }
        }
    }

    std::size_t add_token(std::string_view text, std::size_t at, Place place) {
        const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
        std::size_t end = at + 1;
        // A number takes its letters along: 1e5, 0xff, 2u.
        while (is_part(text[at]) && end < text.size() && is_part(text[end])) ++end;
        if (!std::isspace(static_cast<unsigned char>(text[at])))
            tokens_.push_back({std::string(text.substr(at, end - at)), std::move(place)});
        return end;
    }

    std::vector<Token> tokens_;
    bool in_comment_ = false;
};

}  // namespace

std::vector<Token> glsl_tokens(const ShaderSource& source) {
    return Tokens(source).take();
}

}  // namespace aftershade
