// The text of a shader with the author's lines, and its words, as far as checks by text need them.
#pragma once

#include <cctype>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/glsl_text.h"

namespace aftershade {

/// A name that many lines share: a shader with its includes has thousands. [safe to copy between threads]
class FileName {
public:
    FileName(std::string name) : name_(std::make_shared<const std::string>(std::move(name))) {}
    FileName(const char* name) : FileName(std::string(name)) {}
    const std::string& text() const { return *name_; }

private:
    std::shared_ptr<const std::string> name_;
};

struct SourceLine {
    FileName file;  ///< "<generated>" for the host's own lines
    int line = 0;
};

struct ShaderSource {
    std::string text;
    std::vector<SourceLine> lines;  ///< of text, from its first
};

/// A word of a shader, or one character of anything else: a view of a source, which must outlive it.
struct Token {
    std::string_view text;
    const std::string* file = nullptr;  ///< of its line
    int line = 0, column = 0;
    Place place() const { return {*file, line, column}; }
    bool is_word() const { return std::isalpha(static_cast<unsigned char>(text[0])) || text[0] == '_'; }
    /// Whether a name behind it may be declared, as in "float x": a word, and none that a statement follows.
    bool may_be_type() const { return is_word() && text != "return" && text != "else" && text != "do"; }
};

/// What the author wrote, without comments and without the host's own lines.
std::vector<Token> glsl_tokens(const ShaderSource& source);
std::vector<Token> glsl_tokens(ShaderSource&&) = delete;
/// The same with the host's own lines; every token's place is its line in the source's text.
std::vector<Token> all_glsl_tokens(const ShaderSource& source);
std::vector<Token> all_glsl_tokens(ShaderSource&&) = delete;

/// Whether one of them stands outside of comments, in the host's lines too. Looks no further than the first.
bool has_any_word(const ShaderSource& source, std::initializer_list<std::string_view> words);

/// How many braces are open, for a walk from token to token. The branches of an #if may each open what is
/// closed behind all of them.
class BraceDepth {
public:
    int value() const { return depth_; }
    void open() { ++depth_; }
    void close() { --depth_; }
    /// The word behind a "#".
    void pass_directive(std::string_view kind);

private:
    int depth_ = 0;
    std::vector<int> at_ifs_;  // at each open #if
};

/// As the bounds of shader_source.h.
inline constexpr std::size_t kMaxShaderTerms =
    10'000;  ///< operators between two brackets, commas or semicolons
inline constexpr std::size_t kMaxShaderArrayElements = 65'536;  ///< where the size is written as a number

/// Holds what the author wrote against kMaxShaderTerms and kMaxShaderArrayElements. What macros make of it is
/// not seen here.
void check_shader_size(const ShaderSource& source, Diagnostics& diagnostics);

/// "tile_list" -> "TileListBuffer": the storage block of a buffer.
inline std::string storage_block_name(const std::string& name) {
    return camel_case(name) + "Buffer";
}

}  // namespace aftershade
