#include "framework/effect/fused_shader.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "framework/effect/glsl_tokens.h"

namespace aftershade {

namespace {

/// Names that a text has outside of every function, and what it does with the preprocessor.
class GlobalNames {
public:
    explicit GlobalNames(const std::vector<Token>& tokens) : tokens_(tokens) {
        for (at_ = 0; at_ < tokens_.size(); ++at_)
            if (tokens_[at_].text == "#") read_directive();
            else read_token();
    }

    std::set<std::string> declared;  ///< functions, variables, structures, blocks, members of nameless blocks
    std::set<std::string> macros;
    std::set<std::string> tested;  ///< words of #if, #ifdef, ...
    bool has_extension = false;

private:
    bool is(std::size_t i, std::string_view text) const {
        return i < tokens_.size() && tokens_[i].text == text;
    }

    void read_directive() {
        const int line = tokens_[at_].line;
        const std::string_view kind = at_ + 1 < tokens_.size() ? tokens_[at_ + 1].text : "";
        if (kind == "define" && at_ + 2 < tokens_.size()) macros.emplace(tokens_[at_ + 2].text);
        if (kind == "extension") has_extension = true;
        braces_.pass_directive(kind);
        for (; at_ + 1 < tokens_.size() && tokens_[at_ + 1].line == line; ++at_)
            if (kind.starts_with("if") || kind.starts_with("el")) tested.emplace(tokens_[at_ + 1].text);
    }

    void read_token() {
        const Token& token = tokens_[at_];
        if (token.text == "(" || token.text == "[") ++nested_;
        else if (token.text == ")" || token.text == "]") --nested_;
        else if (token.text == "{") {
            if (braces_.value() == 0) is_block_ = is_interface_;
            braces_.open();
        } else if (token.text == "}") {
            braces_.close();
        }
        if (token.text == ";" || token.text == "}") is_interface_ = false;
        if (nested_ > 0) return;
        if (token.text == "uniform" || token.text == "buffer") is_interface_ = true;
        if (token.is_word() &&
            (braces_.value() == 0 ? is_name() : braces_.value() == 1 && is_block_ && is_member()))
            declared.emplace(token.text);
    }

    /// "float x;", "float x = 1, y = 2;", "vec4 f(", "struct S {", "} param;".
    bool is_name() const {
        if (at_ == 0) return false;
        const Token& before = tokens_[at_ - 1];
        const bool ends = std::ranges::any_of(std::array{"(", ";", ",", "=", "[", "{"},
                                              [&](const char* text) { return is(at_ + 1, text); });
        if (!ends || tokens_[at_].text == "layout") return false;
        return before.is_word() || before.text == "," || before.text == "]" || before.text == "}";
    }

    bool is_member() const {
        return at_ > 0 && tokens_[at_ - 1].is_word() && (is(at_ + 1, ";") || is(at_ + 1, "["));
    }

    const std::vector<Token>& tokens_;
    std::size_t at_ = 0;
    BraceDepth braces_;
    int nested_ = 0;             // in other brackets
    bool is_interface_ = false;  // the statement at hand declares a uniform or a buffer
    bool is_block_ = false;      // the braces that are open are such a block's
};

/// "xyz", "rgba", "st": what may follow the dot of a vector, which a macro would change.
bool is_swizzle(const std::string& word) {
    return word.size() <= 4 &&
           std::ranges::any_of(std::array{"xyzw", "rgba", "stpq"}, [&](const std::string_view letters) {
               return word.find_first_not_of(letters) == std::string::npos;
           });
}

/// A shader's own text, as a part without bindings of its own.
ShaderSource text_of(ShaderContext shader, const FusedPart& part, Diagnostics& diagnostics) {
    shader.part = &part;
    return assemble_shader(shader, diagnostics);
}

struct NamedBlock {
    int binding;
    const char* name;
};
constexpr std::array kNamedBlocks = {
    NamedBlock{kParamBinding, "param"},   NamedBlock{kFrameBinding, "frame"},
    NamedBlock{kCameraBinding, "camera"}, NamedBlock{kLightsBinding, "lights"},
    NamedBlock{kPassBinding, "pass"},     NamedBlock{kNativeBinding, "native"}};

/// A texel as a fetch gives it: absent channels are 0, and alpha is 1.
std::string as_fetched(const std::string& value, gpu::TextureFormat format) {
    const int channels = gpu::channel_count(format);
    if (channels == 4) return value;
    const bool is_integer = gpu::is_integer(format);
    const std::string type = is_integer ? (gpu::is_signed_integer(format) ? "ivec4" : "uvec4") : "vec4";
    return type + "(" + value + (channels == 1 ? ", 0, 0, 1)" : ", 0, 1)");
}

class FusedAssembler {
public:
    FusedAssembler(const FusedProgram& program, Diagnostics& diagnostics)
        : program_(program), diagnostics_(diagnostics) {}

    ShaderSource assemble() {
        add("#version 450 core");
        for (std::size_t i = 0; i < program_.parts.size(); ++i) add_part(int(i));
        for (std::size_t i = 0; i < program_.targets.size(); ++i)
            add("layout(location = " + std::to_string(i) + ") out " + texel_type(format_of(target(i))) + " " +
                target_name(i) + ";");
        add("void main() {");
        for (std::size_t i = 0; i < program_.parts.size(); ++i) call_part(int(i));
        for (std::size_t i = 0; i < program_.targets.size(); ++i)
            add(target_name(i) + " = " + result(target(i).part, target(i).write) + ";");
        add("}");
        return std::move(source_);
    }

private:
    static std::string prefix(int part) { return "fused" + std::to_string(part) + "_"; }
    static std::string target_name(std::size_t index) { return "fused_target_" + std::to_string(index); }
    static std::string result(int part, const std::string& write) { return prefix(part) + "out_" + write; }
    const FusedTarget& target(std::size_t index) const { return program_.targets[index]; }
    gpu::TextureFormat format_of(const FusedTarget& target) const {
        return format_of_write(*program_.parts[std::size_t(target.part)].shader.manifest, target.write);
    }

    void add(const std::string& line) {
        source_.text += line + "\n";
        source_.lines.push_back({"<generated>", 1});
    }

    void add_part(int index) {
        const FusedShader& part = program_.parts[std::size_t(index)];
        ShaderSource text = text_of(part.shader, part.part, diagnostics_);
        const std::vector<Token> tokens = all_glsl_tokens(text);
        const GlobalNames names(tokens);
        for (const std::string& name : names.declared)
            if (!names.macros.contains(name)) add("#define " + name + " " + prefix(index) + name);
        // Its version stands at the top already.
        text.text.erase(0, text.text.find('\n'));
        source_.text += text.text;
        source_.lines.insert(source_.lines.end(), text.lines.begin(), text.lines.end());
        for (const std::string& name : names.declared) add("#undef " + name);
        for (const std::string& name : names.macros) add("#undef " + name);
    }

    void call_part(int index) {
        for (const HeldRead& held : program_.parts[std::size_t(index)].held)
            add(prefix(index) + held.read + " = " +
                as_fetched(result(held.part, held.write), format_of({held.part, held.write})) + ";");
        add(prefix(index) + "main();");
    }

    const FusedProgram& program_;
    Diagnostics& diagnostics_;
    ShaderSource source_;
};

}  // namespace

std::string fault_of_fusing(const ShaderContext& shader) {
    Diagnostics faults;
    const ShaderSource source = text_of(shader, {}, faults);
    const std::vector<Token> tokens = all_glsl_tokens(source);
    if (faults.has_errors()) return "its shader has faults";
    const GlobalNames names(tokens);
    if (names.has_extension) return "its shader has an #extension";
    if (names.macros.contains("main")) return "its shader has a macro main";
    std::map<std::string_view, int> uses_of_targets;
    for (const Token& token : tokens) {
        if (token.text == "discard") return "its shader may discard a pixel";
        if (token.text.starts_with("out_")) ++uses_of_targets[token.text];
    }
    for (const WriteSpec& write : pass_bindings(shader).writes)
        if (uses_of_targets["out_" + write.name] < 2)
            return "its shader writes nothing to '" + write.name + "'";
    for (const std::string& name : names.declared) {
        if (is_swizzle(name)) return "its shader has the global name '" + name + "'";
        if (names.tested.contains(name) || name.starts_with("gl_"))
            return "its shader has '" + name + "' in a directive or as GLSL's own";
    }
    return "";
}

std::vector<int> unused_blocks(const ShaderContext& shader) {
    Diagnostics faults;
    std::set<std::string_view> named, sizes;
    int at = 0;
    const ShaderSource source = text_of(shader, {}, faults);
    const std::vector<Token> tokens = all_glsl_tokens(source);
    for (const Token& token : tokens) {
        const bool is_used = std::size_t(++at) < tokens.size() && tokens[std::size_t(at)].text == ".";
        if (is_used) named.insert(token.text);
        // The block of sizes declares each once.
        if (token.text.ends_with("_size") && !sizes.insert(token.text).second) named.insert("_size");
    }
    std::vector<int> unused;
    for (const NamedBlock& block : kNamedBlocks)
        if (!named.contains(block.name)) unused.push_back(block.binding);
    if (!named.contains("_size")) unused.push_back(kSizeBinding);
    return unused;
}

ShaderSource assemble_fused(const FusedProgram& program, Diagnostics& diagnostics) {
    return FusedAssembler(program, diagnostics).assemble();
}

}  // namespace aftershade
