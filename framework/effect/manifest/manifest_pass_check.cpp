// The passes of a manifest against what it declares, in their order.
#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "framework/effect/manifest/manifest_check.h"
#include "framework/effect/manifest/manifest_parser.h"
#include "framework/effect/manifest/manifest_when.h"
#include "framework/effect/shader_source.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

const TextureSpec* find_texture_or_null(const EffectManifest& manifest, const ReadSpec& read) {
    return manifest.find_input(read.name) ? nullptr : manifest.find_texture(read.name);
}

/// Follows the passes in order and remembers what has been written.
class PassChecker {
public:
    PassChecker(const EffectManifest& manifest, Diagnostics& diagnostics)
        : manifest_(manifest), diagnostics_(diagnostics) {
        for (const InputSpec& input : manifest.inputs) readable_.push_back(input.name);
        for (const OutputSpec& output : manifest.outputs) writable_.push_back(output.name);
        for (const TextureSpec& texture : manifest.textures) {
            readable_.push_back(texture.name);
            writable_.push_back(texture.name);
            textures_.push_back(texture.name);
            if (texture.clear) filled_.insert(texture.name);
        }
        for (const BufferSpec& buffer : manifest.buffers) {
            buffers_.push_back(buffer.name);
            if (!buffer.clear.empty()) filled_.insert(buffer.name);
        }
    }

    /// Of what is there or not for all passes at once.
    void check_resources() {
        for (const InputSpec& input : manifest_.inputs) check_conditions(input.when);
        for (const TextureSpec& texture : manifest_.textures) check_conditions(texture.when);
        for (const TileListSpec& list : manifest_.tiles) check_conditions(list.when);
    }

    void check(const PassSpec& pass) {
        pass_ = &pass;
        if (!pass.name.empty() && !names_.insert(pass.name).second)
            fault(pass.place, "another pass has this name" + elsewhere(pass));
        for (const std::string& file : {pass.shader, pass.vertex}) check_shader_file(file);
        for (const ReadSpec& read : pass.reads) check_read(read);
        for (const AccessSpec& image : pass.images) check_image(image);
        for (const AccessSpec& buffer : pass.buffers) check_buffer(buffer);
        check_indirect(pass.dispatch.indirect);
        if (pass.instances) check_indirect(pass.instances->indirect);
        if (!pass.dispatch.over.empty() && !manifest_.find_texture(pass.dispatch.over))
            fault(pass.place, "dispatches over '" + pass.dispatch.over + "', which is not a texture" +
                                  did_you_mean(pass.dispatch.over, textures_));
        check_writes();
        if (pass.kind == PassKind::copy) check_copy();
        check_counts();
        check_conditions(pass.when);
        for (const ReadSpec& read : pass.reads) check_conditions(read.when);
        for (const WriteSpec& write : pass.writes) check_conditions(write.when);
        for (const WriteSpec& write : pass.writes) filled_.insert(write.name), written_.insert(write.name);
        for (const auto* list : {&pass.images, &pass.buffers})
            for (const AccessSpec& access : *list)
                if (access.kind != AccessSpec::Kind::read)
                    filled_.insert(access.name), written_.insert(access.name);
    }

    void check_all_used() {
        for (const TextureSpec& texture : manifest_.textures) {
            if (!written_.contains(texture.name))
                diagnostics_.error(texture.place, "no pass writes the texture '" + texture.name + "'");
            check_history_used(texture, "texture");
        }
        for (const BufferSpec& buffer : manifest_.buffers) {
            if (!used_.contains(buffer.name))
                diagnostics_.error(buffer.place, "no pass uses the buffer '" + buffer.name + "'");
            check_history_used(buffer, "buffer");
        }
        for (const OutputSpec& output : manifest_.outputs)
            if (!written_.contains(output.name))
                diagnostics_.error(output.place, "no pass writes the output '" + output.name + "'");
        for (const InputSpec& input : manifest_.inputs) {
            if (!used_.contains(input.name))
                diagnostics_.error(input.place, "no pass reads the input '" + input.name + "'");
            check_history_used(input, "input");
        }
    }

private:
    void fault(const Place& place, const std::string& text) {
        diagnostics_.error(place, (pass_ ? label_of(manifest_, *pass_) + ": " : "") + text);
    }

    /// Where the first pass with the name of this one is, if in another document.
    std::string elsewhere(const PassSpec& pass) const {
        const auto same = [&](const PassSpec& other) { return other.name == pass.name; };
        const auto first = std::find_if(manifest_.passes.begin(), manifest_.passes.end(), same);
        return first->place.file == pass.place.file ? "" : " (" + to_string(first->place) + ")";
    }

    template <typename Spec>
    void check_history_used(const Spec& spec, const std::string& thing) {
        if (spec.history && used_.contains(spec.name) && !previous_.contains(spec.name))
            diagnostics_.error(spec.place, "the " + thing + " '" + spec.name +
                                               "' has 'history', but no pass reads '" + spec.name + ".prev'");
    }

    bool is_there(const std::string& file) const {
        return std::filesystem::is_regular_file(pass_->folder / file);
    }

    void check_shader_file(const std::string& file) {
        if (file.empty()) return;
        // A shader is part of its effect or module: nothing from elsewhere on the disk is read.
        if (file.find('/') != std::string::npos)
            fault(pass_->place, pass_->lists.empty() ? "'shader' is a file name without folders"
                                                     : "'predicate' is a file name without folders");
        else if (!is_there(file)) fault(pass_->place, "no file '" + file + "' in " + pass_->folder.string());
    }

    /// Notes the use of `name`, and refuses ".prev" of what keeps no history and the rest before it is
    /// filled.
    void check_order(const std::string& name, bool previous, bool has_history, bool from_outside,
                     const Place& place) {
        used_.insert(name);
        if (previous) previous_.insert(name);
        if (previous && !has_history)
            fault(place, "reads '" + name + ".prev', but '" + name + "' has no 'history'");
        if (!previous && !from_outside && !filled_.contains(name))
            fault(place, "reads '" + name +
                             "' before any pass has written it (write or clear it in an earlier pass; with "
                             "\"history\": true, '" +
                             name + ".prev' is the previous frame's)");
    }

    void check_read(const ReadSpec& read) {
        if (read.name.empty()) return;
        const auto same = [&](const ReadSpec& r) { return r.glsl_name() == read.glsl_name(); };
        if (&*std::find_if(pass_->reads.begin(), pass_->reads.end(), same) != &read)
            fault(read.place, "reads '" + read.name + (read.previous ? ".prev" : "") + "' twice");
        const InputSpec* input = manifest_.find_input(read.name);
        const TextureSpec* texture = find_texture_or_null(manifest_, read);
        if (!input && !texture) {
            fault(read.place, "reads '" + read.name + "', which is neither an input nor a texture" +
                                  did_you_mean(read.name, readable_));
            return;
        }
        check_order(read.name, read.previous, input ? input->history : texture->history, input != nullptr,
                    read.place);
        const auto role = input ? find_role(input->role) : std::nullopt;
        const bool filterable = input ? !role || role->filterable : !gpu::is_integer(texture->format);
        if (read.filter == gpu::Filter::linear && !filterable)
            fault(read.place, "'" + read.name + "' cannot be filtered linearly: " +
                                  (input ? "its role is " + input->role : "its format is integer"));
        if (read.level >= 0) check_place(read.name, "level", read.level, texture, true, read.place);
        if (read.is_pixel) check_pixel_read(read, input, texture);
    }

    /// The pixel of a draw over the full screen is a texel of what it reads.
    void check_pixel_read(const ReadSpec& read, const InputSpec* input, const TextureSpec* texture) {
        const std::string reads = "reads '" + read.glsl_name() + "' by the pixel, ";
        if (pass_->kind != PassKind::draw || pass_->has_vertex_shader() || !pass_->lists.empty())
            fault(read.place, reads + "which only a draw over the full screen can");
        else if (input && !find_role(input->role))
            fault(read.place, reads + "but an 'aov:' image may have another size: fetch its texels");
        else if (texture && (texture->layers > 1 || texture->mips > 1 || texture->auto_mips))
            fault(read.place, reads + "but it has several levels or layers: name no filter");
        const GridSpec grid = texture ? texture->grid : GridSpec{};
        for (const WriteSpec& write : pass_->writes) {
            const TextureSpec* target = manifest_.find_texture(write.name);
            if ((target ? target->grid : GridSpec{}) == grid && write.level == 0) continue;
            fault(read.place, reads + "but its target '" + write.name + "' has another size");
        }
    }

    /// A level or layer, in every turn of a repeated pass, is one that the texture has.
    void check_place(const std::string& name, const std::string& key, int value, const TextureSpec* texture,
                     bool reads, const Place& place) {
        int low = value, high = value;
        if (is_pass_index(value)) {
            if (!pass_->repeat) {
                fault(place,
                      "the " + key + " of '" + name + "' is 'pass.index', but the pass has no 'repeat'");
                return;
            }
            low = level_in_turn(value, 0);
            high = level_in_turn(value, std::max(manifest_.most_of(*pass_->repeat), 1) - 1);
        }
        int count = 1;
        if (texture && key == "layer") count = texture->layers;
        else if (texture) count = texture->auto_mips ? (reads ? 15 : 1) : texture->mips;
        if (low < 0 || high >= count)
            fault(place, "the " + key + " of '" + name + "' is " + std::to_string(low < 0 ? low : high) +
                             (low == high ? "" : " in one turn") + ", but " +
                             (texture && texture->auto_mips && !reads
                                  ? std::string("the host fills all levels but 0")
                                  : "it has " + std::to_string(count)));
    }

    void check_image(const AccessSpec& image) {
        const TextureSpec* texture = manifest_.find_texture(image.name);
        if (!texture) {
            fault(image.place, "has the image '" + image.name + "', which is not a texture" +
                                   did_you_mean(image.name, textures_));
            return;
        }
        if (image.previous) fault(image.place, "an image is never '.prev': read '" + image.name + ".prev'");
        // Every format of ours is one of GLSL's image formats (GLSL 4.50, section 4.4.6.2).
        const bool counts =
            texture->format == gpu::TextureFormat::r32ui || texture->format == gpu::TextureFormat::r32i;
        if (image.kind == AccessSpec::Kind::atomic && !counts)
            fault(image.place, "atomics on the image '" + image.name +
                                   "' need the format r32ui or r32i, not " +
                                   std::string(gpu::texture_format_name(texture->format)));
        if (texture->auto_mips && image.kind != AccessSpec::Kind::read)
            fault(image.place, "the image '" + image.name + "' has automatic 'mips', which only draws fill");
        if (image.kind != AccessSpec::Kind::write) check_order(image.name, false, false, false, image.place);
        used_.insert(image.name);
        for (const ReadSpec& read : pass_->reads)
            if (read.name == image.name && !read.previous)
                fault(image.place, "has '" + image.name + "' as an image and as a read");
        for (const WriteSpec& write : pass_->writes)
            if (write.name == image.name)
                fault(image.place, "has '" + image.name + "' as an image and as a target");
    }

    void check_buffer(const AccessSpec& access) {
        const BufferSpec* buffer = manifest_.find_buffer(access.name);
        if (!buffer) {
            fault(access.place, "has the buffer '" + access.name + "', which is not declared" +
                                    did_you_mean(access.name, buffers_));
            return;
        }
        if (access.previous && access.kind != AccessSpec::Kind::read)
            fault(access.place, "'" + access.name + ".prev' can only be read");
        const bool counts = buffer->element != "float" && !buffer->element.starts_with("vec");
        if (access.kind == AccessSpec::Kind::atomic && !counts)
            fault(access.place,
                  "atomics on the buffer '" + access.name + "' need integers, not " + buffer->element);
        if (access.kind != AccessSpec::Kind::write)
            check_order(access.name, access.previous, buffer->history, false, access.place);
        used_.insert(access.name);
    }

    void check_indirect(const std::string& name) {
        if (name.empty()) return;
        used_.insert(name);
        const BufferSpec* buffer = manifest_.find_buffer(name);
        const Place& place = pass_->place;
        if (!buffer)
            fault(place, "is counted by the buffer '" + name + "', which is not declared" +
                             did_you_mean(name, buffers_));
        else if (!buffer->indirect)
            fault(place, "is counted by the buffer '" + name + "', which is not declared 'indirect'");
        else if (!filled_.contains(name))
            fault(place, "is counted by the buffer '" + name + "' before any pass has written it");
        for (const AccessSpec& access : pass_->buffers)
            if (access.name == name && access.kind != AccessSpec::Kind::read)
                fault(access.place, "writes the buffer '" + name + "' by which it is counted");
    }

    void check_writes() {
        const PassSpec& pass = *pass_;
        // The grammar reports an empty list.
        if (pass.kind == PassKind::draw && pass.infers_writes && pass.writes.empty())
            fault(pass.place, is_there(pass.shader)
                                  ? "writes nothing: it has no 'writes', and '" + pass.shader +
                                        "' has no 'out_' and the name of an output or a texture"
                                  : "writes nothing");
        const auto writes = [](const AccessSpec& access) { return access.kind != AccessSpec::Kind::read; };
        if (pass.kind == PassKind::compute && std::none_of(pass.images.begin(), pass.images.end(), writes) &&
            std::none_of(pass.buffers.begin(), pass.buffers.end(), writes))
            fault(pass.place, "writes no image and no buffer");
        std::set<std::string> seen;
        for (const WriteSpec& write : pass.writes) {
            if (!seen.insert(write.name).second) fault(write.place, "writes '" + write.name + "' twice");
            check_write(write);
        }
    }

    void check_write(const WriteSpec& write) {
        if (write.name.empty()) return;
        const TextureSpec* texture = manifest_.find_texture(write.name);
        const OutputSpec* output = manifest_.find_output(write.name);
        if (!output && !texture) {
            fault(write.place,
                  "writes '" + write.name + "', which is neither an output nor a texture" +
                      did_you_mean(write.name, writable_, "; declare it in 'outputs' or 'textures'"));
            return;
        }
        used_.insert(write.name);
        check_place(write.name, "level", write.level, texture, false, write.place);
        check_place(write.name, "layer", write.layer, texture, false, write.place);
        const auto role = output ? find_role(output->role) : std::nullopt;
        if (!texture && !role) return;
        const auto format = texture ? texture->format : texture_format_of_role(output->role);
        check_blend(write, format);
        check_base(write);
        if (pass_->kind == PassKind::clear) {
            if (const std::string why = why_not_in_format(pass_->clear_value, format); !why.empty())
                fault(write.place, "'value' " + why);
            return;
        }
        const WriteSpec& first = pass_->writes.front();
        if (grid_of(write.name) != grid_of(first.name) || write.level != first.level)
            fault(write.place, "writes '" + first.name + "' and '" + write.name + "', which differ in size");
        if (texture) check_feedback(write, *texture);
    }

    /// An input may come from an earlier step in another format: the host then draws.
    void check_copy() {
        const std::string &from = pass_->reads.front().name, &to = pass_->writes.front().name;
        const auto plain = [&](const std::string& name) {
            const TextureSpec* texture = manifest_.find_texture(name);
            return !texture || (texture->layers == 1 && texture->mips == 1 && !texture->auto_mips);
        };
        const auto from_format = format_of(from, true), to_format = format_of(to, false);
        if (!from_format || !to_format) return;  // reported, or an image of any format
        if (grid_of(from, true) != grid_of(to) || *from_format != *to_format || !plain(to) ||
            (!manifest_.find_input(from) && !plain(from)))
            fault(pass_->place, "copies '" + from + "' to '" + to +
                                    "', which differ in size or format or have several levels or layers: "
                                    "draw instead");
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
        if (pass_->blend == gpu::Blend::none) return;
        const std::string name(gpu::texture_format_name(format));
        if (gpu::is_integer(format))
            fault(write.place, "blends into '" + write.name + "', but integers (" + name + ") do not blend");
        else if (pass_->blend == gpu::Blend::add && !name.ends_with('f'))
            fault(write.place,
                  "adds into '" + write.name + "', but " + name + " stops at 1; use a float format");
        if (manifest_.find_texture(write.name) && !filled_.contains(write.name))
            fault(write.place, "blends into '" + write.name + "' before any pass has written it");
    }

    /// Instances and tiles leave the rest of a target as it was, which must be something.
    void check_base(const WriteSpec& write) {
        const TextureSpec* texture = manifest_.find_texture(write.name);
        if (!pass_->instances || filled_.contains(write.name) || (texture && texture->partial)) return;
        fault(write.place, "draws over parts of '" + write.name +
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
        if (pass_->blend != gpu::Blend::none) fault(write.place, both + " while it blends");
        if (texture.layers > 1) fault(write.place, both + ", of which it writes one layer only");
        else if (texture.auto_mips) fault(write.place, both + ", whose 'mips' are automatic");
        else if (texture.mips > 1 && read->level < 0)
            fault(write.place, both + ", of which it writes one level only: name a level in the read");
        else if (texture.mips > 1 && may_meet(read->level, write.level))
            fault(write.place, both + " at the same level");
    }

    bool may_meet(int read, int write) const {
        if (is_pass_index(read) == is_pass_index(write)) return read == write;
        const int turns = pass_->repeat ? std::max(manifest_.most_of(*pass_->repeat), 1) : 1;
        for (int turn = 0; turn < turns; ++turn)
            if (level_in_turn(read, turn) == level_in_turn(write, turn)) return true;
        return false;
    }

    void check_counts() {
        const auto at_most = [&](std::size_t count, int limit, const std::string& things) {
            if (count > std::size_t(limit))
                fault(pass_->place, "has " + std::to_string(count) + " " + things + "; the limit is " +
                                        std::to_string(limit));
        };
        std::size_t samplers = pass_->reads.size(), blocks = pass_->buffers.size();
        for (const ParamSpec& param : manifest_.params) {
            samplers += is_param_texture(param.type) || is_file_type(param.type);
            blocks += is_param_buffer(param.type);
        }
        if (manifest_.native) samplers += manifest_.native->tables.size();
        at_most(pass_->writes.size(), kMaxTargets, "targets");
        at_most(samplers, kMaxSamplers, "samplers with those of parameters and native tables");
        at_most(pass_->images.size(), kMaxImages, "images");
        at_most(blocks, kMaxStorageBlocks, "buffers with those of table parameters");
    }

    /// Conditions of a group, a texture or a tile list come with each pass that has them: told once.
    void check_conditions(const std::vector<WhenSpec>& conditions) {
        for (const WhenSpec& condition : conditions) {
            if (!asked_.insert(to_string(condition.place)).second) continue;
            for (const std::string& text : faults_of_condition(manifest_, condition))
                fault(condition.place, text);
        }
    }

    const EffectManifest& manifest_;
    Diagnostics& diagnostics_;
    const PassSpec* pass_ = nullptr;  // being checked
    std::vector<std::string> readable_, writable_, textures_, buffers_;
    std::set<std::string> names_;
    std::set<std::string> asked_;  // places of conditions
    std::set<std::string> used_;
    std::set<std::string> previous_;  // of what the last frame's is read
    std::set<std::string> written_;
    std::set<std::string> filled_;  // written or cleared
};

}  // namespace

std::string label_of(const EffectManifest& manifest, const PassSpec& pass) {
    // A module is fine or not in an effect: what it reads may be missing there.
    const std::string origin =
        pass.module.empty() ? "" : " of the module '" + pass.module + "' in '" + manifest.id + "'";
    return (pass.lists.empty() ? "pass '" : "tile list '") + pass.name + "'" + origin;
}

void check_passes(const EffectManifest& manifest, Diagnostics& diagnostics) {
    PassChecker checker(manifest, diagnostics);
    checker.check_resources();
    for (const PassSpec& pass : manifest.passes) checker.check(pass);
    checker.check_all_used();
}

}  // namespace aftershade
