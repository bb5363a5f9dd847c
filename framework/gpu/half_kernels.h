// What a card does so that texels of four floats travel as halfs. Internal to framework/gpu.
#pragma once

#include <optional>

#include "framework/gpu/buffer.h"
#include "framework/gpu/program.h"
#include "framework/gpu/texel_place.h"
#include "framework/gpu/transfers.h"

namespace aftershade::gpu {

struct TexelRows {
    int first = 0;
    int count = 0;
};

/// Both in integers: each card and llvmpipe give the same bits. [the context's thread]
class HalfKernels {
public:
    explicit HalfKernels(Context& context) : context_(context) {}

    /// The rows become what the piece holds, four halfs a texel.
    void unpack(const MappedPiece& from, const TexelPlace& to, TexelRows rows);
    /// The rows as halfs, rounded to the nearest, ties to even. Where a value is beyond 65504, infinite or
    /// NaN, the piece gets all rows as floats, and the first word of `flag` is not 0. The piece has room for
    /// floats, `flag` for 16 bytes.
    void pack(const TexelPlace& from, TexelRows rows, const MappedPiece& to, const MappedPiece& flag);

private:
    void bind(const TexelPlace& place, TexelRows rows, const Program& program, bool writes) const;
    void end() const;

    Context& context_;
    std::optional<Program> unpack_, pack_;  // made when they are first needed
    std::optional<Buffer> spill_;           // groups of the dispatch that writes floats
};

/// Those of the context.
HalfKernels& half_kernels(Context& context);

}  // namespace aftershade::gpu
