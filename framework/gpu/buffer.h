// Uniform, storage and indirect buffers with a debug label.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/context.h"

namespace aftershade::gpu {

/// [the context's thread]
class Buffer {
public:
    /// Zero-filled. Throws Error(ExitCode::effect) when GL has no memory for it.
    Buffer(Context& context, std::size_t bytes, std::string label);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    std::size_t size() const { return bytes_; }
    void write(std::span<const std::byte> values, std::size_t offset = 0);
    std::vector<std::byte> read() const;
    void clear(std::uint32_t value);

    unsigned int handle() const { return handle_; }  ///< for framework/gpu

private:
    Context* context_ = nullptr;
    unsigned int handle_ = 0;
    std::size_t bytes_ = 0;
    std::string label_;
};

}  // namespace aftershade::gpu
