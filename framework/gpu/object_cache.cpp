#include "framework/gpu/object_cache.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <glad/gl.h>

#include "framework/core/error.h"

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
    gl_.DeleteSamplers(static_cast<GLsizei>(samplers_.size()), samplers_.data());
}

unsigned int ObjectCache::sampler(Filter filter, Wrap wrap, bool mips) {
    const std::size_t index =
        (filter == Filter::linear ? 4U : 0U) + (wrap == Wrap::zero ? 2U : 0U) + (mips ? 1U : 0U);
    if (samplers_[index] == 0) samplers_[index] = make_sampler(gl_, filter, wrap, mips);
    return samplers_[index];
}

unsigned int ObjectCache::framebuffer(std::span<const Texture* const> targets) {
    std::vector<unsigned int> key;
    for (const Texture* target : targets) key.push_back(target->handle());
    if (const auto found = framebuffers_.find(key); found != framebuffers_.end()) return found->second;

    GLuint framebuffer = 0;
    gl_.CreateFramebuffers(1, &framebuffer);
    std::vector<GLenum> buffers;
    for (const Texture* target : targets) {
        buffers.push_back(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + buffers.size()));
        if (target->desc().layers > 1) {
            gl_.NamedFramebufferTextureLayer(framebuffer, buffers.back(), target->handle(), 0, 0);
        } else {
            gl_.NamedFramebufferTexture(framebuffer, buffers.back(), target->handle(), 0);
        }
    }
    gl_.NamedFramebufferDrawBuffers(framebuffer, static_cast<GLsizei>(buffers.size()), buffers.data());
    const GLenum status = gl_.CheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        gl_.DeleteFramebuffers(1, &framebuffer);
        throw Error(ExitCode::effect,
                    fmt::format("the targets form no framebuffer ({})", status_name(status)));
    }
    framebuffers_.emplace(std::move(key), framebuffer);
    return framebuffer;
}

void ObjectCache::forget_texture(unsigned int handle) {
    for (auto entry = framebuffers_.begin(); entry != framebuffers_.end();) {
        const auto& targets = entry->first;
        if (std::find(targets.begin(), targets.end(), handle) == targets.end()) {
            ++entry;
        } else {
            gl_.DeleteFramebuffers(1, &entry->second);
            entry = framebuffers_.erase(entry);
        }
    }
}

}  // namespace aftershade::gpu
