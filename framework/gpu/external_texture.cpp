#include "framework/gpu/external_texture.h"

#include <cassert>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/gpu/context_internal.h"

namespace aftershade::gpu {
namespace {

/// A framebuffer of one texture, for a copy.
class CopyFramebuffer {
public:
    CopyFramebuffer(const GladGLContext& gl, GLuint texture) : gl_(gl) {
        gl_.CreateFramebuffers(1, &name_);
        gl_.NamedFramebufferTexture(name_, GL_COLOR_ATTACHMENT0, texture, 0);
    }
    ~CopyFramebuffer() { gl_.DeleteFramebuffers(1, &name_); }
    CopyFramebuffer(const CopyFramebuffer&) = delete;
    CopyFramebuffer& operator=(const CopyFramebuffer&) = delete;

    GLuint name() const { return name_; }
    bool is_complete() const {
        return gl_.CheckNamedFramebufferStatus(name_, GL_READ_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE &&
               gl_.CheckNamedFramebufferStatus(name_, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    }

private:
    const GladGLContext& gl_;
    GLuint name_ = 0;
};

void blit(Context& context, GLuint from, GLuint to, int width, int height, bool flip) {
    context.make_current();
    context.impl().wait_for_draws();
    const GladGLContext& gl = context.gl();
    const CopyFramebuffer source(gl, from), target(gl, to);
    gl.BlitNamedFramebuffer(source.name(), target.name(), 0, 0, width, height, 0, flip ? height : 0, width,
                            flip ? 0 : height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    context.check("copying a shared texture");
}

}  // namespace

void check_external_texture(Context& context, const ExternalTexture& texture, int channels, bool is_integer,
                            const std::string& label) {
    context.make_current();
    const GladGLContext& gl = context.gl();
    const auto fail = [&](const std::string& why) {
        throw Error(ErrorKind::usage, fmt::format("{}: texture {} {}", label, texture.name, why));
    };
    if (texture.name == 0 || !gl.IsTexture(texture.name)) fail("is not a texture of the shared context");
    GLint kind = 0;
    gl.GetTextureParameteriv(texture.name, GL_TEXTURE_TARGET, &kind);
    if (kind != GL_TEXTURE_2D) fail("is not two-dimensional (GL_TEXTURE_2D)");
    const auto level = [&](GLenum name) {
        GLint value = 0;
        gl.GetTextureLevelParameteriv(texture.name, 0, name, &value);
        return value;
    };
    const GLint width = level(GL_TEXTURE_WIDTH), height = level(GL_TEXTURE_HEIGHT);
    if (width != texture.width || height != texture.height)
        fail(fmt::format("has {} x {} texels, not {} x {}", width, height, texture.width, texture.height));
    const bool is_uint = level(GL_TEXTURE_RED_TYPE) == GL_UNSIGNED_INT;
    if (is_uint != is_integer || level(GL_TEXTURE_RED_TYPE) == GL_INT)
        fail(is_integer ? "does not hold unsigned integers" : "holds integers; the role has floats");
    int held = 0;
    for (const GLenum size :
         {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE})
        if (level(size) > 0) ++held;
    const int needed = channels == 3 ? 4 : channels;
    if (held < needed) fail(fmt::format("has {} channels; the role needs {}", held, needed));
    if (held == 3 || !CopyFramebuffer(gl, texture.name).is_complete())
        fail("has a format that cannot be drawn to; gl.h lists those that can");
    context.check(label);
}

void copy_texture(Context& context, const ExternalTexture& from, const Texture& to) {
    assert(from.width == to.desc().width && from.height == to.desc().height);
    blit(context, from.name, to.handle(), from.width, from.height, from.bottom_up);
}

void copy_texture(Context& context, const Texture& from, const ExternalTexture& to) {
    assert(to.width == from.desc().width && to.height == from.desc().height);
    blit(context, from.handle(), to.name, to.width, to.height, to.bottom_up);
}

void wait_for_fence(Context& context, void* fence) {
    context.make_current();
    const GladGLContext& gl = context.gl();
    const auto sync = static_cast<GLsync>(fence);
    if (!gl.IsSync(sync))
        throw Error(ErrorKind::usage, "wait: this is not a fence (GLsync) of the shared context");
    gl.WaitSync(sync, 0, GL_TIMEOUT_IGNORED);
    context.check("waiting for a fence");
}

void* insert_fence(Context& context) {
    context.make_current();
    const GLsync fence = context.gl().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    context.gl().Flush();
    context.check("a fence");
    return fence;
}

}  // namespace aftershade::gpu
