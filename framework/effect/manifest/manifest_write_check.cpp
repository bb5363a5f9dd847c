// What the passes of a manifest write, against what it declares.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "framework/effect/manifest/manifest_check.h"
#include "framework/effect/manifest/manifest_parser.h"
#include "framework/effect/manifest/manifest_pass_check.h"
#include "framework/effect/shader_source.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

gpu::Blend blend_of(const PassSpec& pass) {
    return pass.draw() ? pass.draw()->blend : gpu::Blend::none;
}

class WriteChecker {
public:
    explicit WriteChecker(PassState& state) : manifest_(state.manifest), pass_(state.pass), state_(state) {}

    void check() {
        const PassSpec& pass = *pass_;
        // The grammar reports an empty list.
        if (pass.infers_writes && pass.writes.empty())
            state_.fault(pass.place, state_.is_there(pass.shader)
                                         ? "writes nothing: it has no 'writes', and '" + pass.shader +
                                               "' has no 'out_' and the name of an output or a texture"
                                         : "writes nothing");
        const auto writes = [](const AccessSpec& access) { return access.kind != AccessSpec::Kind::read; };
        if (pass.compute() && std::none_of(pass.images.begin(), pass.images.end(), writes) &&
            std::none_of(pass.buffers.begin(), pass.buffers.end(), writes))
            state_.fault(pass.place, "writes no image and no buffer");
        std::set<std::string> seen;
        for (const WriteSpec& write : pass.writes) {
            if (!seen.insert(write.name).second)
                state_.fault(write.place, "writes '" + write.name + "' twice");
            check_write(write);
        }
        if (pass.copies()) check_copy();
    }

private:
    void check_write(const WriteSpec& write) {
        if (write.name.empty()) return;
        const TextureSpec* texture = manifest_.find_texture(write.name);
        const OutputSpec* output = manifest_.find_output(write.name);
        if (!output && !texture) {
            state_.fault(
                write.place,
                "writes '" + write.name + "', which is neither an output nor a texture" +
                    did_you_mean(write.name, state_.writable, "; declare it in 'outputs' or 'textures'"));
            return;
        }
        state_.used.insert(write.name);
        check_place(state_, write.name, "level", write.level, texture, false, write.place);
        check_place(state_, write.name, "layer", write.layer, texture, false, write.place);
        const auto role = output ? find_role(output->role) : std::nullopt;
        if (!texture && !role) return;
        const auto format = texture ? texture->format : texture_format_of_role(output->role);
        check_blend(write, format);
        check_base(write);
        if (const ClearSpec* clear = pass_->clear()) {
            if (const std::string why = why_not_in_format(clear->value, format); !why.empty())
                state_.fault(write.place, "'value' " + why);
            return;
        }
        const WriteSpec& first = pass_->writes.front();
        if (grid_of(write.name) != grid_of(first.name) || write.level != first.level)
            state_.fault(write.place,
                         "writes '" + first.name + "' and '" + write.name + "', which differ in size");
        if (texture) check_feedback(write, *texture);
    }

    /// An input may come from an earlier step in another format: the host then draws.
    void check_copy() {
        const std::string &from = pass_->reads.front().name, &to = pass_->writes.front().name;
        const auto levels_of = [&](const std::string& name) -> std::optional<int> {
            const TextureSpec* texture = manifest_.find_texture(name);
            if (!texture) return 1;
            return texture->layers == 1 && !texture->auto_mips ? std::optional(texture->mips) : std::nullopt;
        };
        const auto from_levels = manifest_.find_input(from) ? 1 : levels_of(from), to_levels = levels_of(to);
        const auto from_format = format_of(from, true), to_format = format_of(to, false);
        if (!from_format || !to_format) return;  // reported, or an image of any format
        if (grid_of(from, true) != grid_of(to) || *from_format != *to_format || !to_levels ||
            from_levels != to_levels)
            state_.fault(
                pass_->place,
                "copies '" + from + "' to '" + to +
                    "', which differ in size, format or levels or have several layers: draw instead");
    }

    std::optional<gpu::TextureFormat> format_of(const std::string& name, bool reads) const {
        const InputSpec* input = reads ? manifest_.find_input(name) : nullptr;
        const OutputSpec* output = reads ? nullptr : manifest_.find_output(name);
        if (const TextureSpec* texture = manifest_.find_texture(name); texture && !input)
            return texture->format;
        if (!input && !output) return std::nullopt;
        const std::string& role = input ? input->role : output->role;
        return find_role(role) ? std::optional(texture_format_of_role(role)) : std::nullopt;
    }

    GridSpec grid_of(const std::string& name, bool reads) const {
        return reads && manifest_.find_input(name) ? GridSpec{} : grid_of(name);
    }

    GridSpec grid_of(const std::string& name) const {
        const TextureSpec* texture = manifest_.find_texture(name);
        return texture ? texture->grid : GridSpec{};
    }

    void check_blend(const WriteSpec& write, gpu::TextureFormat format) {
        const gpu::Blend blend = blend_of(*pass_);
        if (blend == gpu::Blend::none) return;
        const std::string name(gpu::texture_format_name(format));
        if (gpu::is_integer(format))
            state_.fault(write.place,
                         "blends into '" + write.name + "', but integers (" + name + ") do not blend");
        else if (blend == gpu::Blend::add && !name.ends_with('f'))
            state_.fault(write.place,
                         "adds into '" + write.name + "', but " + name + " stops at 1; use a float format");
        if (manifest_.find_texture(write.name) && !state_.filled.contains(write.name))
            state_.fault(write.place, "blends into '" + write.name + "' before any pass has written it");
    }

    bool draws_parts() const {
        return pass_->draw() && pass_->draw()->instances && !pass_->draw()->instances->covers;
    }

    /// Instances and tiles leave the rest of a target as it was, which must be something.
    void check_base(const WriteSpec& write) {
        const TextureSpec* texture = manifest_.find_texture(write.name);
        if (!draws_parts() || state_.filled.contains(write.name) || (texture && texture->partial)) return;
        state_.fault(write.place,
                     "draws over parts of '" + write.name +
                         "' before anything has filled the rest: copy an input to it (a pass of kind "
                         "copy) or draw all of it in an earlier pass" +
                         (texture ? ", or give it 'clear'" : ""));
    }

    /// A draw sees what a texture was before it, in a copy of the host's; that needs a read and a write that
    /// do not meet in one texel's level.
    void check_feedback(const WriteSpec& write, const TextureSpec& texture) {
        const auto same = [&](const ReadSpec& read) { return read.name == write.name && !read.previous; };
        const auto read = std::find_if(pass_->reads.begin(), pass_->reads.end(), same);
        if (read == pass_->reads.end()) return;
        const std::string both = "reads and writes '" + write.name + "'";
        if (draws_parts() && !read->level)
            state_.fault(write.place,
                         both +
                             ", but draws over parts of it alone: write another texture, or name the "
                             "pass's 'reads' without it (by default, each branch of an #if counts)");
        if (blend_of(*pass_) != gpu::Blend::none) state_.fault(write.place, both + " while it blends");
        if (texture.layers > 1) state_.fault(write.place, both + ", of which it writes one layer only");
        else if (texture.auto_mips) state_.fault(write.place, both + ", whose 'mips' are automatic");
        else if (texture.mips > 1 && !read->level)
            state_.fault(write.place, both + ", of which it writes one level only: name a level in the read");
        else if (texture.mips > 1 && may_meet(*read->level, write.level))
            state_.fault(write.place, both + " at the same level");
    }

    bool may_meet(TurnIndex read, TurnIndex write) const {
        if (read.is_of_pass == write.is_of_pass) return read == write;
        const int turns = pass_->repeat ? std::max(manifest_.most_of(*pass_->repeat), 1) : 1;
        for (int turn = 0; turn < turns; ++turn)
            if (read.in_turn(turn) == write.in_turn(turn)) return true;
        return false;
    }

    const EffectManifest& manifest_;
    const PassSpec* pass_;
    PassState& state_;
};

}  // namespace

std::string label_of(const EffectManifest& manifest, const PassSpec& pass) {
    // A module is fine or not in an effect: what it reads may be missing there.
    const std::string origin =
        pass.module.empty() ? "" : " of the module '" + pass.module + "' in '" + manifest.id + "'";
    return (pass.lists() ? "tile list '" : "pass '") + pass.name + "'" + origin;
}

void PassState::fault(const Place& place, const std::string& text) {
    diagnostics.error(place, (pass ? label_of(manifest, *pass) + ": " : "") + text);
}

bool PassState::is_there(const std::string& file) const {
    return manifest.find_generated(pass->folder / file) ||
           std::filesystem::is_regular_file(pass->folder / file);
}

void check_place(PassState& state, const std::string& name, const std::string& key, TurnIndex value,
                 const TextureSpec* texture, bool reads, const Place& place) {
    if (value.is_of_pass && !state.pass->repeat) {
        state.fault(place, "the " + key + " of '" + name + "' is 'pass.index', but the pass has no 'repeat'");
        return;
    }
    const int turns = state.pass->repeat ? std::max(state.manifest.most_of(*state.pass->repeat), 1) : 1;
    const int low = value.in_turn(0), high = value.in_turn(turns - 1);
    int count = 1;
    if (texture && key == "layer") count = texture->layers;
    else if (texture) count = texture->auto_mips ? (reads ? 15 : 1) : texture->mips;
    if (low < 0 || high >= count)
        state.fault(place, "the " + key + " of '" + name + "' is " + std::to_string(low < 0 ? low : high) +
                               (low == high ? "" : " in one turn") + ", but " +
                               (texture && texture->auto_mips && !reads
                                    ? std::string("the host fills all levels but 0")
                                    : "it has " + std::to_string(count)));
}

void check_writes(PassState& state) {
    WriteChecker(state).check();
}

}  // namespace aftershade
