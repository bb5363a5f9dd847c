// Shaders rewritten so that they mean the same: what a compiler makes of both must draw the same bits.
//
// The idea is GraphicsFuzz's (Donaldson, Evrard, Lascu, Thomson: "Automated Testing of Graphics Shader
// Compilers", OOPSLA 2017, doi:10.1145/3133917). Only rewrites are here that keep every bit where a compiler
// keeps the order of operations: x * 1.0 is x, a function that returns its argument is its argument, a branch
// that is never taken is nothing. GLSL demands that order of `precise` variables alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/text.h"
#include "framework/effect/glsl_tokens.h"

namespace aftershade::test {

/// Which rewrites a variant makes, each at some of the places where it can.
struct Rewrites {
    bool wrap = false;      ///< return x; -> return meta_same(x); and T v = x; -> T v = x; v = meta_same(v);
    bool identity = false;  ///< float x -> x * meta_one, a uniform that is 1
    bool dead = false;      ///< if (meta_one < 0.5) return ...; at the start of a function
    bool loop = false;      ///< the body of a void function in do { } while (false)
    bool rename = false;    ///< names of locals
    bool reorder = false;   ///< neighbouring functions, and neighbouring constants of a file
    bool any() const { return wrap || identity || dead || loop || rename || reorder; }
};

inline bool is_float_type(const std::string& type) {
    return type == "float" || type == "vec2" || type == "vec3" || type == "vec4";
}
inline bool is_built_in_type(const std::string& type) {
    static const std::set<std::string> others = {"int",   "uint",  "bool",  "ivec2", "ivec3",
                                                 "ivec4", "uvec2", "uvec3", "uvec4", "bvec2",
                                                 "bvec3", "bvec4", "mat2",  "mat3"};
    return is_float_type(type) || others.contains(type);
}

/// What variants and precise texts use, once for each shader. `one` is the value of the uniform: any other is
/// a fault that must be seen.
inline std::string variant_prelude(const std::string& one) {
    std::string text = "#ifndef META_PRELUDE\n#define META_PRELUDE\nuniform float meta_one = " + one + ";\n";
    for (const char* type : {"float", "vec2", "vec3", "vec4", "int", "uint", "bool", "ivec2", "ivec3",
                             "ivec4", "uvec2", "uvec3", "uvec4", "bvec2", "bvec3", "bvec4", "mat2", "mat3"})
        text += std::string(type) + " meta_same(precise " + type + " value) { return value; }\n";
    return text + "#endif\n";
}

/// After `#include <pass>`, before which nothing may stand; of a file that is included, at its start.
inline std::string with_prelude(const std::string& text, const std::string& prelude) {
    static const std::string first = "#include <pass>";
    const std::size_t at = text.find(first);
    if (at == std::string::npos) return prelude + text;
    const std::size_t line_end = text.find('\n', at) + 1;
    return text.substr(0, line_end) + prelude + text.substr(line_end);
}

/// One file of GLSL with the places that can be rewritten.
class ShaderText {
public:
    explicit ShaderText(std::string text) : text_(std::move(text)) { read_tokens(), read_functions(); }

    /// Names that stand outside of functions, or in lines of the preprocessor: no local may be renamed from
    /// one of them.
    std::set<std::string> global_names() const {
        std::set<std::string> names = names_of_directives_;
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (tokens_[i].is_word() && !function_at(i)) names.insert(tokens_[i].text);
        for (const Function& function : functions_) names.insert(function.name);
        return names;
    }

    /// The text with `precise` on variables, parameters, returned values and outputs that may hold floats, so
    /// that a compiler has to keep the order of operations. Needs variant_prelude().
    std::string made_precise() {
        edits_.clear();
        for (std::size_t i = 1; i + 2 < tokens_.size(); ++i)
            if (declares_floats(i)) insert(tokens_[i].begin, "precise ");
        for (const Function& function : functions_) {
            keep_returned_values(function);
            keep_outputs(function);
        }
        return applied();
    }

    /// The text with each rewrite at about a third of its places. `sites` counts them.
    std::string rewritten(const Rewrites& rewrites, const std::set<std::string>& global, std::mt19937& random,
                          int& sites) {
        edits_.clear();
        const auto takes = [&] { return random() % 3 == 0; };
        for (const Function& function : functions_) {
            if (rewrites.wrap || rewrites.identity) rewrite_values(function, rewrites, takes);
            if (rewrites.dead && takes()) add_dead_branch(function);
            if (rewrites.loop && function.type == "void" && takes()) add_loop(function);
        }
        sites += int(edits_.size());
        std::string result = applied();
        if (rewrites.rename) result = ShaderText(std::move(result)).renamed(global, takes, sites);
        if (rewrites.reorder) result = ShaderText(std::move(result)).reordered(takes, sites);
        return result;
    }

private:
    struct Word {
        std::string text;
        std::size_t begin = 0, end = 0;  ///< in the text
        bool is_word() const { return Token{text}.is_word(); }
    };
    struct Function {
        std::string type, name;
        std::size_t first = 0, open = 0, close = 0;  ///< tokens: the type, the brackets of the body
    };
    struct Edit {
        std::size_t at = 0, length = 0;
        std::string text;
    };

    void read_tokens() {
        ShaderSource source{text_, {}};
        std::vector<std::size_t> starts{0};
        for (std::size_t i = 0; i < text_.size(); ++i)
            if (text_[i] == '\n') starts.push_back(i + 1);
        for (std::size_t i = 0; i < starts.size(); ++i) source.lines.push_back({"shader", int(i) + 1});
        std::set<int> directives;
        bool continues = false;
        for (std::size_t i = 0; i < starts.size(); ++i) {
            const std::size_t end = std::min(text_.find('\n', starts[i]), text_.size());
            const std::string_view line(text_.data() + starts[i], end - starts[i]);
            const std::size_t word = line.find_first_not_of(" \t");
            if (continues || (word != std::string_view::npos && line[word] == '#'))
                directives.insert(int(i) + 1);
            continues = directives.contains(int(i) + 1) && line.ends_with('\\');
        }
        for (const Token& token : glsl_tokens(source)) {
            const std::size_t begin = starts[std::size_t(token.line - 1)] + std::size_t(token.column - 1);
            if (directives.contains(token.line)) {
                names_of_directives_.emplace(token.text);
                directive_places_.push_back(begin);
            } else {
                const std::size_t end = begin + token.text.size();
                tokens_.push_back({std::string(token.text), begin, end});
            }
        }
    }

    bool is(std::size_t i, std::string_view text) const {
        return i < tokens_.size() && tokens_[i].text == text;
    }

    std::size_t closing(std::size_t open) const {
        int depth = 0;
        for (std::size_t i = open; i < tokens_.size(); ++i) {
            if (is(i, "(") || is(i, "{") || is(i, "[")) ++depth;
            if ((is(i, ")") || is(i, "}") || is(i, "]")) && --depth == 0) return i;
        }
        return tokens_.size();
    }

    /// "T name(...) {" outside of functions. A body with an #if in it is taken as it stands, where its
    /// brackets match.
    void read_functions() {
        for (std::size_t i = 0; i + 3 < tokens_.size(); ++i) {
            if (is(i, "{")) i = closing(i);  // of a struct or a block
            if (i + 3 >= tokens_.size()) return;
            if (!tokens_[i].is_word() || !tokens_[i + 1].is_word() || !is(i + 2, "(")) continue;
            const std::size_t parameters_end = closing(i + 2);
            if (!is(parameters_end + 1, "{")) continue;
            const std::size_t close = closing(parameters_end + 1);
            if (close >= tokens_.size()) return;
            functions_.push_back({tokens_[i].text, tokens_[i + 1].text, i, parameters_end + 1, close});
            i = close;
        }
    }

    const Function* function_at(std::size_t token) const {
        for (const Function& function : functions_)
            if (token > function.open && token < function.close) return &function;
        return nullptr;
    }

    bool has_directive(std::size_t begin, std::size_t end) const {
        return std::ranges::any_of(directive_places_,
                                   [&](std::size_t at) { return at >= begin && at < end; });
    }

    void insert(std::size_t at, std::string text) { edits_.push_back({at, 0, std::move(text)}); }

    /// The ';' of the statement, where no comma splits it outside of brackets; 0 otherwise.
    std::size_t end_of_value(std::size_t begin) const {
        for (std::size_t i = begin; i < tokens_.size(); ++i) {
            if (is(i, "(") || is(i, "[")) i = closing(i);
            else if (is(i, ";")) return has_directive(tokens_[begin].begin, tokens_[i].begin) ? 0 : i;
            else if (is(i, ",") || is(i, "{") || is(i, "}")) return 0;
        }
        return 0;
    }

    bool begins_statement(std::size_t i) const {
        if (is(i - 1, "precise")) return begins_statement(i - 1);
        return is(i - 1, "{") || is(i - 1, "}") || is(i - 1, ";");
    }

    /// "T name" of a variable or a parameter that is not const, where T is floats or a struct.
    bool declares_floats(std::size_t i) const {
        static const std::set<std::string> no_types = {
            "bool",     "bvec2",   "bvec3",   "bvec4", "break",   "case",   "const",
            "continue", "discard", "else",    "in",    "inout",   "int",    "ivec2",
            "ivec3",    "ivec4",   "layout",  "out",   "precise", "return", "shared",
            "struct",   "uint",    "uniform", "uvec2", "uvec3",   "uvec4",  "void"};
        const std::string& type = tokens_[i].text;
        if (!tokens_[i].is_word() || no_types.contains(type) || !tokens_[i + 1].is_word()) return false;
        if (is(i - 1, "precise")) return false;
        if (!is(i + 2, "=") && !is(i + 2, ";") && !is(i + 2, ",") && !is(i + 2, ")") && !is(i + 2, "["))
            return false;
        if (is_parameter(i))
            return is(i - 1, "(") || is(i - 1, ",") || is(i - 1, "out") || is(i - 1, "inout") ||
                   is(i - 1, "in");
        if (function_at(i)) return begins_statement(i) || (is(i - 1, "(") && is(i - 2, "for"));
        return !in_block(i) && (begins_statement(i) || is(i - 1, "shared"));
    }

    bool is_parameter(std::size_t i) const {
        return std::ranges::any_of(functions_,
                                   [&](const Function& f) { return i > f.first + 1 && i < f.open; });
    }

    /// Of a struct or of an interface, outside of functions.
    bool in_block(std::size_t i) const {
        int depth = 0;
        for (std::size_t k = 0; k < i; ++k) depth += is(k, "{") ? 1 : is(k, "}") ? -1 : 0;
        return depth > 0;
    }

    void keep_returned_values(const Function& function) {
        static const std::set<std::string> exact = {"void",  "int",   "uint",  "bool",  "ivec2",
                                                    "ivec3", "ivec4", "uvec2", "uvec3", "uvec4",
                                                    "bvec2", "bvec3", "bvec4"};
        if (exact.contains(function.type)) return;
        for (std::size_t i = function.open + 1; i < function.close; ++i) {
            const std::size_t end = is(i, "return") ? end_of_value(i + 1) : 0;
            if (end == 0) continue;
            edits_.push_back({tokens_[i].begin, std::string("return").size(),
                              "{ precise " + function.type + " meta_result ="});
            edits_.push_back({tokens_[end].begin, 1, "; return meta_result; }"});
        }
    }

    /// The host declares outputs, out_color or a macro that stands for one, and not all of them in each pass.
    void keep_outputs(const Function& function) {
        for (std::size_t i = function.open + 1; i < function.close; ++i) {
            if (!tokens_[i].text.starts_with("out_") && tokens_[i].text != "OUT") continue;
            std::size_t equals = i + 1;
            while (is(equals, ".") || (tokens_[equals].is_word() && is(equals - 1, "."))) ++equals;
            const std::size_t end = is(equals, "=") && !is(equals + 1, "=") ? end_of_value(equals + 1) : 0;
            if (end == 0) continue;
            insert(tokens_[equals + 1].begin, "meta_same(");
            insert(tokens_[end].begin, ")");
        }
    }

    /// `name`: of the variable; "" for what is returned.
    void rewrite_value(const std::string& type, const std::string& name, std::size_t begin,
                       const Rewrites& rewrites) {
        const std::size_t end = begin < tokens_.size() ? end_of_value(begin) : 0;
        if (end <= begin) return;
        if (rewrites.wrap && is_built_in_type(type) && name.empty()) {
            insert(tokens_[begin].begin, "meta_same(");
            insert(tokens_[end].begin, ")");
        } else if (rewrites.wrap && is_built_in_type(type)) {
            // Not around the value: Mesa 22.3 orders the operations of an argument as it likes, although the
            // parameter is precise.
            insert(tokens_[end].end, " " + name + " = meta_same(" + name + ");");
        } else if (rewrites.identity && is_float_type(type)) {
            insert(tokens_[begin].begin, "(");
            insert(tokens_[end].begin, ") * meta_one");
        }
    }

    template <class Takes>
    void rewrite_values(const Function& function, const Rewrites& rewrites, const Takes& takes) {
        for (std::size_t i = function.open + 1; i < function.close; ++i) {
            if (is(i, "(")) {
                i = closing(i);
                continue;
            }
            const bool declares = begins_statement(i) && is_built_in_type(tokens_[i].text) &&
                                  tokens_[i + 1].is_word() && is(i + 2, "=");
            if (is(i, "return") && !is(i + 1, ";") && takes())
                rewrite_value(function.type, "", i + 1, rewrites);
            else if (declares && takes())
                rewrite_value(tokens_[i].text, tokens_[i + 1].text, i + 3, rewrites);
        }
    }

    void add_dead_branch(const Function& function) {
        if (function.type != "void" && !is_built_in_type(function.type)) return;
        const std::string value = function.type == "void" ? "" : " " + function.type + "(0)";
        insert(tokens_[function.open].end, " if (meta_one < 0.5) return" + value + ";");
    }

    void add_loop(const Function& function) {
        insert(tokens_[function.open].end, " do {");
        insert(tokens_[function.close].begin, "} while (false); ");
    }

    template <class Takes>
    void rename_locals(const Function& function, const std::set<std::string>& global, const Takes& takes) {
        std::set<std::string> seen;
        for (std::size_t i = function.open + 1; i + 2 < function.close; ++i) {
            const bool declares = is_built_in_type(tokens_[i].text) && tokens_[i + 1].is_word() &&
                                  (is(i + 2, "=") || is(i + 2, ";") || is(i + 2, ",") || is(i + 2, "["));
            if (!declares) continue;
            const std::string name = tokens_[i + 1].text;
            if (global.contains(name) || !seen.insert(name).second || !takes()) continue;
            for (std::size_t k = function.first; k < function.close; ++k)
                if (is(k, name) && !is(k - 1, "."))
                    edits_.push_back({tokens_[k].begin, name.size(), "other_" + name});
        }
    }

    std::string applied() const {
        std::vector<Edit> edits = edits_;
        std::ranges::stable_sort(edits, {}, &Edit::at);
        std::string result;
        std::size_t at = 0;
        for (const Edit& edit : edits) {
            result += text_.substr(at, edit.at - at) + edit.text;
            at = edit.at + edit.length;
        }
        return result + text_.substr(at);
    }

    /// A function, or "const T name = ...;", from its first token to its last.
    struct Piece {
        std::size_t first = 0, last = 0;
        std::string name;
    };
    std::vector<Piece> pieces() const {
        std::vector<Piece> found;
        for (const Function& function : functions_)
            found.push_back({function.first, function.close, function.name});
        for (std::size_t i = 0; i + 3 < tokens_.size(); ++i) {
            if (!is(i, "const") || function_at(i) || !tokens_[i + 2].is_word() || !is(i + 3, "=")) continue;
            if (std::ranges::any_of(functions_, [&](const Function& f) { return i > f.first && i < f.open; }))
                continue;  // a parameter
            if (const std::size_t end = end_of_value(i + 4)) found.push_back({i, end, tokens_[i + 2].text});
        }
        std::ranges::sort(found, {}, &Piece::first);
        return found;
    }

    bool names(const Piece& piece, const std::string& name) const {
        for (std::size_t i = piece.first; i <= piece.last; ++i)
            if (is(i, name)) return true;
        return false;
    }

    template <class Takes>
    std::string renamed(const std::set<std::string>& global, const Takes& takes, int& sites) {
        for (const Function& function : functions_) rename_locals(function, global, takes);
        sites += int(edits_.size());
        return applied();
    }

    template <class Takes>
    std::string reordered(const Takes& takes, int& sites) {
        const std::vector<Piece> all = pieces();
        edits_.clear();
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
            const Piece &a = all[i], &b = all[i + 1];
            const std::size_t begin = tokens_[a.first].begin, end = tokens_[b.last].end;
            if (b.first != a.last + 1 || names(b, a.name) || has_directive(begin, end) || !takes()) continue;
            const std::string first = text_.substr(begin, tokens_[a.last].end - begin);
            const std::string second = text_.substr(tokens_[b.first].begin, end - tokens_[b.first].begin);
            edits_.push_back({begin, end - begin, second + "\n" + first});
            ++sites, ++i;
        }
        return applied();
    }

    std::string text_;
    std::vector<Word> tokens_;
    std::vector<Function> functions_;
    std::set<std::string> names_of_directives_;
    std::vector<std::size_t> directive_places_;
    std::vector<Edit> edits_;
};

}  // namespace aftershade::test
