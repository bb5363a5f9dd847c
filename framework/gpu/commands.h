// What a pass can do: draw over the whole target, draw instances, dispatch. Clearing is the textures' own.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "framework/gpu/buffer.h"
#include "framework/gpu/object_cache.h"
#include "framework/gpu/program.h"
#include "framework/gpu/texture.h"

namespace aftershade::gpu {

enum class Access { read, write, read_write };
enum class Blend { none, add, min, max };
/// Of an instance: four vertices of a triangle strip, or one point.
enum class Primitive { quads, points };

struct SampledTexture {
    const Texture* texture = nullptr;
    int binding = 0;  ///< layout(binding = N) of the sampler
    Filter filter = Filter::nearest;
    Wrap wrap = Wrap::clamp;
    std::optional<int> level{};  ///< the only level that is seen, as level 0; nullopt: all
};

/// One level and layer that a draw renders to.
struct Target {
    const Texture* texture = nullptr;
    int level = 0;
    int layer = 0;
};

struct ImageBinding {
    const Texture* texture = nullptr;
    int binding = 0;  ///< layout(binding = N) of the image
    int level = 0;
    Access access = Access::read_write;
    std::optional<int> layer{};  ///< of an array: the one that is seen, as a 2-D image; nullopt: all
};

struct BufferBinding {
    const Buffer* buffer = nullptr;
    int binding = 0;
};

struct Bindings {
    std::span<const SampledTexture> textures{};
    std::span<const ImageBinding> images{};
    std::span<const BufferBinding> uniforms{};  ///< uniform blocks
    std::span<const BufferBinding> storage{};   ///< shader storage blocks
};

/// Draws one triangle over all targets, which share one size; gl_FragCoord (0.5, 0.5) is texel (0, 0), the
/// top left, and NDC has +y at the top and z in [0, 1]. The vertex shader of `program` makes the triangle
/// from gl_VertexID 0..2. A texture may be sampled while it is drawn to where the one level that is seen is
/// not a target. Throws Error(ErrorKind::effect) naming `program` if GL reports an error or the targets do
/// not form a complete framebuffer. After a pass with images or storage blocks stands a barrier for
/// everything that a later pass or a command from a buffer may read; the same holds for the functions below.
void draw(Context& context, const Program& program, std::span<const Target> targets, const Bindings& bindings,
          Blend blend = Blend::none);

/// The arguments of draw_instances: `count` of them, or what DrawArraysIndirectCommand at the beginning of
/// `indirect` (16 bytes: vertices, instances, first vertex, first instance) says.
struct InstanceRange {
    Primitive primitive = Primitive::quads;
    int count = 0;
    const Buffer* indirect = nullptr;
};

/// As draw(), but with one strip of gl_VertexID 0..3, or one point of one texel, for each gl_InstanceID from
/// 0.
void draw_instances(Context& context, const Program& program, std::span<const Target> targets,
                    const Bindings& bindings, const InstanceRange& instances, Blend blend = Blend::none);

/// While it lives, draws and dispatches of the context draw nothing and dispatch no group, whatever their
/// arguments; the driver makes a program's machine code all the same. [the context's thread; one at a time]
class NothingToDo {
public:
    explicit NothingToDo(Context& context);
    ~NothingToDo();
    NothingToDo(const NothingToDo&) = delete;
    NothingToDo& operator=(const NothingToDo&) = delete;

private:
    Context& context_;
    Buffer no_groups_;
};

/// Copies the levels of `to` from `from`, bit for bit; both have one size, one format and one layer. On
/// software GL this takes a third of the time of a draw.
void copy(Context& context, const Texture& from, const Texture& to);

/// Dispatches groups_x * groups_y * groups_z work groups.
void dispatch(Context& context, const Program& program, int groups_x, int groups_y, int groups_z,
              const Bindings& bindings);
/// The same with the three numbers at the beginning of `groups` (DispatchIndirectCommand, 12 bytes).
void dispatch_indirect(Context& context, const Program& program, const Buffer& groups,
                       const Bindings& bindings);
/// Sides of the work groups of dispatch_over(), texels.
inline constexpr int kGroupSide = 8;
/// Dispatches a work group for each square of kGroupSide texels of the targets, which share one size and are
/// the program's images from `first_unit` on, to be written. Throws as draw() does.
void dispatch_over(Context& context, const Program& program, std::span<const Target> targets, int first_unit,
                   const Bindings& bindings);

}  // namespace aftershade::gpu
