#include "framework/effect/lint.h"

#include <algorithm>
#include <map>
#include <set>

#include "framework/base/option.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/isf/isf_types.h"
#include "framework/effect/shader_source.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

class Linter {
public:
    Linter(const EffectManifest& manifest, const std::filesystem::path& glsl_folder, Diagnostics& diagnostics)
        : manifest_(manifest), glsl_folder_(glsl_folder), diagnostics_(diagnostics) {
        ParamSet defaults;
        for (const ParamSpec& spec : manifest.params) defaults.set(spec.name, spec.default_value);
        std::vector<std::string> inputs;
        for (const InputSpec& input : manifest.inputs) inputs.push_back(input.name);
        Diagnostics faults;
        for (const PassSpec& pass : manifest.passes) {
            if (!pass.runs_shader()) continue;
            const ShaderContext context{&manifest, &pass, defaults, inputs, glsl_folder};
            const ShaderSource& source = sources_[pass.name] = assemble_shader(context, faults);
            tokens_[pass.name] = glsl_tokens(source);
        }
    }

    void lint() {
        unused_textures();
        narrow_formats();
        if (manifest_.has_history()) {
            history_validity();
            warmup();
        }
        encodings();
        loops();
    }

private:
    /// A texture that nobody reads, and no statistic is of, can only be tapped: no output depends on it.
    void unused_textures() {
        for (const TextureSpec& texture : manifest_.textures) {
            const auto reads = [&](const PassSpec& pass) {
                const auto names = [&](const auto& use) { return use.name == texture.name; };
                return std::any_of(pass.reads.begin(), pass.reads.end(), names) ||
                       std::any_of(pass.images.begin(), pass.images.end(), [&](const AccessSpec& use) {
                           return names(use) && use.kind != AccessSpec::Kind::write;
                       });
            };
            const auto tells = [&](const TelemetrySpec& spec) {
                return spec.of.texture == texture.name || (spec.where && spec.where->texture == texture.name);
            };
            if (std::none_of(manifest_.passes.begin(), manifest_.passes.end(), reads) &&
                std::none_of(manifest_.telemetry.begin(), manifest_.telemetry.end(), tells))
                diagnostics_.warning(texture.place,
                                     "no pass reads the texture '" + texture.name +
                                         "'; it is written only for a tap (let a statistic under 'telemetry' "
                                         "measure it, or remove it)");
        }
    }

    static bool is_exact(RoleKind kind) {
        return kind == RoleKind::distance || kind == RoleKind::motion || kind == RoleKind::place ||
               kind == RoleKind::id;
    }

    /// A half has 11 bits: at 100 m it steps by 6 cm, at 1000 px by 1 px.
    void narrow_formats() {
        for (const PassSpec& pass : manifest_.passes) {
            const auto exact = [&](const ReadSpec& read) {
                const InputSpec* input = manifest_.find_input(read.name);
                return input && is_exact(kind_of_role(input->role));
            };
            if (pass.reads.empty() || !std::all_of(pass.reads.begin(), pass.reads.end(), exact)) continue;
            for (const WriteSpec& write : pass.writes) {
                const TextureSpec* texture = manifest_.find_texture(write.name);
                if (!texture) continue;
                const std::string format{gpu::texture_format_name(texture->format)};
                if (format.ends_with("16f") || format.ends_with("8"))
                    diagnostics_.warning(
                        texture->place,
                        "the texture '" + texture->name + "' is made from " + pass.reads[0].name +
                            " but has the format " + format +
                            ", which keeps 11 bits or fewer; r32f or rg32f keeps what it holds");
            }
        }
    }

    void history_validity() {
        for (const auto& [pass, tokens] : tokens_)
            if (has_member(tokens, "frame", "history_valid")) return;
        diagnostics_.warning({manifest_.document.string()},
                             "the effect has history, but no shader reads frame.history_valid: after a cut "
                             "it would blend with nothing");
    }

    /// An effect that accumulates sub-frames needs no warm-up: each frame starts from nothing.
    void warmup() {
        if (manifest_.warmup || manifest_.accumulates_subframes) return;
        const bool is_isf = is_isf_path(manifest_.document);
        diagnostics_.warning(
            {manifest_.document.string()},
            "the effect has history, but declares no warmup: a chunk of a sequence begins "
            "without the frames before it, and shows a seam (" +
                std::string(is_isf ? "import the file and " : "") +
                "add \"warmup\": {\"frames\": N, \"error\": E}" +
                advice("; aftershade check LOOK ", Option::warmup, "CAPTURE", " measures them") + ")");
    }

    static bool has_member(const std::vector<Token>& tokens, const std::string& block,
                           const std::string& name) {
        for (std::size_t i = 2; i < tokens.size(); ++i)
            if (tokens[i - 2].text == block && tokens[i - 1].text == "." && tokens[i].text == name)
                return true;
        return false;
    }

    void encodings() {
        const auto is_display = [](const OutputSpec& output) {
            return kind_of_role(output.role) == RoleKind::display;
        };
        if (std::any_of(manifest_.outputs.begin(), manifest_.outputs.end(), is_display)) return;
        // Kinds of ways to write 1 / 2.2 and 1 / 2.4.
        static const std::set<std::string> exponents{"0.4545",  "0.45454545", "0.416666",
                                                     "0.41666", "2.2",        "2.4"};
        std::set<std::string> told;
        for (const auto& [pass, tokens] : tokens_)
            for (std::size_t i = 0; i < tokens.size(); ++i) {
                const Token& token = tokens[i];
                // A shared module may hold the curve; using it is what counts.
                if (token.file->starts_with(glsl_folder_.string() + "/")) continue;
                if (token.text == "encode_srgb" && i + 1 < tokens.size() && tokens[i + 1].text == "(" &&
                    told.insert(to_string(token.place())).second)
                    diagnostics_.warning(token.place(),
                                         "sRGB is encoded, but no output is display: effects "
                                         "work in scene-linear light");
                if (token.text == "pow" && encodes(tokens, i, exponents) &&
                    told.insert(to_string(token.place())).second)
                    diagnostics_.warning(token.place(),
                                         "this looks like a gamma of 2.2 or 2.4, but no output is "
                                         "display: effects work in scene-linear light");
            }
    }

    /// Whether one of the exponents stands among the arguments of the call at `i`.
    static bool encodes(const std::vector<Token>& tokens, std::size_t i,
                        const std::set<std::string>& exponents) {
        int depth = 0;
        for (std::size_t at = i + 1; at < tokens.size(); ++at) {
            if (tokens[at].text == "(") ++depth;
            if (tokens[at].text == ")" && --depth == 0) return false;
            std::string number(tokens[at].text);
            // A number is one token up to its point.
            if (at + 2 < tokens.size() && tokens[at + 1].text == ".")
                number.append(".").append(tokens[at + 2].text);
            if (exponents.contains(number)) return true;
        }
        return false;
    }

    /// for (...; i < param.taps; ...) in a pass that does not say how often.
    void loops() {
        for (const PassSpec& pass : manifest_.passes) {
            if (pass.max_iterations > 0 || !tokens_.contains(pass.name)) continue;
            const std::vector<Token>& tokens = tokens_.at(pass.name);
            for (std::size_t i = 0; i < tokens.size(); ++i) {
                if (tokens[i].text != "for") continue;
                int depth = 0;
                for (std::size_t at = i + 1; at < tokens.size(); ++at) {
                    if (tokens[at].text == "(") ++depth;
                    if (tokens[at].text == ")" && --depth == 0) break;
                    if (tokens[at].text != "param") continue;
                    diagnostics_.warning(tokens[i].place(),
                                         "a parameter bounds this loop; set \"max_iterations\" in pass '" +
                                             pass.name + "': llvmpipe silently ends loops after 65,535");
                    return;
                }
            }
        }
    }

    const EffectManifest& manifest_;
    const std::filesystem::path& glsl_folder_;
    Diagnostics& diagnostics_;
    std::map<std::string, ShaderSource> sources_;       // by pass
    std::map<std::string, std::vector<Token>> tokens_;  // by pass, views of the sources
};

}  // namespace

void lint_effect(const EffectManifest& manifest, const std::filesystem::path& glsl_folder,
                 Diagnostics& diagnostics) {
    Linter(manifest, glsl_folder, diagnostics).lint();
}

}  // namespace aftershade
