#include "framework/effect/manifest_check.h"

#include <algorithm>
#include <set>
#include <utility>

#include "framework/image/role.h"

namespace aftershade {

namespace {

/// Follows the passes in order and remembers what has been written.
class PassChecker {
public:
    PassChecker(const EffectManifest& manifest, Diagnostics& diagnostics)
        : manifest_(manifest), diagnostics_(diagnostics) {
        for (const InputSpec& input : manifest.inputs) readable_.push_back(input.name);
        for (const TextureSpec& texture : manifest.textures) readable_.push_back(texture.name);
        for (const OutputSpec& output : manifest.outputs) writable_.push_back(output.name);
        for (const TextureSpec& texture : manifest.textures) writable_.push_back(texture.name);
    }

    void check(const PassSpec& pass) {
        if (!names_.insert(pass.name).second) fault(pass.place, pass, "another pass has this name");
        if (pass.writes.empty()) fault(pass.place, pass, "writes nothing");
        check_shader_file(pass);
        std::set<std::string> reads, writes;
        for (const ReadSpec& read : pass.reads)
            if (!read.name.empty() && !reads.insert(read.name).second)
                fault(read.place, pass, "reads '" + read.name + "' twice");
        for (const std::string& name : pass.writes)
            if (!writes.insert(name).second) fault(pass.place, pass, "writes '" + name + "' twice");
        check_sizes(pass);
        for (const ReadSpec& read : pass.reads) check_read(pass, read);
        for (const std::string& name : pass.writes) check_write(pass, name);
        for (const WhenSpec& condition : pass.when) check_when(pass, condition);
    }

    void check_all_used() {
        for (const TextureSpec& texture : manifest_.textures)
            if (!written_.contains(texture.name))
                diagnostics_.error(texture.place, "no pass writes the texture '" + texture.name + "'");
        for (const OutputSpec& output : manifest_.outputs)
            if (!written_.contains(output.name))
                diagnostics_.error(output.place, "no pass writes the output '" + output.name + "'");
        for (const InputSpec& input : manifest_.inputs)
            if (!read_.contains(input.name))
                diagnostics_.error(input.place, "no pass reads the input '" + input.name + "'");
    }

private:
    void fault(const Place& place, const PassSpec& pass, const std::string& text) {
        diagnostics_.error(place, "pass '" + pass.name + "': " + text);
    }

    void check_shader_file(const PassSpec& pass) {
        if (pass.shader.empty()) return;
        // A shader is part of its effect: nothing from elsewhere on the disk is read.
        if (pass.shader.find('/') != std::string::npos)
            fault(pass.place, pass, "'shader' is a file name without folders");
        else if (!std::filesystem::is_regular_file(manifest_.folder / pass.shader))
            fault(pass.place, pass, "no file '" + pass.shader + "' in " + manifest_.folder.string());
    }

    void check_read(const PassSpec& pass, const ReadSpec& read) {
        if (read.name.empty()) return;
        read_.insert(read.name);
        const InputSpec* input = manifest_.find_input(read.name);
        const TextureSpec* texture = manifest_.find_texture(read.name);
        if (!input && !texture) {
            fault(read.place, pass,
                  "reads '" + read.name + "', which is no input and no texture" +
                      did_you_mean(read.name, readable_));
            return;
        }
        if (texture && !written_.contains(read.name))
            fault(read.place, pass, "reads '" + read.name + "' before any pass has written it");
        const auto role = input ? find_role(input->role) : std::nullopt;
        const bool filterable = input ? !role || role->filterable : !gpu::is_integer(texture->format);
        if (read.filter == gpu::Filter::linear && !filterable)
            fault(read.place, pass,
                  "'" + read.name + "' cannot be filtered linearly: " +
                      (input ? "its role is " + input->role : "its format is integer"));
    }

    /// One draw has targets of one size.
    void check_sizes(const PassSpec& pass) {
        const auto size = [&](const std::string& name) {
            const TextureSpec* texture = manifest_.find_texture(name);
            if (!texture) return std::pair(1.0, 0);
            return texture->tile > 0 ? std::pair(1.0, texture->tile) : std::pair(texture->scale, 0);
        };
        for (const std::string& name : pass.writes)
            if (size(name) != size(pass.writes.front()))
                fault(pass.place, pass,
                      "writes '" + pass.writes.front() + "' and '" + name + "', which differ in size");
    }

    void check_write(const PassSpec& pass, const std::string& name) {
        if (!manifest_.find_output(name) && !manifest_.find_texture(name)) {
            fault(pass.place, pass,
                  "writes '" + name + "', which is no output and no texture" + did_you_mean(name, writable_));
            return;
        }
        const auto reads_it = [&](const ReadSpec& read) {
            return read.name == name && !manifest_.find_input(name);
        };
        if (std::any_of(pass.reads.begin(), pass.reads.end(), reads_it))
            fault(pass.place, pass, "reads and writes '" + name + "'");
        written_.insert(name);
    }

    void check_when(const PassSpec& pass, const WhenSpec& condition) {
        constexpr std::string_view kHas = "has.";
        if (condition.subject.starts_with(kHas)) {
            const InputSpec* input = manifest_.find_input(condition.subject.substr(kHas.size()));
            if (!input || !input->optional)
                fault(condition.place, pass, "'" + condition.subject + "' does not name an optional input");
            for (const ParamValue& value : condition.values)
                if (!std::holds_alternative<bool>(value))
                    fault(condition.place, pass,
                          "'" + condition.subject + "' is true or false, not " + format_value(value));
            return;
        }
        const ParamSpec* spec = manifest_.find_param(condition.subject);
        if (!spec) {
            fault(condition.place, pass,
                  "the condition '" + condition.subject + "' is not a parameter" +
                      did_you_mean(condition.subject, manifest_.param_names()));
            return;
        }
        for (const ParamValue& value : condition.values)
            if (!may_equal(*spec, value))
                fault(condition.place, pass, format_value(value) + " is not a value of '" + spec->name + "'");
    }

    /// A condition that could never hold is a mistake.
    static bool may_equal(const ParamSpec& spec, const ParamValue& value) {
        if (spec.type == ParamType::bool_) return std::holds_alternative<bool>(value);
        if (spec.type == ParamType::int_) return std::holds_alternative<std::int64_t>(value);
        const auto* name = std::get_if<std::string>(&value);
        return name && std::find(spec.values.begin(), spec.values.end(), *name) != spec.values.end();
    }

    const EffectManifest& manifest_;
    Diagnostics& diagnostics_;
    std::vector<std::string> readable_;
    std::vector<std::string> writable_;
    std::set<std::string> names_;
    std::set<std::string> read_;
    std::set<std::string> written_;
};

}  // namespace

void check_manifest(const EffectManifest& manifest, const Node& node, Diagnostics& diagnostics) {
    if (manifest.passes.empty()) diagnostics.error(node.place, "the effect has no passes");
    if (manifest.outputs.empty()) diagnostics.error(node.place, "the effect has no outputs");
    for (const TextureSpec& texture : manifest.textures)
        if (manifest.find_input(texture.name) || manifest.find_output(texture.name))
            diagnostics.error(texture.place,
                              "the texture '" + texture.name + "' has the name of an input or an output");
    PassChecker checker(manifest, diagnostics);
    for (const PassSpec& pass : manifest.passes) checker.check(pass);
    checker.check_all_used();
}

}  // namespace aftershade
