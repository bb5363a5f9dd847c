// Memory that the processor and a card both reach, through which texels go one way or the other while neither
// waits. Internal to framework/gpu, but for the names.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/work_threads.h"
#include "framework/gpu/transfer_use.h"

struct GladGLContext;
struct __GLsync;

namespace aftershade::gpu {

/// `direct`: GL copies from and to the caller's memory, and is waited for. `mapped`: through the buffers
/// below.
enum class TransferWay { automatic, direct, mapped };
/// "auto", "direct", "mapped".
std::optional<TransferWay> parse_transfer_way(std::string_view name);
/// What $AFTERSHADE_TRANSFERS names, else `direct` on a software renderer, whose memory is the caller's, and
/// `mapped` elsewhere. Throws Error(ErrorKind::usage) for an unknown name.
TransferWay chosen_transfer_way(bool is_software);

/// A fence, deleted with its owner.
class Fence {
public:
    Fence() = default;
    /// Behind every command so far.
    explicit Fence(const GladGLContext& gl);
    ~Fence() { drop(); }
    Fence(Fence&& other) noexcept;
    Fence& operator=(Fence&& other) noexcept;
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;

    bool is_reached() const;
    void wait() const;
    void drop() noexcept;
    /// Leaves GL's object to the process's end.
    void leak() noexcept { fence_ = nullptr; }

private:
    const GladGLContext* gl_ = nullptr;
    __GLsync* fence_ = nullptr;
};

/// A buffer that stays mapped, coherent.
struct MappedBuffer {
    unsigned int name = 0;
    std::span<std::byte> memory;
    std::size_t used = 0;
};

/// A part of one. As long as it is held, no other piece overlaps it.
struct MappedPiece {
    std::shared_ptr<MappedBuffer> buffer;
    std::size_t offset = 0;
    std::span<std::byte> memory;
};

/// [the context's thread, with the context current]
class Transfers {
public:
    /// `forget_errors` drops what GL has reported since its last check: without memory for a buffer, texels
    /// go directly.
    Transfers(const GladGLContext& gl, TransferWay way, std::function<void()> forget_errors);
    ~Transfers();
    Transfers(const Transfers&) = delete;
    Transfers& operator=(const Transfers&) = delete;

    bool is_mapped() const { return way_ == TransferWay::mapped; }
    /// Memory for whole rows, from one to as many as `bytes` are, for commands up to the next call. nullopt
    /// where there is no buffer.
    std::optional<MappedPiece> to_write(std::size_t row_bytes, std::size_t bytes);
    /// The same for what GL writes; nullopt, too, where the pieces that are held leave no room.
    std::optional<MappedPiece> to_read(std::size_t row_bytes, std::size_t bytes);
    /// Calls work(begin, end) over parts of `count` values of `value_bytes` each, on as many threads as that
    /// is worth. `work` must not throw.
    void share_out(std::size_t count, std::size_t value_bytes,
                   const std::function<void(std::size_t begin, std::size_t end)>& work);
    TransferUse use() const { return use_; }
    /// Counts the caller's time in the use, for as long as it lives.
    class Timed {
    public:
        Timed(Transfers& transfers, double TransferUse::*sum) : sum_(transfers.use_.*sum) {}
        ~Timed() { sum_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }
        Timed(const Timed&) = delete;
        Timed& operator=(const Timed&) = delete;

    private:
        using Clock = std::chrono::steady_clock;
        double& sum_;
        Clock::time_point start_ = Clock::now();
    };

private:
    struct Waiting {
        std::shared_ptr<MappedBuffer> buffer;
        Fence fence;  ///< behind the commands that read it
    };

    std::shared_ptr<MappedBuffer> make(std::size_t wanted, bool for_reading);
    void next_to_write(std::size_t bytes);

    const GladGLContext& gl_;
    TransferWay way_;
    std::function<void()> forget_errors_;
    std::shared_ptr<MappedBuffer> filling_;
    std::deque<Waiting> waiting_;  // for GL, oldest first
    std::vector<std::shared_ptr<MappedBuffer>> reads_;
    std::uint64_t write_bytes_ = 0, read_bytes_ = 0, most_bytes_ = 0;
    TransferUse use_;
    std::unique_ptr<WorkThreads> threads_;
};

}  // namespace aftershade::gpu
