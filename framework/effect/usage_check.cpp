#include "framework/effect/usage_check.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "framework/document/formula.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/manifest/manifest_when.h"
#include "framework/effect/shader_source.h"
#include "framework/effect/shader_uses.h"

namespace aftershade {

namespace {

using Uses = ShaderUses::Uses;

class UsageChecker {
public:
    UsageChecker(const EffectManifest& manifest, const std::filesystem::path& glsl_folder,
                 Diagnostics& diagnostics)
        : manifest_(manifest), glsl_folder_(glsl_folder), diagnostics_(diagnostics) {
        for (const ParamSpec& spec : manifest.params) defaults_.set(spec.name, spec.default_value);
        for (const InputSpec& input : manifest.inputs) inputs_.push_back(input.name);
    }

    void check() {
        const int errors_before = diagnostics_.error_count();
        for (const PassSpec& pass : manifest_.passes)
            for (const std::string& file : files_of(pass)) read_shader(pass, file);
        // Without its text nothing can be said of a shader.
        if (diagnostics_.error_count() > errors_before) return;
        for (const PassSpec& pass : manifest_.passes) check_pass(pass);
        for (const auto& [file, uses] : shaders_) check_shader(file, uses);
        check_params();
        check_lights();
        if (manifest_.native) check_native(*manifest_.native);
    }

private:
    /// Paths: an effect and its modules may have files of one name.
    static std::vector<std::string> files_of(const PassSpec& pass) {
        std::vector<std::string> files;
        for (const std::string& name : pass.shader_files()) files.push_back((pass.folder / name).string());
        return files;
    }

    void read_shader(const PassSpec& pass, const std::string& file) {
        if (shaders_.contains(file)) return;
        const ShaderContext context{&manifest_, &pass, defaults_, inputs_, glsl_folder_};
        const auto which = file == pass.folder / pass.shader ? ShaderFile::main : ShaderFile::vertex;
        shaders_.emplace(file, ShaderUses(assemble_shader(context, diagnostics_, which)));
    }

    bool pass_has(const PassSpec& pass, const std::string& word) const {
        const auto files = files_of(pass);
        const auto in_text = [&](const std::string& name) {
            return std::any_of(files.begin(), files.end(), [&](const std::string& file) {
                return shaders_.at(file).words.contains(name);
            });
        };
        // A pass may hand a shared shader its own name for a thing: "defines": {"LIST": "bright_list"}.
        return in_text(word) ||
               std::any_of(pass.defines.begin(), pass.defines.end(), [&](const auto& define) {
                   return define.second == word && in_text(define.first);
               });
    }
    /// Whether the fragment shader has this word, but nowhere as what a statement changes. What stands behind
    /// a macro's name counts as changed.
    bool reads_only(const PassSpec& pass, const std::string& word) const {
        const ShaderUses& uses = shaders_.at((pass.folder / pass.shader).string());
        return uses.words.contains(word) && !uses.written.contains(word);
    }
    bool any_has(const std::string& word) const {
        return std::any_of(shaders_.begin(), shaders_.end(),
                           [&](const auto& shader) { return shader.second.words.contains(word); });
    }

    void check_pass(const PassSpec& pass) {
        if (pass.shader_files().empty()) return;  // a clear, or the tiles of a texture: the host's text
        const TileListSpec* tiles = manifest_.tile_list_of(pass);
        if (pass.lists() && !pass_has(pass, tiles->name))
            diagnostics_.error(tiles->place, "tile list '" + tiles->name + "': its predicate '" +
                                                 pass.shader + "' has no function 'bool " + tiles->name +
                                                 "(ivec2 tile)'");
        const auto unused = [&](const Place& place, const std::string& what) {
            diagnostics_.error(place, "pass '" + pass.name +
                                          "': " + list_of_names(pass.shader_files(), "and") + " " +
                                          (pass.vertex() ? "do" : "does") + " not use " + what);
        };
        for (const ReadSpec& read : pass.reads)
            if (!pass_has(pass, read.glsl_name()) && !pass_has(pass, read.glsl_name() + "_size"))
                unused(read.place, "its read '" + read.glsl_name() + "'");
        check_pixel_reads(pass);
        for (const AccessSpec& image : pass.images)
            if (!pass_has(pass, image.name)) unused(image.place, "its image '" + image.name + "'");
        for (const AccessSpec& buffer : pass.buffers) {
            const bool is_host = tiles && (buffer.name == tiles->runs() || buffer.name == tiles->args());
            if (!is_host && !pass_has(pass, buffer.glsl_name()))
                unused(buffer.place, "its buffer '" + buffer.glsl_name() + "'");
        }
        for (const WriteSpec& write : pass.writes)
            if (!pass_has(pass, std::string(kOut) + write.name))
                unused(write.place, "its target 'out_" + write.name + "'");
            else if (reads_only(pass, std::string(kOut) + write.name))
                diagnostics_.error(write.place, "pass '" + pass.name + "': '" + pass.shader + "' has 'out_" +
                                                    write.name + "' but assigns nothing to it, so that '" +
                                                    write.name +
                                                    "' is undefined; assign to it, or take it from 'writes'");
    }

    /// A read by the pixel has no sampler; only what looks at neighbouring pixels could still see others.
    void check_pixel_reads(const PassSpec& pass) {
        const auto reads_pixel = [](const ReadSpec& read) { return read.is_pixel; };
        const ShaderUses& uses = shaders_.at((pass.folder / pass.shader).string());
        for (const ReadSpec& read : pass.reads)
            if (const auto use = uses.samplers.find(read.glsl_name());
                read.is_pixel && use != uses.samplers.end())
                once(use->second, "pass '" + pass.name + "' reads '" + read.glsl_name() +
                                      "' by the pixel: it is the texel itself, no sampler; write '" +
                                      read.glsl_name() + "', or read it without \"pixel\"");
        if (std::none_of(pass.reads.begin(), pass.reads.end(), reads_pixel)) return;
        std::set<std::string> looking;
        for (const std::string_view word : uses.words)
            if (word.starts_with("dFd") || word.starts_with("fwidth") || word.starts_with("aftershade_"))
                looking.emplace(word);
        for (const std::string& word : looking)
            once(pass.place, "pass '" + pass.name + "' reads by the pixel, but its shader has '" + word +
                                 "', by which it could see other pixels");
    }

    /// Passes may share a shader, whose #if branches then use what only one of them declares.
    void check_shader(const std::string& file, const ShaderUses& uses) {
        std::vector<std::string> targets, meant;
        for (const PassSpec& pass : manifest_.passes) {
            if (pass.folder / pass.shader != file) continue;
            for (const WriteSpec& write : pass.writes) {
                targets.push_back(std::string(kOut) + write.name);
                if (has_size_of_target(manifest_, write)) targets.push_back(targets.back() + "_size");
            }
            if (pass.infers_writes) meant = all_targets();
        }
        meant.insert(meant.end(), targets.begin(), targets.end());
        for (const auto& [name, place] : uses.outputs) {
            const std::string word = std::string(kOut) + name;
            if (std::find(targets.begin(), targets.end(), word) == targets.end())
                once(place,
                     "'" + word + "' is not a target of a pass with this shader" + did_you_mean(word, meant));
        }
        for (const auto& [name, place] : uses.unset)
            once(place,
                 "'" + name + "' is read, but nothing is assigned to it, so that its value is undefined");
        for (const auto& [name, place] : uses.params) check_member(name, place);
        for (const auto& [name, place] : uses.natives) check_native_member(name, place);
    }

    std::vector<std::string> all_targets() const {
        std::vector<std::string> targets;
        for (const OutputSpec& output : manifest_.outputs) targets.push_back(std::string(kOut) + output.name);
        for (const TextureSpec& texture : manifest_.textures)
            targets.push_back(std::string(kOut) + texture.name);
        return targets;
    }

    void check_member(const std::string& name, const Place& place) {
        const ParamSpec* spec = manifest_.find_param(name);
        const std::string word = "'param." + name + "' ";
        if (!spec)
            once(place,
                 word + "is not a parameter of the effect" + did_you_mean(name, manifest_.param_names()));
        else if (!is_block_type(spec->type))
            once(place, word + "is a " + std::string(param_type_name(spec->type)) + ": write '" + name + "'");
        else if (spec->bind == ParamBind::define)
            once(place, word + "is bound as a define: write '" + upper_case(name) + "'");
    }

    void check_native_member(const std::string& name, const Place& place) {
        std::vector<std::string> known;
        if (manifest_.native)
            for (const NativeUniformSpec& uniform : manifest_.native->uniforms) known.push_back(uniform.name);
        if (std::find(known.begin(), known.end(), name) == known.end())
            once(place, "'native." + name + "' is not declared in 'native'" + did_you_mean(name, known));
    }

    /// A module that many shaders include has its fault once.
    void once(const Place& place, const std::string& text) {
        if (told_.insert(to_string(place) + text).second) diagnostics_.error(place, text);
    }

    void check_params() {
        if (manifest_.native) return;  // its library may be all that uses a parameter
        const std::set<std::string> counted = named_by_manifest();
        for (const ParamSpec& spec : manifest_.params) {
            if (counted.contains(spec.name) || !spec.ocio.empty()) continue;
            if (!is_block_type(spec.type)) {
                if (!any_begins(spec.name)) unused_param(spec, spec.name);
            } else if (spec.bind == ParamBind::define) {
                if (!any_has(upper_case(spec.name))) unused_param(spec, upper_case(spec.name));
            } else if (!any_uses(&ShaderUses::params, spec.name)) {
                unused_param(spec, "param." + spec.name);
            }
        }
    }
    void unused_param(const ParamSpec& spec, const std::string& word) {
        diagnostics_.error(spec.place, "no shader uses '" + word + "'");
    }
    bool any_uses(Uses ShaderUses::*members, const std::string& name) const {
        return std::any_of(shaders_.begin(), shaders_.end(),
                           [&](const auto& shader) { return (shader.second.*members).contains(name); });
    }
    /// A curve, file or table is used by its own name or by functions that begin with it.
    bool any_begins(const std::string& name) const {
        for (const auto& [file, uses] : shaders_)
            for (const std::string_view word : uses.words)
                if (word == name || word.starts_with(name + "_")) return true;
        return false;
    }

    /// Parameters that conditions, sizes and counts take.
    std::set<std::string> named_by_manifest() const {
        std::set<std::string> names;
        const auto add = [&](const CountSpec& count) { names.insert(count.param); };
        for (const TextureSpec& texture : manifest_.textures) {
            add(texture.grid.tile);
            for (const std::string& formula : texture.grid.formula)
                (void)evaluate_formula(formula, [&](std::string_view name) {
                    names.emplace(name);
                    return std::optional(1.0);
                });
        }
        for (const BufferSpec& buffer : manifest_.buffers) {
            add(buffer.count);
            if (buffer.grid) add(buffer.grid->tile);
        }
        const auto add_subjects = [&](const auto& uses) {
            for (const auto& use : uses)
                for (const WhenSpec& condition : use.when) names.insert(name_in_condition(condition.subject));
        };
        add_subjects(manifest_.inputs);
        add_subjects(manifest_.textures);
        add_subjects(manifest_.passes);
        for (const PassSpec& pass : manifest_.passes) {
            add_subjects(pass.reads);
            add_subjects(pass.writes);
            if (pass.repeat) add(*pass.repeat);
            if (pass.compute()) add(pass.compute()->dispatch.tile);
            if (!pass.draw() || !pass.draw()->instances) continue;
            add(pass.draw()->instances->count);
            if (pass.draw()->instances->grid) add(pass.draw()->instances->grid->tile);
        }
        return names;
    }

    void check_lights() {
        bool used = false;
        for (const auto& [file, uses] : shaders_) {
            if (!uses.lights) continue;
            used = true;
            if (!manifest_.uses_lights)
                once(*uses.lights, "'lights' is there only for effects with \"uses\": [\"lights\"]");
        }
        if (manifest_.uses_lights && !used)
            diagnostics_.error(*manifest_.uses_lights, "no shader uses 'lights'");
    }

    void check_native(const NativeSpec& native) {
        for (const NativeUniformSpec& uniform : native.uniforms)
            if (!any_uses(&ShaderUses::natives, uniform.name))
                diagnostics_.error(uniform.place, "no shader uses 'native." + uniform.name + "'");
        for (const NativeTableSpec& table : native.tables)
            if (!any_has(table.name))
                diagnostics_.error(table.place, "no shader uses the native table '" + table.name + "'");
    }

    const EffectManifest& manifest_;
    const std::filesystem::path& glsl_folder_;
    Diagnostics& diagnostics_;
    ParamSet defaults_;
    std::vector<std::string> inputs_;
    std::map<std::string, ShaderUses> shaders_;  // by path
    std::set<std::string> told_;
};

}  // namespace

void check_declared_used(const EffectManifest& manifest, const std::filesystem::path& glsl_folder,
                         Diagnostics& diagnostics) {
    UsageChecker(manifest, glsl_folder, diagnostics).check();
}

}  // namespace aftershade
