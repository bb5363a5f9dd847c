// What moving texels took.
#pragma once

#include <cstdint>

namespace aftershade::gpu {

struct TransferUse {
    std::uint64_t buffer_bytes = 0;  ///< of mapped buffers, which grow to what frames need
    // Of the context's thread, which copied, or waited for GL to.
    double upload_ms = 0;
    double read_ms = 0;  ///< from when the texels were drawn
};

}  // namespace aftershade::gpu
