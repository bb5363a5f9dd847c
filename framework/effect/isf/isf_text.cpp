#include "framework/effect/isf/isf_text.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "framework/base/text.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/isf/isf_names.h"
#include "framework/effect/isf/isf_vocabulary.h"

namespace aftershade {

using namespace isf_words;

/// One text with the tokens of it.
class IsfRewriter {
public:
    IsfRewriter(const IsfTexts& file, const std::string& text, bool is_fragment)
        : file_(file), is_fragment_(is_fragment), source_{text, {}} {
        source_.lines.resize(std::size_t(std::ranges::count(text, '\n')) + 1, {"", 1});
        for (std::size_t i = 0; i < source_.lines.size(); ++i) source_.lines[i].line = int(i) + 1;
        tokens_ = glsl_tokens(source_);
        mark_directives();
        mark_members();
        int depth = 0;
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            const std::string_view word = tokens_[i].text;
            depth += word == "{" || word == "(" ? 1 : word == "}" || word == ")" ? -1 : 0;
            if (depth == 0 && is_type(i)) (at(i + 1) == "(" ? global_functions_ : globals_).emplace(word);
            if (is_type(i)) typed_.emplace(word);
            if (is_declared(i)) declared_.emplace(word);
            if (kSampling.contains(word) && !file_.macros_.contains(std::string(word)) && !directive_[i] &&
                at(i + 1) != "(")
                variables_.emplace(word);
            if (kSampling.contains(word) && at(i + 1) == "(" && at(i + 2) == "sampler2D" && is_type(i))
                functions_.emplace(word);
        }
        statements();
    }

    /// Whether the name, which is the file's, is called like a function or stands behind a dot.
    bool has_another_meaning(const std::string& name) const {
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (tokens_[i].text == name && (at(i + 1) == "(" || before(i) == ".")) return true;
        return false;
    }
    const std::string& output() const { return output_; }
    bool has(std::string_view word) const {
        return std::ranges::any_of(tokens_, [&](const Token& token) { return token.text == word; });
    }
    bool sets_coordinates() const {
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (tokens_[i].text.ends_with("_FragNormCoord") && (is_set(i) || directive_[i] || is_argument(i)))
                return true;
        return false;
    }
    bool is_read_by_pixel(const std::string& name) const {
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (is_of(tokens_[i].text, name) && !(tokens_[i].text == name && is_read_here(i))) return false;
        return true;
    }

    std::string text() {
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (tokens_[i].text == "main") edits_.push_back({offset(i), 0, "isf_"});  // for ours around it
            else if (is_fragment_ && file_.read_here_.contains(std::string(tokens_[i].text)) &&
                     is_read_here(i))
                edits_.push_back({offset(i), 0, std::string(kHere)});
            else if (is_called_like_a_variable(i)) edits_.push_back({offset(i), 0, std::string(kCall)});
            else if (tokens_[i].is_word() && is_renamed(i))
                edits_.push_back({offset(i), 0, std::string(kOwn)});
        std::ranges::sort(edits_, {}, &Edit::at);
        std::string result;
        std::size_t done = 0;
        for (const Edit& edit : edits_) {
            if (edit.at < done) continue;
            result += source_.text.substr(done, edit.at - done) + edit.text;
            done = edit.at + edit.size;
        }
        return result + source_.text.substr(done);
    }

private:
    /// IMG_THIS_PIXEL(name)
    bool is_read_here(std::size_t i) const {
        return i > 1 && before(i) == "(" && at(i + 1) == ")" &&
               (tokens_[i - 2].text == "IMG_THIS_PIXEL" || tokens_[i - 2].text == "IMG_THIS_NORM_PIXEL");
    }

    /// The token behind name, name.x or name[0].
    std::size_t behind(std::size_t i) const {
        std::size_t next = i + 1;
        if (at(next) == ".") return next + 2;
        if (at(next) == "[")
            while (next < tokens_.size() && at(next++) != "]") {
            }
        return next;
    }
    /// name = ..., name.x *= ..., name[0] += ..., name.y++, --name
    bool is_set(std::size_t i) const {
        const std::size_t next = behind(i);
        const auto is_step = [&](std::size_t at_sign) {
            return (at(at_sign) == "+" || at(at_sign) == "-") && at(at_sign) == at(at_sign + 1);
        };
        static const Words kBefore = {"+", "-", "*", "/"};
        return (at(next) == "=" && at(next + 1) != "=") ||
               (kBefore.contains(at(next)) && at(next + 1) == "=") || is_step(next) ||
               (i > 1 && is_step(i - 2));
    }
    /// Whether a function or a macro of the file gets it by itself, and may set it.
    bool is_argument(std::size_t i) const {
        const std::string_view next = at(behind(i));
        if ((before(i) != "(" && before(i) != ",") || (next != ")" && next != ",")) return false;
        int depth = 0;
        for (std::size_t open = i; open-- > 1;)
            if (at(open) == ")") ++depth;
            else if (at(open) == "(" && depth-- == 0)
                return typed_.contains(at(open - 1)) || file_.macros_.contains(std::string(at(open - 1)));
        return false;
    }

    struct Edit {
        std::size_t at = 0, size = 0;
        std::string text;
    };

    std::string_view at(std::size_t i) const { return i < tokens_.size() ? tokens_[i].text : ""; }
    std::string_view before(std::size_t i) const { return i > 0 ? tokens_[i - 1].text : ""; }
    std::size_t offset(std::size_t i) const {
        return std::size_t(tokens_[i].text.data() - source_.text.data());
    }
    std::size_t end(std::size_t i) const { return offset(i) + tokens_[i].text.size(); }

    void mark_directives() {
        directive_.resize(tokens_.size());
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            const bool is_new_line = i == 0 || tokens_[i].line != tokens_[i - 1].line;
            directive_[i] = is_new_line
                                ? tokens_[i].text == "#" || (i > 0 && directive_[i - 1] && before(i) == "\\")
                                : directive_[i - 1];
        }
    }

    /// The names that a struct declares.
    void mark_members() {
        member_.resize(tokens_.size());
        int depth = 0;
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (tokens_[i].text == "{")
                depth = depth > 0 || before(i) == "struct" || (i > 1 && tokens_[i - 2].text == "struct")
                            ? depth + 1
                            : 0;
            else if (tokens_[i].text == "}" && depth > 0) --depth;
            const std::string_view next = at(i + 1);
            member_[i] = depth > 0 && (next == ";" || next == "," || next == "[");
        }
    }

    /// Whether what stands before can be the type of a declaration.
    bool is_type(std::size_t i) const {
        if (i == 0 || !tokens_[i - 1].may_be_type()) return false;
        const std::string_view type = before(i);
        static const Words kNone = {"in",     "out",    "inout",   "const", "varying", "attribute", "case",
                                    "struct", "define", "defined", "ifdef", "ifndef",  "undef",     "if"};
        return !kNone.contains(type) && !kQualifiers.contains(type) && !directive_[i];
    }
    bool is_declared(std::size_t i) const {
        const std::string_view next = at(i + 1);
        const bool is_assigned = next == "=" && at(i + 2) != "=";
        const bool ends = next == ";" || next == "," || next == ")" || next == "[" || next == "(";
        return tokens_[i].is_word() && (is_assigned || (is_type(i) && ends));
    }

    /// Whether a word of GLSL 4.50 is meant as such.
    bool is_keyword_use(std::size_t i) const {
        const std::string_view word = tokens_[i].text, next = at(i + 1);
        const bool is_before_word = i + 1 < tokens_.size() && tokens_[i + 1].is_word();
        if (word == "layout" || word == "subroutine")
            return is_before_word || (next == "(" && !declared_.contains(word));
        if (kQualifiers.contains(word)) return is_before_word;
        if (is_new_type(word)) return is_before_word || !declared_.contains(word);
        if (is_statement_word(word)) return !declared_.contains(word);
        return false;
    }

    /// Older GLSL keeps functions apart from variables.
    bool is_called_like_a_variable(std::size_t i) const {
        const std::string_view word = tokens_[i].text;
        return at(i + 1) == "(" && global_functions_.contains(word) &&
               (globals_.contains(word) || file_.own_things_.contains(std::string(word)));
    }

    bool is_renamed(std::size_t i) const {
        const std::string_view word = tokens_[i].text;
        const bool is_called = at(i + 1) == "(";
        if (file_.own_things_.contains(std::string(word))) {
            if (is_called && !is_keyword(word)) return false;
            return !is_swizzle(word) || (before(i) != "." && !member_[i]);
        }
        if (is_keyword(word)) return !is_keyword_use(i);
        if (is_host_name(word))
            return !kAliases.contains(word) || typed_.contains(word) ||
                   file_.macros_.contains(std::string(word));
        if (functions_.contains(word)) return is_called;
        return variables_.contains(word) && !is_called;
    }

    // ---- declarations outside of functions ----

    void statements() {
        int braces = 0, brackets = 0;
        std::size_t begin = 0;
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            const std::string_view token = tokens_[i].text;
            if (directive_[i]) {
                if (braces == 0) begin = i + 1;
                continue;
            }
            if (token == "{") ++braces;
            else if (token == "}") --braces;
            else if (token == "(") ++brackets;
            else if (token == ")") --brackets;
            const bool ends = braces <= 0 && brackets <= 0 && (token == ";" || token == "}");
            if (!ends) continue;
            braces = brackets = 0;
            if (token == ";") statement(begin, i);
            begin = i + 1;
        }
    }

    /// Some hosts take a constant that is made of what a frame sets.
    void constant(std::size_t begin, std::size_t end) {
        const auto is_live = [&](std::size_t i) {
            const std::string word(tokens_[i].text);
            return before(i) != "." && word != "PASSINDEX" &&
                   (kOfIsf.contains(word) || word == "gl_FragCoord" || file_.things_.contains(word) ||
                    live_.contains(word));
        };
        std::size_t i = begin;
        while (i < end && !is_live(i)) ++i;
        if (i == end) return;
        blank(begin, begin);
        for (i = begin; i < end; ++i) {
            if (at(i + 1) != "=" || at(i + 2) == "=") continue;
            std::size_t name = i;
            while (at(name) == "]")
                while (name > begin && at(name--) != "[") {
                }
            if (tokens_[name].is_word()) live_.emplace(at(name));
        }
    }

    /// `end`: of its semicolon.
    void statement(std::size_t begin, std::size_t end) {
        if (at(begin) == "const") return constant(begin, end);
        std::size_t i = begin;
        if (at(i) == "layout")
            while (i < end && at(i++) != ")") {
            }
        bool is_output = false, is_foreign = false;
        for (; i < end; ++i) {
            is_output |= at(i) == "out";
            is_foreign |= at(i) == "uniform" || at(i) == "varying" || at(i) == "in" || at(i) == "attribute" ||
                          (at(i) == "out" && !is_fragment_);
            if (is_output && at(i) == "out" && is_fragment_) out_ = i;
            if (!kQualifiers.contains(at(i)) && !is_interface(at(i))) break;
        }
        // Now at the type.
        std::vector<std::size_t> names;
        for (std::size_t n = i + 1; n < end; ++n)
            if (tokens_[n].is_word() && (n == i + 1 || before(n) == ",")) names.push_back(n);
        if (names.empty()) return;
        if (is_output && is_fragment_) return output(begin, names.front());
        const auto is_known = [&](std::size_t n) {
            const std::string word(tokens_[n].text);
            return kOfIsf.contains(word) || file_.things_.contains(word) || is_of_an_image(word);
        };
        if (is_foreign && std::ranges::all_of(names, is_known)) blank(begin, end);
    }
    static bool is_interface(std::string_view word) {
        return word == "in" || word == "out" || word == "varying" || word == "attribute";
    }
    /// _inputImage_imgSize and its like.
    bool is_of_an_image(const std::string& word) const {
        return std::ranges::any_of(
            file_.things_, [&](const std::string& name) { return word != name && is_of(word, name); });
    }
    static bool is_of(std::string_view word, const std::string& name) {
        return word == name || std::ranges::any_of(kImageWords, [&](const char* suffix) {
                   return word == "_" + name + suffix;
               });
    }

    /// A global variable takes the output's place.
    void output(std::size_t begin, std::size_t name) {
        if (at(begin) == "layout") {
            std::size_t close = begin;
            while (at(close) != ")") ++close;
            blank(begin, close);
        }
        blank(out_, out_);
        if (!output_.empty()) return;
        output_ = (is_renamed(name) ? std::string(kOwn) : "") + std::string(tokens_[name].text) +
                  (at(name + 1) == "[" ? "[0]" : "");
    }

    void blank(std::size_t first, std::size_t last) {
        std::string blanks = source_.text.substr(offset(first), end(last) - offset(first));
        for (char& c : blanks)
            if (c != '\n' && c != '\r') c = ' ';
        const std::size_t size = blanks.size();
        edits_.push_back({offset(first), size, std::move(blanks)});
    }

    const IsfTexts& file_;
    const bool is_fragment_;
    ShaderSource source_;
    std::vector<Token> tokens_;
    std::vector<bool> directive_, member_;  // of each token
    Words declared_, variables_, functions_;
    Words globals_, global_functions_, typed_;  // typed_: behind a type, at any depth
    Words live_;                                // constants that a frame sets
    std::vector<Edit> edits_;
    std::size_t out_ = 0;
    std::string output_;
};

IsfTexts::IsfTexts(const IsfFile& file) : file_(file), macros_(IsfWords(file).macros) {
    // An image's name is a macro for our sampler, whose own name it must not be.
    const auto add = [&](const std::string& name, bool is_image) {
        if (name.empty()) return;
        things_.insert(name);
        if (is_image && name == snake_case(name)) own_things_.insert(name);
    };
    for (const IsfInput& input : file.inputs)
        add(input.name, input.type == IsfInput::Type::image || input.type == IsfInput::Type::audio);
    for (const IsfImport& import : file.imports) add(import.name, true);
    for (const std::string& cube : file.cubes) add(cube, true);
    for (const IsfPass& pass : file.passes) add(pass.target, true);
    for (const auto& [text, is_fragment] : {std::pair(&file.text, true), {&file.vertex_text, false}}) {
        const IsfRewriter rewriter(*this, *text, is_fragment);
        for (const std::string& name : things_)
            if (is_swizzle(name) || is_keyword(name) || is_host_name(name) || kSampling.contains(name) ||
                rewriter.has_another_meaning(name))
                own_things_.insert(name);
    }
    const auto add_here = [&](const std::string& name) {
        if (!name.empty() && !redefines_pixels() && !is_read_by_pixel(name)) read_here_.insert(name);
    };
    for (const IsfInput& input : file.inputs)
        if (input.type == IsfInput::Type::image) add_here(input.name);
    for (const IsfPass& pass : file.passes) add_here(pass.target);
}

bool IsfTexts::is_renamed(const std::string& word) const {
    return own_things_.contains(word) || is_keyword(word) || is_host_name(word);
}

bool IsfTexts::moves_corners() const {
    const IsfRewriter vertex(*this, file_.vertex_text, false);
    return vertex.has("gl_Position") || vertex.sets_coordinates();
}

bool IsfTexts::discards() const {
    return IsfRewriter(*this, file_.text, true).has("discard");
}

bool IsfTexts::is_of_isf(std::string_view word) {
    return kOfIsf.contains(word);
}

std::string IsfTexts::rewritten(const std::string& text, bool is_fragment) const {
    return IsfRewriter(*this, text, is_fragment).text();
}

std::string IsfTexts::name(const std::string& isf_name) const {
    return own_things_.contains(isf_name) ? std::string(kOwn) + isf_name : isf_name;
}

bool IsfTexts::is_read_by_pixel(const std::string& isf_name) const {
    return !redefines_pixels() && IsfRewriter(*this, file_.text, true).is_read_by_pixel(isf_name);
}

std::string IsfTexts::name_here(const std::string& isf_name) const {
    return read_here_.contains(isf_name) ? std::string(kHere) + isf_name : "";
}

bool IsfTexts::redefines_pixels() const {
    return macros_.contains("IMG_THIS_PIXEL") || macros_.contains("IMG_THIS_NORM_PIXEL");
}

std::string IsfTexts::output() const {
    return IsfRewriter(*this, file_.text, true).output();
}

}  // namespace aftershade
