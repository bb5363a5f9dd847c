#include "framework/effect/shader_uses.h"

#include <cctype>
#include <map>
#include <set>
#include <utility>

namespace aftershade {

namespace {

constexpr std::string_view kSize = "_size";

bool is_char(const Token& token, char c) {
    return token.text[0] == c;  // only words have more than one character
}

/// GLSL's functions whose first argument is a sampler: texture, textureLod, textureSize, texelFetch, ...
bool is_sampling(std::string_view word) {
    constexpr std::string_view kTexture = "texture";
    if (word[0] != 't') return false;
    if (word == "texelFetch" || word == "texelFetchOffset" || word == kTexture) return true;
    return word.starts_with(kTexture) && std::isupper(static_cast<unsigned char>(word[kTexture.size()]));
}

void add_first(ShaderUses::Uses& uses, std::string_view name, const Token& token) {
    if (!uses.contains(name)) uses.emplace(name, token.place());
}

bool is_on_line_of(const Token& token, const Token* directive) {
    return directive && token.line == directive->line && *token.file == *directive->file;
}

/// Whether the word at `i` is the name in a declaration: a type stands before it, not the end of a directive.
bool is_declared_at(const std::vector<Token>& tokens, std::size_t i, const Token* directive) {
    if (i == 0 || !tokens[i - 1].may_be_type()) return false;
    return !is_on_line_of(tokens[i - 1], directive) || tokens[i].line == tokens[i - 1].line;
}

/// The place behind the "]" of the "[" at `at`.
std::size_t behind_brackets(const std::vector<Token>& tokens, std::size_t at) {
    int depth = 0;
    for (; at < tokens.size(); ++at) {
        depth += is_char(tokens[at], '[');
        depth -= is_char(tokens[at], ']');
        if (depth == 0) return at + 1;
    }
    return at;
}

/// "float", "uvec3", "mat2x3": types whose variables have no value until one is assigned.
bool is_value_type(std::string_view word) {
    if (!word.empty() && (word[0] == 'i' || word[0] == 'u' || word[0] == 'b') &&
        word.substr(1).starts_with("vec"))
        word.remove_prefix(1);
    return word == "float" || word == "int" || word == "uint" || word == "bool" ||
           ((word.starts_with("vec") || word.starts_with("mat")) && word.size() > 3 &&
            std::isdigit(static_cast<unsigned char>(word[3])));
}

/// Whether the statement may change the variable at `i`: it assigns to it, or hands it to a function.
bool may_be_written_at(const std::vector<Token>& tokens, std::size_t i, const Token* directive) {
    if (is_on_line_of(tokens[i], directive)) return true;
    const auto is_before = [&](std::size_t back, char c) {
        return i >= back && is_char(tokens[i - back], c);
    };
    if ((is_before(1, '+') && is_before(2, '+')) || (is_before(1, '-') && is_before(2, '-'))) return true;
    std::size_t at = i + 1;
    const auto is_at = [&](std::size_t place, char c) {
        return place < tokens.size() && is_char(tokens[place], c);
    };
    while (is_at(at, '.') || is_at(at, '[')) {
        if (is_at(at, '.')) at += 2;
        else at = behind_brackets(tokens, at);
    }
    // A constructor changes nothing: "float(x)".
    const bool converts = is_before(1, '(') && i >= 2 && is_value_type(tokens[i - 2].text);
    const bool is_argument =
        !converts && (is_before(1, '(') || is_before(1, ',')) && (is_at(at, ')') || is_at(at, ','));
    if (is_argument) return true;
    if (is_at(at, '=')) return !is_at(at + 1, '=');
    for (const char c : {'+', '-', '*', '/', '%', '&', '|', '^', '<', '>'})
        if (is_at(at, c)) return is_at(at + 1, '=') || is_at(at + 1, c);
    return false;
}

/// Parameters of the macro that "#define NAME(a, b) ..." at the "#" at `i` declares.
ShaderUses::Words macro_parameters_at(const std::vector<Token>& tokens, std::size_t i) {
    ShaderUses::Words names;
    if (i + 3 >= tokens.size() || tokens[i + 1].text != "define" || !is_char(tokens[i + 3], '('))
        return names;
    for (i += 4; i < tokens.size() && !is_char(tokens[i], ')'); ++i)
        if (tokens[i].is_word()) names.insert(tokens[i].text);
    return names;
}

/// Variables of a function that are read though nothing in it may assign to them, as far as its words show.
void find_unset(const std::vector<Token>& tokens, ShaderUses::Uses& unset) {
    struct Local {
        Place place;
        bool is_read = false, is_written = false;
    };
    std::map<std::string_view, Local> locals;  // of the function at hand
    std::set<std::string_view> in_directives;
    BraceDepth braces;
    int parentheses = 0;
    const Token* directive = nullptr;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const Token& token = tokens[i];
        if (is_char(token, '#')) directive = &token;
        if (is_on_line_of(token, directive)) {
            if (i > 0 && is_char(tokens[i - 1], '#')) braces.pass_directive(token.text);
            in_directives.insert(token.text);
            continue;
        }
        if (is_char(token, '{')) braces.open();
        if (is_char(token, '}')) braces.close();
        parentheses += is_char(token, '(') - is_char(token, ')');
        if (braces.value() == 0) {
            for (const auto& [name, local] : locals)
                if (local.is_read && !local.is_written && !in_directives.contains(name))
                    unset.emplace(name, local.place);
            locals.clear();
            continue;
        }
        if (!token.is_word() || i == 0 || is_char(tokens[i - 1], '.')) continue;
        if (is_value_type(tokens[i - 1].text) && parentheses == 0) {
            const std::size_t behind =
                i + 1 < tokens.size() && is_char(tokens[i + 1], '[') ? behind_brackets(tokens, i + 1) : i + 1;
            const bool is_open =
                behind < tokens.size() && (is_char(tokens[behind], ';') || is_char(tokens[behind], ','));
            const auto [local, is_new] = locals.try_emplace(token.text, Local{token.place()});
            local->second.is_written |= !is_open || !is_new;
            continue;
        }
        const auto local = locals.find(token.text);
        if (local == locals.end()) continue;
        const bool writes = may_be_written_at(tokens, i, nullptr);
        local->second.is_written |= writes;
        local->second.is_read |= !writes;
    }
}

}  // namespace

ShaderUses::ShaderUses(ShaderSource source)
    : source_(std::make_unique<const ShaderSource>(std::move(source))) {
    const std::vector<Token> tokens = glsl_tokens(*source_);
    Words own_outputs, own_samplers, macro_parameters;
    int branches = 0;                  // of #if, around the token
    const Token* directive = nullptr;  // the last before the token
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const Token& token = tokens[i];
        if (is_char(token, '#')) {
            directive = &token;
            macro_parameters = macro_parameters_at(tokens, i);
        }
        if (!token.is_word()) continue;
        words.insert(token.text);
        if (i > 0 && is_char(tokens[i - 1], '#'))
            branches += token.text == "endif" ? -1 : token.text.starts_with("if") ? 1 : 0;
        const bool is_member = i > 0 && is_char(tokens[i - 1], '.');
        if (is_member) continue;
        if (i + 2 < tokens.size() && is_char(tokens[i + 1], '.')) {
            const std::string_view member = tokens[i + 2].text;
            if (token.text == "param") add_first(params, member, token);
            if (token.text == "native") add_first(natives, member, token);
            if (token.text == "lights" && (member == "count" || member == "light") && !lights)
                lights = token.place();
        }
        if (i + 2 < tokens.size() && is_sampling(token.text) && is_char(tokens[i + 1], '(') &&
            tokens[i + 2].is_word() &&
            !(is_on_line_of(token, directive) && macro_parameters.contains(tokens[i + 2].text))) {
            add_first(samplers, tokens[i + 2].text, tokens[i + 2]);
            if (branches == 0) add_first(plain_samplers, tokens[i + 2].text, tokens[i + 2]);
        }
        if (token.text.ends_with(kSize))
            add_first(sizes, token.text.substr(0, token.text.size() - kSize.size()), token);
        // "vec3 out_direction" is the shader's own.
        const bool declares = is_declared_at(tokens, i, directive);
        if (declares) own.insert(token.text);
        if (declares && tokens[i - 1].text.find("sampler") != std::string_view::npos)
            own_samplers.insert(token.text);
        if (!token.text.starts_with(kOut)) continue;
        if (declares) own_outputs.insert(token.text.substr(kOut.size()));
        else add_first(outputs, token.text.substr(kOut.size()), token);
        if (may_be_written_at(tokens, i, directive)) written.insert(token.text);
    }
    find_unset(tokens, unset);
    std::erase_if(outputs, [&](const auto& use) { return own_outputs.contains(use.first); });
    std::erase_if(samplers, [&](const auto& use) { return own_samplers.contains(use.first); });
    std::erase_if(sizes, [&](const auto& use) { return own.contains(use.first + std::string(kSize)); });
}

}  // namespace aftershade
