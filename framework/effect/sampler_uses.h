// The use of samplers in the text of a shader: those from which it only fetches single texels, including
// through functions and macros.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "framework/effect/glsl_tokens.h"

namespace aftershade {

/// "usampler2DArray" is {"u", "2DArray"}.
struct SamplerType {
    std::string_view prefix, shape;
};
/// The type that the word names, for 2-D samplers and arrays of them.
std::optional<SamplerType> sampler_type(std::string_view word);

/// texelFetch(name, p, 0) or textureSize(name, 0), by places among the tokens.
struct LevelZeroCall {
    std::size_t call = 0, name = 0, comma = 0, level = 0;
};

/// A uniform sampler, a parameter of a function, or a macro that stands for one of them.
struct SamplerVariable {
    SamplerType type;
    int binding = -1;          ///< of a uniform
    std::size_t declared = 0;  ///< token of a parameter's type, or the semicolon behind a uniform
    std::vector<LevelZeroCall> fetches{}, sizes{};
    std::vector<std::size_t> handed_on{};  ///< where its name alone is an argument or what a macro stands for
    bool is_only_fetched = true;           ///< has no use but `fetches`, `sizes` and `handed_on`
    bool is_redefined = false;             ///< its name may mean something else
    int linked_to = -1;                    ///< another one that its texture reaches, or from which it comes

    bool is_uniform() const { return binding >= 0; }
};

/// Understands what it has to, and takes any other use for one that needs a sampler.
class SamplerUses {
public:
    explicit SamplerUses(const std::vector<Token>& tokens);

    const std::vector<SamplerVariable>& variables() const { return variables_; }
    /// The same for all that are linked, directly or through others.
    int set_of(int variable) const;
    /// Whether all of the set are only fetched.
    bool is_only_fetched(int set) const;

private:
    struct Parameter {
        std::string_view name;
        int variable = -1;  // -1: no sampler
    };
    struct Function {
        std::size_t name = 0, end = 0;  // tokens: its name, and what ends its body or its declaration
        std::vector<Parameter> parameters;
    };
    struct Call {
        std::size_t callee = 0;  // or the bracket, where nothing is called
        int argument = 0;
    };

    bool is(std::size_t at, std::string_view text) const;
    void find_functions();
    std::size_t read_function(std::size_t name);
    std::optional<std::size_t> closing(std::size_t open) const;
    void read_directive(std::size_t& at);
    void alias(std::size_t meaning, int variable);
    void read_word(std::size_t at);
    bool declare_uniform(std::size_t at);
    void use(std::size_t at, int variable);
    std::optional<LevelZeroCall> level_zero_call(std::size_t call, std::size_t name) const;
    void check_arguments(std::size_t callee);
    bool is_sampler_or_absent(std::size_t at) const;
    int resolve(std::size_t at) const;
    void link(int a, int b);
    int root_of(int variable);

    const std::vector<Token>& tokens_;
    std::vector<SamplerVariable> variables_;
    std::vector<Function> functions_;
    std::multimap<std::string_view, std::size_t> functions_by_name_;
    std::map<std::string_view, int> named_;                       // uniforms and macros
    std::multimap<std::string_view, std::size_t> early_aliases_;  // tokens of what macros stand for, by name
    std::set<std::string_view> shadows_;                          // of the function at hand
    std::set<std::string_view> unknown_;  // macros and samplers that no variable stands for
    const Function* function_ = nullptr;
    std::vector<Call> calls_;
};

}  // namespace aftershade
