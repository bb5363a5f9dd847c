#include "framework/effect/shader_uses.h"

#include <cctype>

namespace aftershade {

namespace {

constexpr std::string_view kSize = "_size";

/// GLSL's functions whose first argument is a sampler: texture, textureLod, textureSize, texelFetch, ...
bool is_sampling(const std::string& word) {
    constexpr std::string_view kTexture = "texture";
    if (word == "texelFetch" || word == "texelFetchOffset" || word == kTexture) return true;
    return word.starts_with(kTexture) && std::isupper(static_cast<unsigned char>(word[kTexture.size()]));
}

bool is_on_line_of(const Token& token, const Token* directive) {
    return directive && token.line == directive->line && *token.file == *directive->file;
}

/// Whether the word at `i` is the name in a declaration: a type stands before it, not the end of a directive.
bool is_declared_at(const std::vector<Token>& tokens, std::size_t i, const Token* directive) {
    if (i == 0 || !tokens[i - 1].is_word() || tokens[i - 1].text == "return" || tokens[i - 1].text == "else")
        return false;
    return !is_on_line_of(tokens[i - 1], directive) || tokens[i].line == tokens[i - 1].line;
}

/// Parameters of the macro that "#define NAME(a, b) ..." at the "#" at `i` declares.
std::set<std::string> macro_parameters_at(const std::vector<Token>& tokens, std::size_t i) {
    std::set<std::string> names;
    if (i + 3 >= tokens.size() || tokens[i + 1].text != "define" || tokens[i + 3].text != "(") return names;
    for (i += 4; i < tokens.size() && tokens[i].text != ")"; ++i)
        if (tokens[i].is_word()) names.insert(tokens[i].text);
    return names;
}

}  // namespace

ShaderUses::ShaderUses(const std::vector<Token>& tokens) {
    std::set<std::string> own_outputs, own_samplers, macro_parameters;
    int branches = 0;                  // of #if, around the token
    const Token* directive = nullptr;  // the last before the token
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const Token& token = tokens[i];
        if (token.text == "#") {
            directive = &token;
            macro_parameters = macro_parameters_at(tokens, i);
        }
        if (!token.is_word()) continue;
        words.insert(token.text);
        if (i > 0 && tokens[i - 1].text == "#")
            branches += token.text == "endif" ? -1 : token.text.starts_with("if") ? 1 : 0;
        const bool is_member = i > 0 && tokens[i - 1].text == ".";
        if (is_member) continue;
        if (i + 2 < tokens.size() && tokens[i + 1].text == ".") {
            const std::string& member = tokens[i + 2].text;
            if (token.text == "param") params.emplace(member, token.place());
            if (token.text == "native") natives.emplace(member, token.place());
            if (token.text == "lights" && (member == "count" || member == "light") && !lights)
                lights = token.place();
        }
        if (i + 2 < tokens.size() && is_sampling(token.text) && tokens[i + 1].text == "(" &&
            tokens[i + 2].is_word() &&
            !(is_on_line_of(token, directive) && macro_parameters.contains(tokens[i + 2].text))) {
            samplers.emplace(tokens[i + 2].text, tokens[i + 2].place());
            if (branches == 0) plain_samplers.emplace(tokens[i + 2].text, tokens[i + 2].place());
        }
        if (token.text.ends_with(kSize))
            sizes.emplace(token.text.substr(0, token.text.size() - kSize.size()), token.place());
        // "vec3 out_direction" is the shader's own.
        const bool declares = is_declared_at(tokens, i, directive);
        if (declares) own.insert(token.text);
        if (declares && tokens[i - 1].text.find("sampler") != std::string::npos)
            own_samplers.insert(token.text);
        if (!token.text.starts_with(kOut)) continue;
        if (declares) own_outputs.insert(token.text.substr(kOut.size()));
        else outputs.emplace(token.text.substr(kOut.size()), token.place());
    }
    for (const std::string& name : own_outputs) outputs.erase(name);
    for (const std::string& name : own_samplers) samplers.erase(name);
    std::erase_if(sizes, [&](const auto& use) { return own.contains(use.first + std::string(kSize)); });
}

}  // namespace aftershade
