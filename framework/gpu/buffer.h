// Uniform, storage and indirect buffers with a debug label.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/context.h"
#include "framework/gpu/handle.h"

namespace aftershade::gpu {

/// [the context's thread]
class Buffer {
public:
    /// Zero-filled. Throws Error(ErrorKind::effect) when GL has no memory for it.
    Buffer(Context& context, std::size_t bytes, std::string label);

    std::size_t size() const { return bytes_; }
    void write(std::span<const std::byte> values, std::size_t offset = 0);
    std::vector<std::byte> read() const;
    void clear(std::uint32_t value);

    unsigned int handle() const { return handle_.name(); }  ///< for framework/gpu

private:
    Handle<ObjectKind::buffer> handle_;
    std::size_t bytes_ = 0;
    std::string label_;
};

}  // namespace aftershade::gpu
