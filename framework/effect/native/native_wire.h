// Messages to and from native code in a separate process, as bytes. Internal to
// framework/effect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "framework/effect/native/native_types.h"

namespace aftershade {

/// Requests to a process of native code; the words of a request begin with one.
enum class NativeRequest { open = 1, create, prepare, reset, destroy };

/// Above any sound message: eight tables of the largest size.
inline constexpr std::uint64_t kMaxNativeMessage = 256ull << 20;

class WireWriter {
public:
    void number(std::int64_t value);
    void real(double value);
    void flag(bool value) { number(value ? 1 : 0); }
    void text(std::string_view value);
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

/// Throws Error(ErrorKind::effect) for bytes that no WireWriter wrote: they may be a plug-in's.
class WireReader {
public:
    /// `bytes` must outlive this.
    explicit WireReader(std::string_view bytes) : rest_(bytes) {}

    std::int64_t number();
    double real();
    bool flag() { return number() != 0; }
    std::string text();
    /// The number of things that follow, each of at least `bytes_each`. Refuses more than the rest of the
    /// message has room for, so that a short message never allocates much.
    std::size_t count(std::size_t bytes_each = 1);
    void expect_end() const;

private:
    std::string_view take(std::size_t bytes);

    std::string_view rest_;
};

void put(WireWriter& out, const NativeDeclaration& declaration);
NativeDeclaration take_declaration(WireReader& in);

/// A frame with what it points to. Never moved.
struct WireFrame {
    WireFrame() = default;
    WireFrame(const WireFrame&) = delete;
    WireFrame& operator=(const WireFrame&) = delete;

    std::vector<ParamSpec> specs;
    ParamSet params;
    Camera camera;
    NativeFrame frame;
};
/// Parameters arrive with their names, types, units and values; of curves and tables only that they are such,
/// which is all that native code may read.
void put(WireWriter& out, const NativeFrame& frame);
void take_frame(WireReader& in, WireFrame& frame);

void put(WireWriter& out, const NativeResult& result);
/// Unchecked: the one who sent it may have been tampered with.
NativeResult take_result(WireReader& in);

}  // namespace aftershade
