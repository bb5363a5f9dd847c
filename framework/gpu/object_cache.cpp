#include "framework/gpu/object_cache.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <glad/gl.h>

#include "framework/base/error.h"
#include "framework/gpu/texture_format.h"

namespace aftershade::gpu {
namespace {

std::string status_name(GLenum status) {
    switch (status) {
        case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT: return "GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT";
        case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
            return "GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT";
        case GL_FRAMEBUFFER_UNSUPPORTED: return "GL_FRAMEBUFFER_UNSUPPORTED";
        case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS: return "GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS";
        default: return fmt::format("status 0x{:04x}", status);
    }
}

GLuint make_sampler(const GladGLContext& gl, Filter filter, Wrap wrap, bool mips) {
    const bool linear = filter == Filter::linear;
    const GLint magnify = linear ? GL_LINEAR : GL_NEAREST;
    const GLint minify = linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_NEAREST;
    const GLint edge = wrap == Wrap::zero ? GL_CLAMP_TO_BORDER : GL_CLAMP_TO_EDGE;
    GLuint sampler = 0;
    gl.CreateSamplers(1, &sampler);
    gl.SamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, magnify);
    gl.SamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, mips ? minify : magnify);
    gl.SamplerParameteri(sampler, GL_TEXTURE_WRAP_S, edge);
    gl.SamplerParameteri(sampler, GL_TEXTURE_WRAP_T, edge);
    gl.SamplerParameteri(sampler, GL_TEXTURE_WRAP_R, edge);
    const GLfloat border[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    gl.SamplerParameterfv(sampler, GL_TEXTURE_BORDER_COLOR, border);
    return sampler;
}

}  // namespace

ObjectCache::~ObjectCache() {
    for (const auto& [targets, framebuffer] : framebuffers_) gl_.DeleteFramebuffers(1, &framebuffer);
    for (const auto& [level, view] : views_) gl_.DeleteTextures(1, &view);
    gl_.DeleteSamplers(static_cast<GLsizei>(samplers_.size()), samplers_.data());
}

unsigned int ObjectCache::sampler(Filter filter, Wrap wrap, bool mips) {
    const std::size_t index =
        (filter == Filter::linear ? 4U : 0U) + (wrap == Wrap::zero ? 2U : 0U) + (mips ? 1U : 0U);
    if (samplers_[index] == 0) samplers_[index] = make_sampler(gl_, filter, wrap, mips);
    return samplers_[index];
}

unsigned int ObjectCache::level_view(const CachedTexture& texture, int level) {
    unsigned int& view = views_[{texture.handle, level}];
    if (view != 0) return view;
    // A view must be made of a name that was never bound, which CreateTextures does not give.
    gl_.GenTextures(1, &view);
    gl_.TextureView(view, texture.layers > 1 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, texture.handle,
                    gl_format(texture.format).internal, static_cast<GLuint>(level), 1, 0,
                    static_cast<GLuint>(texture.layers));
    return view;
}

unsigned int ObjectCache::framebuffer(std::span<const Attachment> attachments) {
    key_.assign(attachments.begin(), attachments.end());
    if (const auto found = framebuffers_.find(key_); found != framebuffers_.end()) return found->second;

    GLuint framebuffer = 0;
    gl_.CreateFramebuffers(1, &framebuffer);
    std::vector<GLenum> buffers;
    for (const Attachment& attachment : attachments) {
        buffers.push_back(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + buffers.size()));
        const GLuint handle = attachment.texture.handle;
        if (attachment.texture.layers > 1) {
            gl_.NamedFramebufferTextureLayer(framebuffer, buffers.back(), handle, attachment.level,
                                             attachment.layer);
        } else {
            gl_.NamedFramebufferTexture(framebuffer, buffers.back(), handle, attachment.level);
        }
    }
    gl_.NamedFramebufferDrawBuffers(framebuffer, static_cast<GLsizei>(buffers.size()), buffers.data());
    const GLenum status = gl_.CheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        gl_.DeleteFramebuffers(1, &framebuffer);
        throw Error(ErrorKind::effect,
                    fmt::format("the targets form no framebuffer ({})", status_name(status)));
    }
    framebuffers_.emplace(key_, framebuffer);
    return framebuffer;
}

void ObjectCache::forget_texture(unsigned int handle) {
    std::erase_if(framebuffers_, [&](const auto& entry) {
        const auto& targets = entry.first;
        const auto is_it = [&](const Attachment& a) { return a.texture.handle == handle; };
        if (std::none_of(targets.begin(), targets.end(), is_it)) return false;
        gl_.DeleteFramebuffers(1, &entry.second);
        return true;
    });
    std::erase_if(views_, [&](const auto& entry) {
        if (entry.first.first != handle) return false;
        gl_.DeleteTextures(1, &entry.second);
        return true;
    });
}

}  // namespace aftershade::gpu
