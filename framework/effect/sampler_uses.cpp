#include "framework/effect/sampler_uses.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace aftershade {

namespace {

// Bounds of what a stranger's shader may cost; beyond them it keeps its samplers.
constexpr int kMaxDepth = 64;      // of brackets
constexpr int kMaxOverloads = 16;  // definitions and declarations of one name

}  // namespace

std::optional<SamplerType> sampler_type(std::string_view word) {
    const std::size_t at = word.find("sampler2D");
    if (at > 1 || (at == 1 && word[0] != 'u' && word[0] != 'i')) return std::nullopt;
    const std::string_view shape = word.substr(at + std::string_view("sampler").size());
    if (shape != "2D" && shape != "2DArray") return std::nullopt;
    return SamplerType{word.substr(0, at), shape};
}

SamplerUses::SamplerUses(const std::vector<Token>& tokens) : tokens_(tokens) {
    find_functions();
    std::size_t next = 0;  // of the functions
    for (std::size_t at = 0; at < tokens_.size(); ++at) {
        if (function_ && at >= function_->end) function_ = nullptr;
        if (next < functions_.size() && at == functions_[next].name) {
            function_ = &functions_[next++];
            shadows_.clear();
            at = *closing(at + 1);
            continue;
        }
        const std::string_view text = tokens_[at].text;
        if (text == "#") read_directive(at);
        else if (text == "(") calls_.push_back({at > 0 && tokens_[at - 1].is_word() ? at - 1 : at});
        else if (text == ")" && !calls_.empty()) calls_.pop_back();
        else if (text == "," && !calls_.empty()) ++calls_.back().argument;
        else if (text == ";" || text == "{" || text == "}") calls_.clear();
        else if (tokens_[at].is_word()) read_word(at);
    }
    for (int i = 0; i < int(variables_.size()); ++i) root_of(i);
}

int SamplerUses::root_of(int variable) {
    int root = variable;
    while (variables_[std::size_t(root)].linked_to >= 0) root = variables_[std::size_t(root)].linked_to;
    while (variable != root) variable = std::exchange(variables_[std::size_t(variable)].linked_to, root);
    return root;
}

int SamplerUses::set_of(int variable) const {
    const int root = variables_[std::size_t(variable)].linked_to;
    return root < 0 ? variable : root;
}

bool SamplerUses::is_only_fetched(int set) const {
    for (int i = 0; i < int(variables_.size()); ++i) {
        const SamplerVariable& variable = variables_[std::size_t(i)];
        if (set_of(i) == set && (!variable.is_only_fetched || variable.is_redefined)) return false;
    }
    return true;
}

bool SamplerUses::is(std::size_t at, std::string_view text) const {
    return at < tokens_.size() && tokens_[at].text == text;
}

void SamplerUses::link(int a, int b) {
    a = root_of(a);
    b = root_of(b);
    if (a != b) variables_[std::size_t(a)].linked_to = b;
}

/// The bracket that closes the one at `open`; nullopt where a statement ends before, or where brackets lie so
/// deep that looking for the end of each would take long.
std::optional<std::size_t> SamplerUses::closing(std::size_t open) const {
    int depth = 0;
    for (std::size_t at = open; at < tokens_.size(); ++at) {
        const std::string_view text = tokens_[at].text;
        if (text == "(" && ++depth > kMaxDepth) return std::nullopt;
        if (text == ")" && --depth == 0) return at;
        if (text == ";" || text == "{" || text == "#") return std::nullopt;
    }
    return std::nullopt;
}

/// Outside of braces, "vec4 blur(usampler2D image, ivec2 p) {" or the same with a semicolon.
void SamplerUses::find_functions() {
    BraceDepth braces;
    for (std::size_t at = 0; at < tokens_.size(); ++at) {
        const std::string_view text = tokens_[at].text;
        if (text == "#") {
            braces.pass_directive(at + 1 < tokens_.size() ? tokens_[at + 1].text : "");
            while (at + 1 < tokens_.size() && tokens_[at + 1].line == tokens_[at].line) ++at;
        } else if (text == "{") {
            braces.open();
        } else if (text == "}") {
            braces.close();
            if (braces.value() == 0 && !functions_.empty() && functions_.back().end == tokens_.size())
                functions_.back().end = at;
        } else if (braces.value() == 0 && text == "(" && at > 1 && tokens_[at - 1].is_word() &&
                   tokens_[at - 2].is_word()) {
            at = read_function(at - 1);
        }
    }
}

/// Returns the last token that it took.
std::size_t SamplerUses::read_function(std::size_t name) {
    const auto end = closing(name + 1);
    if (!end || !(is(*end + 1, "{") || is(*end + 1, ";"))) return name + 1;
    Function function{name, is(*end + 1, "{") ? tokens_.size() : *end + 1, {}};
    for (std::size_t at = name + 2, type = 0; at <= *end; ++at) {
        if (sampler_type(tokens_[at].text)) type = at;
        if (at < *end && !is(at, ",")) continue;
        Parameter parameter{at > name + 2 ? tokens_[at - 1].text : "", -1};
        if (type) {
            parameter.variable = int(variables_.size());
            variables_.push_back({*sampler_type(tokens_[type].text), -1, type});
            // Anything but "usampler2D image" is left as it is.
            if (type + 2 != at) variables_.back().is_only_fetched = false;
        }
        function.parameters.push_back(parameter);
        type = 0;
    }
    const auto [from, to] = functions_by_name_.equal_range(tokens_[name].text);
    const bool is_one_too_many = std::distance(from, to) >= kMaxOverloads;
    for (auto other = from; other != to; ++other) {
        const auto& its = functions_[other->second].parameters;
        for (std::size_t i = 0; i < std::min(its.size(), function.parameters.size()); ++i)
            if (its[i].variable >= 0 && function.parameters[i].variable >= 0)
                link(its[i].variable, function.parameters[i].variable);
    }
    if (is_one_too_many)
        for (const auto* parameters : {&function.parameters, &functions_[from->second].parameters})
            for (const Parameter& parameter : *parameters)
                if (parameter.variable >= 0)
                    variables_[std::size_t(parameter.variable)].is_only_fetched = false;
    if (!is_one_too_many) functions_by_name_.emplace(tokens_[name].text, functions_.size());
    functions_.push_back(std::move(function));
    return *end;
}

/// "#define FROM light" makes FROM another name; what a longer macro does counts where it is defined.
void SamplerUses::read_directive(std::size_t& at) {
    const int line = tokens_[at].line;
    std::size_t end = at;
    while (end < tokens_.size() && tokens_[end].line == line) ++end;
    const std::size_t name = at + 2;
    // A fused program's parts end with it: the next may have a sampler of that name.
    if (is(at + 1, "undef") && name < end) named_.erase(tokens_[name].text);
    if (!is(at + 1, "define") || name >= end) {
        at = end - 1;
        return;
    }
    const std::string_view macro = tokens_[name].text;
    unknown_.insert(macro);
    if (const auto old = named_.find(macro);
        old != named_.end() && variables_[std::size_t(old->second)].is_uniform())
        variables_[std::size_t(old->second)].is_redefined = true;
    at = name;
    if (name + 2 == end && tokens_[name + 1].is_word()) {
        at = name + 1;
        if (const int aliased = resolve(at); aliased >= 0) alias(at, aliased);
        else early_aliases_.emplace(tokens_[at].text, at);  // a manifest's defines stand before its samplers
    } else if (name + 1 < end && is(name + 1, "(") &&
               tokens_[name + 1].column == tokens_[name].column + int(macro.size())) {
        const auto close = closing(name + 1);
        for (std::size_t i = name + 2; i < end && close && i < *close; ++i)
            if (const int own = resolve(i); own >= 0) variables_[std::size_t(own)].is_redefined = true;
        at = close && *close < end ? *close : end - 1;
    }
    calls_.clear();
}

/// "#define FROM light", by the token of what it stands for.
void SamplerUses::alias(std::size_t meaning, int variable) {
    const std::string_view macro = tokens_[meaning - 1].text;
    const auto [named, is_new] = named_.try_emplace(macro, int(variables_.size()));
    unknown_.erase(macro);
    if (is_new) variables_.push_back({variables_[std::size_t(variable)].type});
    link(named->second, variable);
    variables_[std::size_t(variable)].handed_on.push_back(meaning);
}

void SamplerUses::read_word(std::size_t at) {
    if (declare_uniform(at)) return;
    if (at > 0 && is(at - 1, ".")) return;
    if (is(at + 1, "(") && functions_by_name_.contains(tokens_[at].text)) return check_arguments(at);
    const int variable = resolve(at);
    if (variable < 0) return;
    const bool is_declared =
        at > 0 && tokens_[at - 1].may_be_type() && tokens_[at - 1].line == tokens_[at].line;
    if (is_declared && !function_) return;
    if (is_declared) {
        shadows_.insert(tokens_[at].text);
        if (!variables_[std::size_t(variable)].is_uniform())
            variables_[std::size_t(variable)].is_redefined = true;
        return;
    }
    use(at, variable);
}

/// "layout(binding = 3) uniform sampler2D depth;"
bool SamplerUses::declare_uniform(std::size_t at) {
    const auto type = function_ ? std::nullopt : sampler_type(tokens_[at].text);
    if (type && at + 1 < tokens_.size()) unknown_.insert(tokens_[at + 1].text);
    if (!type || at < 7 || !is(at - 1, "uniform") || !is(at - 2, ")") || !is(at - 4, "=") ||
        !is(at - 5, "binding") || !is(at - 6, "(") || !is(at - 7, "layout") || !is(at + 2, ";"))
        return false;
    int binding = -1;
    const std::string_view number = tokens_[at - 3].text;
    std::from_chars(number.data(), number.data() + number.size(), binding);
    // Of a fused program's parts, each has its own of a name.
    named_[tokens_[at + 1].text] = int(variables_.size());
    variables_.push_back({*type, binding, at + 2});
    const auto [from, to] = early_aliases_.equal_range(tokens_[at + 1].text);
    for (auto early = from; early != to; ++early) alias(early->second, named_.at(tokens_[at + 1].text));
    return true;
}

void SamplerUses::use(std::size_t at, int variable) {
    SamplerVariable& used = variables_[std::size_t(variable)];
    const bool is_alone =
        at > 0 && (is(at - 1, "(") || is(at - 1, ",")) && (is(at + 1, ",") || is(at + 1, ")"));
    if (!is_alone || calls_.empty()) {
        used.is_only_fetched = false;
        return;
    }
    const Call& call = calls_.back();
    const std::string_view callee = tokens_[call.callee].text;
    if (call.argument == 0 && (callee == "texelFetch" || callee == "textureSize")) {
        if (const auto found = level_zero_call(call.callee, at))
            return (callee == "texelFetch" ? used.fetches : used.sizes).push_back(*found);
    } else if (const auto [from, to] = functions_by_name_.equal_range(callee); from != to) {
        bool is_taken = false;
        for (auto each = from; each != to; ++each) {
            const auto& parameters = functions_[each->second].parameters;
            if (call.argument >= int(parameters.size())) continue;
            const int parameter = parameters[std::size_t(call.argument)].variable;
            if (parameter < 0) continue;
            link(variable, parameter);
            is_taken = true;
        }
        if (is_taken) return used.handed_on.push_back(at);
    }
    used.is_only_fetched = false;
}

std::optional<LevelZeroCall> SamplerUses::level_zero_call(std::size_t call, std::size_t name) const {
    const auto end = closing(call + 1);
    if (!end || !is(*end - 1, "0") || !is(*end - 2, ",")) return std::nullopt;
    const bool is_fetch = tokens_[call].text == "texelFetch";
    if (is_fetch != (*end - 2 > name + 1)) return std::nullopt;
    return LevelZeroCall{call, name, *end - 2, *end - 1};
}

/// An argument that is no sampler's name alone (a macro's, say) leaves its parameter a sampler.
void SamplerUses::check_arguments(std::size_t callee) {
    std::vector<std::size_t> begins = {callee + 2};
    const auto end = closing(callee + 1);
    int depth = 0;
    for (std::size_t at = callee + 1; end && at < *end; ++at) {
        if (is(at, "(")) ++depth;
        else if (is(at, ")")) --depth;
        else if (is(at, ",") && depth == 1) begins.push_back(at + 1);
    }
    if (end) begins.push_back(*end + 1);
    const auto [from, to] = functions_by_name_.equal_range(tokens_[callee].text);
    for (auto each = from; each != to; ++each) {
        const auto& parameters = functions_[each->second].parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            if (parameters[i].variable < 0) continue;
            const bool is_name = end && begins.size() == parameters.size() + 1 &&
                                 begins[i] + 2 == begins[i + 1] && is_sampler_or_absent(begins[i]);
            if (!is_name) variables_[std::size_t(parameters[i].variable)].is_only_fetched = false;
        }
    }
}

/// A name that nothing declares stands in a branch that the preprocessor leaves out.
bool SamplerUses::is_sampler_or_absent(std::size_t at) const {
    if (!tokens_[at].is_word()) return false;
    const bool is_local =
        function_ && std::ranges::any_of(function_->parameters, [&](const Parameter& parameter) {
            return parameter.name == tokens_[at].text;
        });
    return resolve(at) >= 0 || !(is_local || unknown_.contains(tokens_[at].text));
}

/// The variable that a word means; -1: none.
int SamplerUses::resolve(std::size_t at) const {
    const std::string_view word = tokens_[at].text;
    if (function_) {
        if (shadows_.contains(word)) return -1;
        for (const Parameter& parameter : function_->parameters)
            if (parameter.name == word) return parameter.variable;
    }
    const auto found = named_.find(word);
    return found == named_.end() ? -1 : found->second;
}

}  // namespace aftershade
