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

}  // namespace aftershade
