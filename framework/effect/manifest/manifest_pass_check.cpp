// The passes of a manifest against what it declares, in their order.
#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "framework/effect/manifest/manifest_check.h"
#include "framework/effect/manifest/manifest_parser.h"
#include "framework/effect/manifest/manifest_pass_check.h"
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
        : manifest_(manifest), diagnostics_(diagnostics), state_{manifest, diagnostics} {
        for (const InputSpec& input : manifest.inputs) readable_.push_back(input.name);
        for (const OutputSpec& output : manifest.outputs) state_.writable.push_back(output.name);
        for (const TextureSpec& texture : manifest.textures) {
            readable_.push_back(texture.name);
            state_.writable.push_back(texture.name);
            textures_.push_back(texture.name);
            if (texture.clear) state_.filled.insert(texture.name);
        }
        for (const BufferSpec& buffer : manifest.buffers) {
            buffers_.push_back(buffer.name);
            if (!buffer.clear.empty()) state_.filled.insert(buffer.name);
        }
    }

    /// Of what is there or not for all passes at once.
    void check_resources() {
        for (const InputSpec& input : manifest_.inputs) check_conditions(input.when);
        for (const TextureSpec& texture : manifest_.textures) check_conditions(texture.when);
        for (const TileListSpec& list : manifest_.tiles) check_conditions(list.when);
    }

    void check(const PassSpec& pass) {
        state_.pass = &pass;
        if (!pass.name.empty() && !names_.insert(pass.name).second)
            state_.fault(pass.place, "another pass has this name" + elsewhere(pass));
        for (const std::string& file : pass.shader_files()) check_shader_file(file);
        for (const ReadSpec& read : pass.reads) check_read(read);
        for (const AccessSpec& image : pass.images) check_image(image);
        for (const AccessSpec& buffer : pass.buffers) check_buffer(buffer);
        if (pass.compute()) check_dispatch(pass.compute()->dispatch);
        if (pass.draw() && pass.draw()->instances) check_indirect(pass.draw()->instances->indirect);
        check_writes(state_);
        check_counts();
        check_conditions(pass.when);
        for (const ReadSpec& read : pass.reads) check_conditions(read.when);
        for (const WriteSpec& write : pass.writes) check_conditions(write.when);
        for (const WriteSpec& write : pass.writes)
            state_.filled.insert(write.name), written_.insert(write.name);
        for (const auto* list : {&pass.images, &pass.buffers})
            for (const AccessSpec& access : *list)
                if (access.kind != AccessSpec::Kind::read)
                    state_.filled.insert(access.name), written_.insert(access.name);
    }

    void check_all_used() {
        for (const TextureSpec& texture : manifest_.textures) {
            if (!written_.contains(texture.name))
                diagnostics_.error(texture.place, "no pass writes the texture '" + texture.name + "'");
            check_history_used(texture, "texture");
        }
        for (const BufferSpec& buffer : manifest_.buffers) {
            if (!state_.used.contains(buffer.name))
                diagnostics_.error(buffer.place, "no pass uses the buffer '" + buffer.name + "'");
            check_history_used(buffer, "buffer");
        }
        for (const OutputSpec& output : manifest_.outputs)
            if (!written_.contains(output.name))
                diagnostics_.error(output.place, "no pass writes the output '" + output.name + "'");
        for (const InputSpec& input : manifest_.inputs) {
            if (!state_.used.contains(input.name))
                diagnostics_.error(input.place, "no pass reads the input '" + input.name + "'");
            check_history_used(input, "input");
        }
    }

private:
    /// Where the first pass with the name of this one is, if in another document.
    std::string elsewhere(const PassSpec& pass) const {
        const auto same = [&](const PassSpec& other) { return other.name == pass.name; };
        const auto first = std::find_if(manifest_.passes.begin(), manifest_.passes.end(), same);
        return first->place.file == pass.place.file ? "" : " (" + to_string(first->place) + ")";
    }

    template <typename Spec>
    void check_history_used(const Spec& spec, const std::string& thing) {
        if (spec.history && state_.used.contains(spec.name) && !previous_.contains(spec.name))
            diagnostics_.error(spec.place, "the " + thing + " '" + spec.name +
                                               "' has 'history', but no pass reads '" + spec.name + ".prev'");
    }

    void check_dispatch(const DispatchSpec& dispatch) {
        check_indirect(dispatch.indirect);
        if (!dispatch.over.empty() && !manifest_.find_texture(dispatch.over))
            state_.fault(state_.pass->place, "dispatches over '" + dispatch.over +
                                                 "', which is not a texture" +
                                                 did_you_mean(dispatch.over, textures_));
    }

    void check_shader_file(const std::string& file) {
        // A shader is part of its effect or module: nothing from elsewhere on the disk is read.
        if (file.find('/') != std::string::npos)
            state_.fault(state_.pass->place, state_.pass->lists()
                                                 ? "'predicate' is a file name without folders"
                                                 : "'shader' is a file name without folders");
        else if (!state_.is_there(file))
            state_.fault(state_.pass->place, "no file '" + file + "' in " + state_.pass->folder.string());
    }

    /// Notes the use of `name`, and refuses ".prev" of what keeps no history and the rest before it is
    /// filled.
    void check_order(const std::string& name, bool previous, bool has_history, bool from_outside,
                     const Place& place) {
        state_.used.insert(name);
        if (previous) previous_.insert(name);
        if (previous && !has_history)
            state_.fault(place, "reads '" + name + ".prev', but '" + name + "' has no 'history'");
        if (!previous && !from_outside && !state_.filled.contains(name))
            state_.fault(place,
                         "reads '" + name +
                             "' before any pass has written it (write or clear it in an earlier pass; with "
                             "\"history\": true, '" +
                             name + ".prev' is the previous frame's)");
    }

    void check_read(const ReadSpec& read) {
        if (read.name.empty()) return;
        const auto same = [&](const ReadSpec& r) { return r.glsl_name() == read.glsl_name(); };
        if (&*std::find_if(state_.pass->reads.begin(), state_.pass->reads.end(), same) != &read)
            state_.fault(read.place, "reads '" + read.name + (read.previous ? ".prev" : "") + "' twice");
        const InputSpec* input = manifest_.find_input(read.name);
        const TextureSpec* texture = find_texture_or_null(manifest_, read);
        if (!input && !texture) {
            state_.fault(read.place, "reads '" + read.name + "', which is neither an input nor a texture" +
                                         did_you_mean(read.name, readable_));
            return;
        }
        check_order(read.name, read.previous, input ? input->history : texture->history, input != nullptr,
                    read.place);
        const auto role = input ? find_role(input->role) : std::nullopt;
        const bool filterable = input ? !role || role->filterable : !gpu::is_integer(texture->format);
        if (read.filter == gpu::Filter::linear && !filterable)
            state_.fault(read.place, "'" + read.name + "' cannot be filtered linearly: " +
                                         (input ? "its role is " + input->role : "its format is integer"));
        if (read.level) check_place(state_, read.name, "level", *read.level, texture, true, read.place);
        if (read.is_pixel) check_pixel_read(read, input, texture);
    }

    /// The pixel of a draw over the full screen is a texel of what it reads.
    void check_pixel_read(const ReadSpec& read, const InputSpec* input, const TextureSpec* texture) {
        const std::string reads = "reads '" + read.glsl_name() + "' by the pixel, ";
        if (!state_.pass->fills_screen())
            state_.fault(read.place, reads + "which only a draw over the full screen can");
        else if (input && !find_role(input->role))
            state_.fault(read.place, reads + "but an 'aov:' image may have another size: fetch its texels");
        else if (texture && (texture->layers > 1 || texture->mips > 1 || texture->auto_mips))
            state_.fault(read.place, reads + "but it has several levels or layers: name no filter");
        const GridSpec grid = texture ? texture->grid : GridSpec{};
        for (const WriteSpec& write : state_.pass->writes) {
            const TextureSpec* target = manifest_.find_texture(write.name);
            if ((target ? target->grid : GridSpec{}) == grid && write.level == TurnIndex{}) continue;
            state_.fault(read.place, reads + "but its target '" + write.name + "' has another size");
        }
    }

    void check_image(const AccessSpec& image) {
        const TextureSpec* texture = manifest_.find_texture(image.name);
        if (!texture) {
            state_.fault(image.place, "has the image '" + image.name + "', which is not a texture" +
                                          did_you_mean(image.name, textures_));
            return;
        }
        if (image.previous)
            state_.fault(image.place, "an image is never '.prev': read '" + image.name + ".prev'");
        // Every format of ours is one of GLSL's image formats (GLSL 4.50, section 4.4.6.2).
        const bool counts =
            texture->format == gpu::TextureFormat::r32ui || texture->format == gpu::TextureFormat::r32i;
        if (image.kind == AccessSpec::Kind::atomic && !counts)
            state_.fault(image.place, "atomics on the image '" + image.name +
                                          "' need the format r32ui or r32i, not " +
                                          std::string(gpu::texture_format_name(texture->format)));
        if (texture->auto_mips && image.kind != AccessSpec::Kind::read)
            state_.fault(image.place,
                         "the image '" + image.name + "' has automatic 'mips', which only draws fill");
        if (image.kind != AccessSpec::Kind::write) check_order(image.name, false, false, false, image.place);
        state_.used.insert(image.name);
        for (const ReadSpec& read : state_.pass->reads)
            if (read.name == image.name && !read.previous)
                state_.fault(image.place, "has '" + image.name + "' as an image and as a read");
        for (const WriteSpec& write : state_.pass->writes)
            if (write.name == image.name)
                state_.fault(image.place, "has '" + image.name + "' as an image and as a target");
    }

    void check_buffer(const AccessSpec& access) {
        const BufferSpec* buffer = manifest_.find_buffer(access.name);
        if (!buffer) {
            state_.fault(access.place, "has the buffer '" + access.name + "', which is not declared" +
                                           did_you_mean(access.name, buffers_));
            return;
        }
        if (access.previous && access.kind != AccessSpec::Kind::read)
            state_.fault(access.place, "'" + access.name + ".prev' can only be read");
        const bool counts = buffer->element != "float" && !buffer->element.starts_with("vec");
        if (access.kind == AccessSpec::Kind::atomic && !counts)
            state_.fault(access.place,
                         "atomics on the buffer '" + access.name + "' need integers, not " + buffer->element);
        if (access.kind != AccessSpec::Kind::write)
            check_order(access.name, access.previous, buffer->history, false, access.place);
        state_.used.insert(access.name);
    }

    void check_indirect(const std::string& name) {
        if (name.empty()) return;
        state_.used.insert(name);
        const BufferSpec* buffer = manifest_.find_buffer(name);
        const Place& place = state_.pass->place;
        if (!buffer)
            state_.fault(place, "is counted by the buffer '" + name + "', which is not declared" +
                                    did_you_mean(name, buffers_));
        else if (!buffer->indirect)
            state_.fault(place, "is counted by the buffer '" + name + "', which is not declared 'indirect'");
        else if (!state_.filled.contains(name))
            state_.fault(place, "is counted by the buffer '" + name + "' before any pass has written it");
        for (const AccessSpec& access : state_.pass->buffers)
            if (access.name == name && access.kind != AccessSpec::Kind::read)
                state_.fault(access.place, "writes the buffer '" + name + "' by which it is counted");
    }

    void check_counts() {
        const auto at_most = [&](std::size_t count, int limit, const std::string& things) {
            if (count > std::size_t(limit))
                state_.fault(state_.pass->place, "has " + std::to_string(count) + " " + things +
                                                     "; the limit is " + std::to_string(limit));
        };
        std::size_t samplers = state_.pass->reads.size(), blocks = state_.pass->buffers.size();
        for (const ParamSpec& param : manifest_.params) {
            samplers += is_param_texture(param.type) || is_file_type(param.type);
            blocks += is_param_buffer(param.type);
        }
        if (manifest_.native) samplers += manifest_.native->tables.size();
        at_most(state_.pass->writes.size(), kMaxTargets, "targets");
        at_most(samplers, kMaxSamplers, "samplers with those of parameters and native tables");
        at_most(state_.pass->images.size(), kMaxImages, "images");
        at_most(blocks, kMaxStorageBlocks, "buffers with those of table parameters");
    }

    /// Conditions of a group, a texture or a tile list come with each pass that has them: told once.
    void check_conditions(const std::vector<WhenSpec>& conditions) {
        for (const WhenSpec& condition : conditions) {
            if (!asked_.insert(to_string(condition.place)).second) continue;
            for (const std::string& text : faults_of_condition(manifest_, condition))
                state_.fault(condition.place, text);
        }
    }

    const EffectManifest& manifest_;
    Diagnostics& diagnostics_;
    PassState state_;
    std::vector<std::string> readable_, textures_, buffers_;
    std::set<std::string> names_;
    std::set<std::string> asked_;     // places of conditions
    std::set<std::string> previous_;  // of what the last frame's is read
    std::set<std::string> written_;
};

}  // namespace

void check_passes(const EffectManifest& manifest, Diagnostics& diagnostics) {
    PassChecker checker(manifest, diagnostics);
    checker.check_resources();
    for (const PassSpec& pass : manifest.passes) checker.check(pass);
    checker.check_all_used();
}

}  // namespace aftershade
