// Zlib streams (RFC 1950) in memory: by libdeflate where the build has it, else by zlib.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace aftershade {

/// Unpacks one stream after another. [one thread at a time]
class Inflater {
public:
    /// Throws std::bad_alloc.
    Inflater();
    ~Inflater();
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// Whether `packed` begins with a sound stream of exactly `raw.size()` bytes, which then fill `raw`.
    bool unpack(std::span<const char> packed, std::span<char> raw);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Packs one stream after another. [one thread at a time]
class Deflater {
public:
    /// From 1, the fastest, to 9. Throws std::bad_alloc.
    explicit Deflater(int level);
    ~Deflater();
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;

    /// The bytes of `packed` that the stream of `raw` takes; 0 where it does not fit.
    std::size_t pack(std::span<const char> raw, std::span<char> packed);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace aftershade
