#include "framework/gpu/commands.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/gpu/context_internal.h"
#include "framework/gpu/flushed_denormals.h"
#include "framework/gpu/texture_format.h"

namespace aftershade::gpu {
namespace {

[[noreturn]] void fail(const Program& program, std::string_view why) {
    throw Error(ErrorKind::effect, fmt::format("{}: {}", program.label(), why));
}

GLenum gl_access(Access access) {
    switch (access) {
        case Access::read: return GL_READ_ONLY;
        case Access::write: return GL_WRITE_ONLY;
        case Access::read_write: break;
    }
    return GL_READ_WRITE;
}

/// What a pass binds, for as long as the pass runs; nothing of it stays behind, even where GL refuses
/// something.
class PassScope {
public:
    PassScope(Context& context, const Program& program, const Bindings& bindings)
        : impl_(context.impl()), gl_(context.gl()), program_(program), bindings_(bindings) {
        check_bindings();
        const std::string_view name = debug_text(program.label());
        gl_.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(name.size()), name.data());
        use_program();
        bind_textures();
        for (const ImageBinding& image : bindings_.images) {
            const TextureDesc& desc = image.texture->desc();
            gl_.BindImageTexture(unit(image.binding), image.texture->handle(), image.level,
                                 desc.layers > 1 && !image.layer, image.layer.value_or(0),
                                 gl_access(image.access), gl_format(desc.format).internal);
        }
        bind_buffers(GL_UNIFORM_BUFFER, bindings_.uniforms);
        bind_buffers(GL_SHADER_STORAGE_BUFFER, bindings_.storage);
    }

    ~PassScope() {
        for (const SampledTexture& sampled : bindings_.textures) {
            gl_.BindTextureUnit(unit(sampled.binding), 0);
            gl_.BindSampler(unit(sampled.binding), 0);
        }
        for (const ImageBinding& image : bindings_.images) {
            gl_.BindImageTexture(unit(image.binding), 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
        }
        for (const BufferBinding& b : bindings_.uniforms)
            gl_.BindBufferBase(GL_UNIFORM_BUFFER, unit(b.binding), 0);
        for (const BufferBinding& b : bindings_.storage) {
            gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, unit(b.binding), 0);
        }
        if (program_.vertex_stage()) gl_.BindProgramPipeline(0);
        else gl_.UseProgram(0);
        gl_.PopDebugGroup();
    }

    PassScope(const PassScope&) = delete;
    PassScope& operator=(const PassScope&) = delete;

    bool writes_memory() const {
        return !bindings_.storage.empty() ||
               std::ranges::any_of(bindings_.images,
                                   [](const ImageBinding& image) { return image.access != Access::read; });
    }

private:
    static GLuint unit(int binding) { return static_cast<GLuint>(binding); }

    /// What GL would let pass and then do wrong.
    void check_bindings() const {
        for (const SampledTexture& sampled : bindings_.textures) {
            if (sampled.filter == Filter::linear && is_integer(sampled.texture->desc().format)) {
                fail(program_,
                     fmt::format("texture '{}' holds integers and cannot be read with a linear filter",
                                 sampled.texture->label()));
            }
            if (sampled.level >= sampled.texture->desc().mips) {
                fail(program_,
                     fmt::format("texture '{}' has no level {}", sampled.texture->label(), *sampled.level));
            }
        }
        check_sizes(bindings_.uniforms, impl_.limits.uniform_block_bytes, "GL_MAX_UNIFORM_BLOCK_SIZE");
        check_sizes(bindings_.storage, impl_.limits.storage_block_bytes, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE");
    }

    void check_sizes(std::span<const BufferBinding> buffers, std::int64_t limit,
                     std::string_view limit_name) const {
        for (const BufferBinding& binding : buffers) {
            const auto bytes = static_cast<std::int64_t>(binding.buffer->size());
            if (bytes <= limit) continue;
            fail(program_, fmt::format("the buffer at binding {} has {} bytes; the limit is {} ({})",
                                       binding.binding, bytes, limit, limit_name));
        }
    }

    void use_program() {
        const Program* const vertex = program_.vertex_stage();
        if (!vertex) return gl_.UseProgram(program_.handle());
        gl_.UseProgramStages(impl_.pipeline, GL_VERTEX_SHADER_BIT, vertex->handle());
        gl_.UseProgramStages(impl_.pipeline, GL_FRAGMENT_SHADER_BIT, program_.handle());
        gl_.BindProgramPipeline(impl_.pipeline);
    }

    void bind_textures() {
        for (const SampledTexture& sampled : bindings_.textures) {
            const bool one_level = sampled.texture->desc().mips == 1 || sampled.level;
            // With one level there is nothing that a view would hide.
            const GLuint handle = sampled.texture->desc().mips == 1 || !sampled.level
                                      ? sampled.texture->handle()
                                      : impl_.cache->level_view(sampled.texture->cached(), *sampled.level);
            gl_.BindTextureUnit(unit(sampled.binding), handle);
            gl_.BindSampler(unit(sampled.binding),
                            impl_.cache->sampler(sampled.filter, sampled.wrap, !one_level));
        }
    }

    void bind_buffers(GLenum target, std::span<const BufferBinding> buffers) {
        for (const BufferBinding& binding : buffers) {
            gl_.BindBufferBase(target, unit(binding.binding), binding.buffer->handle());
        }
    }

    Context::Impl& impl_;
    const GladGLContext& gl_;
    const Program& program_;
    const Bindings& bindings_;
};

class BlendScope {
public:
    BlendScope(const GladGLContext& gl, Blend blend) : gl_(gl), enabled_(blend != Blend::none) {
        if (!enabled_) return;
        gl_.Enable(GL_BLEND);
        gl_.BlendFunc(GL_ONE, GL_ONE);
        gl_.BlendEquation(blend == Blend::add ? GL_FUNC_ADD : blend == Blend::min ? GL_MIN : GL_MAX);
    }
    ~BlendScope() {
        if (enabled_) gl_.Disable(GL_BLEND);
    }
    BlendScope(const BlendScope&) = delete;
    BlendScope& operator=(const BlendScope&) = delete;

private:
    const GladGLContext& gl_;
    bool enabled_;
};

/// llvmpipe makes the form for whole blocks only of draws without a logical operation. This one copies, and
/// floats know none; where it is enabled, nothing blends.
class OneFormScope {
public:
    OneFormScope(const GladGLContext& gl, bool enabled) : gl_(gl), enabled_(enabled) {
        if (!enabled_) return;
        gl_.Enable(GL_COLOR_LOGIC_OP);
        gl_.LogicOp(GL_COPY);
    }
    ~OneFormScope() {
        if (enabled_) gl_.Disable(GL_COLOR_LOGIC_OP);
    }
    OneFormScope(const OneFormScope&) = delete;
    OneFormScope& operator=(const OneFormScope&) = delete;

private:
    const GladGLContext& gl_;
    bool enabled_;
};

int side(int full, int level) {
    return std::max(1, full >> level);
}

void check_targets(const Limits& limits, const Program& program, std::span<const Target> targets) {
    if (targets.empty()) fail(program, "there is no target to draw to");
    if (targets.size() > static_cast<std::size_t>(limits.colour_attachments)) {
        fail(program, fmt::format("{} targets; the limit is {} (GL_MAX_COLOR_ATTACHMENTS)", targets.size(),
                                  limits.colour_attachments));
    }
    const Target& first = targets.front();
    for (const Target& target : targets) {
        const TextureDesc& desc = target.texture->desc();
        if (target.level < 0 || target.level >= desc.mips || target.layer < 0 ||
            target.layer >= desc.layers) {
            fail(program,
                 fmt::format("texture '{}' has {} levels and {} layers; the target is level {} of layer {}",
                             target.texture->label(), desc.mips, desc.layers, target.level, target.layer));
        }
        const int width = side(first.texture->desc().width, first.level);
        const int height = side(first.texture->desc().height, first.level);
        if (side(desc.width, target.level) == width && side(desc.height, target.level) == height) continue;
        fail(program, fmt::format("targets differ in size: '{}' is {}x{}, '{}' is {}x{}",
                                  first.texture->label(), width, height, target.texture->label(),
                                  side(desc.width, target.level), side(desc.height, target.level)));
    }
}

GLuint framebuffer(Context& context, const Program& program, std::span<const Target> targets) {
    std::vector<Attachment> attachments;
    for (const Target& target : targets)
        attachments.push_back({target.texture->cached(), target.level, target.layer});
    try {
        return context.impl().cache->framebuffer(attachments);
    } catch (const Error& error) {
        context.check(fmt::format("{}: {}", program.label(), error.what()));
        fail(program, error.what());
    }
}

void check_feedback(const Program& program, std::span<const Target> targets, const Bindings& bindings) {
    for (const SampledTexture& sampled : bindings.textures) {
        for (const Target& target : targets) {
            if (sampled.texture != target.texture) continue;
            if (sampled.level && sampled.level != target.level) continue;
            fail(program,
                 fmt::format("texture '{}' is read and drawn to by the same pass", sampled.texture->label()));
        }
    }
}

/// GL would read past the end of a buffer that is too short, or report an error that names no pass.
void check_indirect(const Program& program, const Buffer& buffer, std::size_t bytes) {
    if (buffer.size() >= bytes) return;
    fail(program, fmt::format("the buffer that says how many has {} bytes; the command takes {}",
                              buffer.size(), bytes));
}

/// Everything of a draw but the command itself, which `submit` gives.
template <typename Submit>
void draw_with(Context& context, const Program& program, std::span<const Target> targets,
               const Bindings& bindings, Blend blend, Submit submit) {
    context.test_once();
    context.make_current();
    const Context::Impl& impl = context.impl();
    const GladGLContext& gl = impl.gl;
    // GL draws nothing with it, and reports nothing.
    if (program.is_compute()) fail(program, "a compute program cannot draw");
    if (program.stages() == Stages::vertex) fail(program, "a vertex shader cannot draw by itself");
    check_targets(impl.limits, program, targets);
    check_feedback(program, targets, bindings);
    const GLuint target = framebuffer(context, program, targets);
    {
        const PassScope pass(context, program, bindings);
        const BlendScope blending(gl, blend);
        const OneFormScope form(gl, impl.info.software && program.has_one_form() && blend == Blend::none);
        const TextureDesc& desc = targets.front().texture->desc();
        const int level = targets.front().level;
        gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
        gl.Viewport(0, 0, side(desc.width, level), side(desc.height, level));
        gl.BindVertexArray(impl.vertex_array);
        submit(gl);
        if (pass.writes_memory()) gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
        gl.BindVertexArray(0);
        gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    }
    context.check(program.label());
}

template <typename Submit>
void dispatch_with(Context& context, const Program& program, const Bindings& bindings, Submit submit) {
    context.test_once();
    context.make_current();
    const GladGLContext& gl = context.gl();
    {
        const PassScope pass(context, program, bindings);
        const FlushedDenormals where_mesa_has_no_threads;
        submit(gl);
        if (pass.writes_memory()) gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
    }
    context.check(program.label());
}

void dispatch_from(Context& context, const Program& program, const Buffer& groups, const Bindings& bindings) {
    dispatch_with(context, program, bindings, [&](const GladGLContext& gl) {
        gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.handle());
        gl.DispatchComputeIndirect(0);
        gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
    });
}

}  // namespace

NothingToDo::NothingToDo(Context& context)
    : context_(context), no_groups_(context, 3 * sizeof(std::uint32_t), "no work groups") {
    no_groups_.clear(0);
    context_.test_once();
    context_.impl().nothing = &no_groups_;
    context_.gl().Scissor(0, 0, 0, 0);
    context_.gl().Enable(GL_SCISSOR_TEST);
}

NothingToDo::~NothingToDo() {
    context_.impl().nothing = nullptr;
    if (context_.impl().try_make_current()) context_.gl().Disable(GL_SCISSOR_TEST);
}

void draw(Context& context, const Program& program, std::span<const Target> targets, const Bindings& bindings,
          Blend blend) {
    draw_with(context, program, targets, bindings, blend,
              [](const GladGLContext& gl) { gl.DrawArrays(GL_TRIANGLES, 0, 3); });
}

void draw_instances(Context& context, const Program& program, std::span<const Target> targets,
                    const Bindings& bindings, const InstanceRange& instances, Blend blend) {
    constexpr std::size_t kCommandBytes = 16;
    if (instances.indirect) check_indirect(program, *instances.indirect, kCommandBytes);
    const bool quads = instances.primitive == Primitive::quads;
    const GLenum mode = quads ? GL_TRIANGLE_STRIP : GL_POINTS;
    draw_with(context, program, targets, bindings, blend, [&](const GladGLContext& gl) {
        // Without an instance, the driver would not look at the program.
        const bool draws_nothing = context.impl().nothing != nullptr;
        if (!instances.indirect || draws_nothing) {
            gl.DrawArraysInstanced(mode, 0, quads ? 4 : 1, draws_nothing ? 1 : instances.count);
            return;
        }
        gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, instances.indirect->handle());
        gl.DrawArraysIndirect(mode, nullptr);
        gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    });
}

void copy(Context& context, const Texture& from, const Texture& to) {
    assert(from.desc().format == to.desc().format && from.desc().width == to.desc().width);
    assert(from.desc().height == to.desc().height && from.desc().mips >= to.desc().mips);
    assert(from.desc().layers == 1 && to.desc().layers == 1);
    context.make_current();
    context.impl().wait_for_draws();
    for (int level = 0; level < to.desc().mips; ++level)
        context.gl().CopyImageSubData(from.handle(), GL_TEXTURE_2D, level, 0, 0, 0, to.handle(),
                                      GL_TEXTURE_2D, level, 0, 0, 0, std::max(1, to.desc().width >> level),
                                      std::max(1, to.desc().height >> level), 1);
    context.check(fmt::format("copying texture '{}' to '{}'", from.label(), to.label()));
}

void dispatch(Context& context, const Program& program, int groups_x, int groups_y, int groups_z,
              const Bindings& bindings) {
    // Only of a command that lies in a buffer does the driver not know beforehand that it is for no group.
    if (const Buffer* const nothing = context.impl().nothing)
        return dispatch_from(context, program, *nothing, bindings);
    dispatch_with(context, program, bindings, [&](const GladGLContext& gl) {
        gl.DispatchCompute(static_cast<GLuint>(groups_x), static_cast<GLuint>(groups_y),
                           static_cast<GLuint>(groups_z));
    });
}

void dispatch_indirect(Context& context, const Program& program, const Buffer& groups,
                       const Bindings& bindings) {
    constexpr std::size_t kCommandBytes = 12;
    check_indirect(program, groups, kCommandBytes);
    const Buffer* const nothing = context.impl().nothing;
    dispatch_from(context, program, nothing ? *nothing : groups, bindings);
}

void dispatch_over(Context& context, const Program& program, std::span<const Target> targets, int first_unit,
                   const Bindings& bindings) {
    check_targets(context.impl().limits, program, targets);
    check_feedback(program, targets, bindings);
    std::vector<ImageBinding> images(bindings.images.begin(), bindings.images.end());
    for (const Target& target : targets)
        images.push_back({target.texture, first_unit++, target.level, Access::write, target.layer});
    const TextureDesc& desc = targets.front().texture->desc();
    const auto groups = [&](int full) {
        return (side(full, targets.front().level) + kGroupSide - 1) / kGroupSide;
    };
    dispatch(context, program, groups(desc.width), groups(desc.height), 1,
             {bindings.textures, images, bindings.uniforms, bindings.storage});
}

}  // namespace aftershade::gpu
