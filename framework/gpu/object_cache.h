// Samplers, views of one level and framebuffers of one Context, made on first use. Internal to framework/gpu.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "framework/gpu/texture_format.h"

struct GladGLContext;

namespace aftershade::gpu {

enum class Filter { nearest, linear };
/// What a fetch outside the texture gives: the nearest texel, or zero.
enum class Wrap { clamp, zero };
/// A texture as far as what is made from it needs.
struct CachedTexture {
    unsigned int handle = 0;
    TextureFormat format = TextureFormat::rgba32f;
    int layers = 1;
    auto operator<=>(const CachedTexture&) const = default;
};

/// One level and layer of a texture that is drawn to.
struct Attachment {
    CachedTexture texture;
    int level = 0;
    int layer = 0;
    auto operator<=>(const Attachment&) const = default;
};

/// [the context's thread, with the context current]
class ObjectCache {
public:
    explicit ObjectCache(const GladGLContext& gl) : gl_(gl) {}
    ~ObjectCache();
    ObjectCache(const ObjectCache&) = delete;
    ObjectCache& operator=(const ObjectCache&) = delete;

    unsigned int sampler(Filter filter, Wrap wrap, bool mips);
    /// A texture whose only level is `level` of `texture`, in the same memory.
    unsigned int level_view(const CachedTexture& texture, int level);
    /// The framebuffer with these attachments. Throws Error(ErrorKind::effect) with GL's status
    /// where it is incomplete.
    unsigned int framebuffer(std::span<const Attachment> attachments);
    /// Drops what refers to a texture that is about to die; GL may give its name to another.
    void forget_texture(unsigned int handle);
    std::size_t framebuffer_count() const { return framebuffers_.size(); }
    std::size_t view_count() const { return views_.size(); }

private:
    const GladGLContext& gl_;
    std::array<unsigned int, 8> samplers_{};
    std::map<std::pair<unsigned int, int>, unsigned int> views_;  // by texture and level
    std::map<std::vector<Attachment>, unsigned int> framebuffers_;
    std::vector<Attachment> key_;  // of the last look-up; a member so that looking up allocates nothing
};

}  // namespace aftershade::gpu
