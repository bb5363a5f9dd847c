#include "framework/gpu/half_kernels.h"

#include "framework/gpu/context_internal.h"

namespace aftershade::gpu {
namespace {

constexpr int kGroupWidth = 32, kGroupHeight = 4;

/// Texels are bound as integers, so that no NaN loses a bit on the way.
constexpr const char* kUnpack = R"(#version 450 core
layout(local_size_x = 32, local_size_y = 4) in;
layout(location = 0) uniform ivec3 rows;  // width, first, count
layout(std430, binding = 0) readonly restrict buffer Halfs { uvec2 halfs[]; };
layout(rgba32ui, binding = 0) writeonly restrict uniform uimage2D texels;

uint float_of(uint half_bits) {
    uint sign = (half_bits & 0x8000u) << 16, size = half_bits & 0x7fffu;
    if (size >= 0x7c00u) return sign | 0x7f800000u | (size & 0x3ffu) << 13;
    if (size >= 0x400u) return sign | (size << 13) + (112u << 23);
    if (size == 0u) return sign;
    int top = findMSB(size);  // a subnormal half: 2^-24 times the integer `size`
    return sign | uint(top + 103) << 23 | (size << (23 - top)) & 0x7fffffu;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= rows.x || at.y >= rows.z) return;
    uvec2 texel = halfs[at.y * rows.x + at.x];
    imageStore(texels, ivec2(at.x, at.y + rows.y),
               uvec4(float_of(texel.x & 0xffffu), float_of(texel.x >> 16),
                     float_of(texel.y & 0xffffu), float_of(texel.y >> 16)));
}
)";

/// The first dispatch writes halfs; where a value is none, it gives the second one, which writes floats, its
/// groups.
constexpr const char* kPack = R"(#version 450 core
layout(local_size_x = 32, local_size_y = 4) in;
layout(location = 0) uniform ivec3 rows;  // width, first, count
layout(location = 1) uniform bool spills;
layout(rgba32ui, binding = 0) readonly restrict uniform uimage2D texels;
layout(std430, binding = 0) writeonly buffer Halfs { uvec2 halfs[]; };
layout(std430, binding = 1) writeonly buffer Floats { uvec4 floats[]; };
layout(std430, binding = 2) buffer Spill { uint groups[4]; };

const uint kLargest = 0x477fe000u;         // 65504
const uint kSmallestNormal = 0x38800000u;  // 2^-14

uint half_of(uint bits) {
    uint sign = (bits >> 16) & 0x8000u, size = bits & 0x7fffffffu;
    if (size >= kSmallestNormal)
        return sign | (size - (112u << 23) + 0xfffu + ((size >> 13) & 1u)) >> 13;
    uint exponent = size >> 23;
    if (exponent < 102u) return sign;  // below 2^-25, half the least half
    uint whole = size & 0x7fffffu | 0x800000u, shift = 126u - exponent;
    return sign | (whole + (1u << (shift - 1u)) - 1u + ((whole >> shift) & 1u)) >> shift;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= rows.x || at.y >= rows.z) return;
    uvec4 texel = imageLoad(texels, ivec2(at.x, at.y + rows.y));
    int index = at.y * rows.x + at.x;
    if (spills) {
        floats[index] = texel;
        return;
    }
    halfs[index] = uvec2(half_of(texel.x) | half_of(texel.y) << 16, half_of(texel.z) | half_of(texel.w) << 16);
    if (any(greaterThan(texel & 0x7fffffffu, uvec4(kLargest)))) {
        groups[0] = gl_NumWorkGroups.x;
        groups[1] = gl_NumWorkGroups.y;
        groups[2] = 1u;
    }
}
)";

GLuint groups(int size, int of_group) {
    return static_cast<GLuint>((size + of_group - 1) / of_group);
}

void dispatch(const GladGLContext& gl, int width, TexelRows rows) {
    gl.DispatchCompute(groups(width, kGroupWidth), groups(rows.count, kGroupHeight), 1);
}

void bind_storage(const GladGLContext& gl, GLuint binding, const MappedPiece& piece) {
    gl.BindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, piece.buffer->name,
                       static_cast<GLintptr>(piece.offset), static_cast<GLsizeiptr>(piece.memory.size()));
}

}  // namespace

void HalfKernels::bind(const TexelPlace& place, TexelRows rows, const Program& program, bool writes) const {
    const GladGLContext& gl = context_.gl();
    gl.UseProgram(program.handle());
    gl.ProgramUniform3i(program.handle(), 0, place.width(), rows.first, rows.count);
    gl.BindImageTexture(0, place.texture, place.level, GL_FALSE, place.layer,
                        writes ? GL_WRITE_ONLY : GL_READ_ONLY, GL_RGBA32UI);
}

void HalfKernels::end() const {
    const GladGLContext& gl = context_.gl();
    gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
    gl.UseProgram(0);
    gl.BindImageTexture(0, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
    for (GLuint binding = 0; binding < 3; ++binding) gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, 0);
}

void HalfKernels::unpack(const MappedPiece& from, const TexelPlace& to, TexelRows rows) {
    if (!unpack_) unpack_ = Program::compute(context_, kUnpack, "host.unpack_halfs");
    bind(to, rows, *unpack_, true);
    bind_storage(context_.gl(), 0, from);
    dispatch(context_.gl(), to.width(), rows);
    end();
}

void HalfKernels::pack(const TexelPlace& from, TexelRows rows, const MappedPiece& to,
                       const MappedPiece& flag) {
    if (!pack_) {
        pack_ = Program::compute(context_, kPack, "host.pack_halfs");
        spill_.emplace(context_, flag.memory.size(), "host.pack_halfs.spill");
    }
    const GladGLContext& gl = context_.gl();
    spill_->clear(0);
    gl.MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    bind(from, rows, *pack_, false);
    bind_storage(gl, 0, to);
    bind_storage(gl, 1, to);
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, spill_->handle());
    gl.ProgramUniform1i(pack_->handle(), 1, GL_FALSE);
    dispatch(gl, from.width(), rows);
    gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
    gl.ProgramUniform1i(pack_->handle(), 1, GL_TRUE);
    gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, spill_->handle());
    gl.DispatchComputeIndirect(0);
    gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
    end();
    gl.CopyNamedBufferSubData(spill_->handle(), flag.buffer->name, 0, static_cast<GLintptr>(flag.offset),
                              static_cast<GLsizeiptr>(flag.memory.size()));
}

HalfKernels& half_kernels(Context& context) {
    std::shared_ptr<HalfKernels>& kernels = context.impl().half_kernels;
    if (!kernels) kernels = std::make_shared<HalfKernels>(context);
    return *kernels;
}

}  // namespace aftershade::gpu
