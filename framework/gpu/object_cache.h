// Samplers and framebuffers of one Context, made on first use. Internal to framework/gpu.
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include "framework/gpu/commands.h"

struct GladGLContext;

namespace aftershade::gpu {

/// [the context's thread, with the context current]
class ObjectCache {
public:
    explicit ObjectCache(const GladGLContext& gl) : gl_(gl) {}
    ~ObjectCache();
    ObjectCache(const ObjectCache&) = delete;
    ObjectCache& operator=(const ObjectCache&) = delete;

    unsigned int sampler(Filter filter, Wrap wrap, bool mips);
    /// The framebuffer with level 0, layer 0 of each target as an attachment. Throws Error(ExitCode::effect)
    /// with GL's status where it is incomplete.
    unsigned int framebuffer(std::span<const Texture* const> targets);
    /// Drops what refers to a texture that is about to die; GL may give its name to another.
    void forget_texture(unsigned int handle);

private:
    const GladGLContext& gl_;
    std::array<unsigned int, 8> samplers_{};
    std::map<std::vector<unsigned int>, unsigned int> framebuffers_;
};

}  // namespace aftershade::gpu
