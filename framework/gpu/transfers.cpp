#include "framework/gpu/transfers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <utility>

#include "framework/base/cores.h"
#include "framework/base/error.h"
#include "framework/base/memory_limit.h"

#include <glad/gl.h>

namespace aftershade::gpu {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"auto", "direct", "mapped"};
constexpr std::size_t kMiB = std::size_t{1} << 20;
/// A row of the widest texture, 32768 texels of 16 bytes, fits into the least.
constexpr std::size_t kLeastBuffer = kMiB, kMostBuffer = 16 * kMiB;
/// For each direction: two frames of 4K in floats. At most this part of the machine's memory, too.
constexpr std::uint64_t kMostBytes = 512 * kMiB;
constexpr std::uint64_t kPartOfMemory = 16;
/// Every type of texel may begin at such an offset.
constexpr std::size_t kAlignment = 256;
/// A thread wakes in the time in which it copies 50 kB.
constexpr std::size_t kWorthwhile = kMiB / 4;

std::size_t aligned(std::size_t offset) {
    return (offset + kAlignment - 1) / kAlignment * kAlignment;
}

std::size_t room(const MappedBuffer& buffer) {
    return buffer.memory.size() - std::min(buffer.memory.size(), aligned(buffer.used));
}

/// As many of the rows as there is room for.
MappedPiece taken(const std::shared_ptr<MappedBuffer>& buffer, std::size_t row_bytes, std::size_t bytes) {
    const std::size_t offset = aligned(buffer->used);
    const std::size_t rows = std::min(bytes, buffer->memory.size() - offset) / row_bytes;
    buffer->used = offset + rows * row_bytes;
    return {buffer, offset, buffer->memory.subspan(offset, rows * row_bytes)};
}

}  // namespace

std::optional<TransferWay> parse_transfer_way(std::string_view name) {
    const auto found = std::ranges::find(kNames, name);
    if (found == kNames.end()) return std::nullopt;
    return static_cast<TransferWay>(found - kNames.begin());
}

TransferWay chosen_transfer_way(bool is_software) {
    if (const char* const name = std::getenv("AFTERSHADE_TRANSFERS"); name && *name) {
        const auto named = parse_transfer_way(name);
        if (!named)
            throw Error(ErrorKind::usage, "AFTERSHADE_TRANSFERS: '" + std::string(name) +
                                              "' is not one of auto, direct, mapped");
        if (*named != TransferWay::automatic) return *named;
    }
    return is_software ? TransferWay::direct : TransferWay::mapped;
}

Fence::Fence(const GladGLContext& gl) : gl_(&gl), fence_(gl.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {}

Fence::Fence(Fence&& other) noexcept : gl_(other.gl_), fence_(std::exchange(other.fence_, nullptr)) {}

Fence& Fence::operator=(Fence&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(fence_, other.fence_);
    return *this;
}

void Fence::drop() noexcept {
    if (fence_) gl_->DeleteSync(std::exchange(fence_, nullptr));
}

bool Fence::is_reached() const {
    return !fence_ || gl_->ClientWaitSync(fence_, GL_SYNC_FLUSH_COMMANDS_BIT, 0) != GL_TIMEOUT_EXPIRED;
}

void Fence::wait() const {
    constexpr GLuint64 kSecond_ns = 1'000'000'000;
    while (fence_ &&
           gl_->ClientWaitSync(fence_, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond_ns) == GL_TIMEOUT_EXPIRED) {
    }
}

Transfers::Transfers(const GladGLContext& gl, TransferWay way, std::function<void()> forget_errors)
    : gl_(gl),
      way_(way),
      forget_errors_(std::move(forget_errors)),
      most_bytes_(std::min(kMostBytes, machine_memory_bytes() / kPartOfMemory)) {}

Transfers::~Transfers() {
    const auto remove = [&](const MappedBuffer& buffer) {
        gl_.UnmapNamedBuffer(buffer.name);
        gl_.DeleteBuffers(1, &buffer.name);
    };
    if (filling_) remove(*filling_);
    for (const Waiting& waiting : waiting_) remove(*waiting.buffer);
    for (const auto& buffer : reads_) remove(*buffer);
}

std::shared_ptr<MappedBuffer> Transfers::make(std::size_t wanted, bool for_reading) {
    const std::size_t size = std::clamp(std::bit_ceil(wanted), kLeastBuffer, kMostBuffer);
    std::uint64_t& taken = for_reading ? read_bytes_ : write_bytes_;
    const auto left = address_space_left();
    if (taken + size > most_bytes_ || (left && *left / kPartOfMemory < size)) return nullptr;
    const GLbitfield access =
        (for_reading ? GL_MAP_READ_BIT : GL_MAP_WRITE_BIT) | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    auto buffer = std::make_shared<MappedBuffer>();
    gl_.CreateBuffers(1, &buffer->name);
    gl_.NamedBufferStorage(buffer->name, static_cast<GLsizeiptr>(size), nullptr, access);
    void* const memory = gl_.MapNamedBufferRange(buffer->name, 0, static_cast<GLsizeiptr>(size), access);
    if (!memory) {
        gl_.DeleteBuffers(1, &buffer->name);
        forget_errors_();
        return nullptr;
    }
    buffer->memory = {static_cast<std::byte*>(memory), size};
    taken += size;
    use_.buffer_bytes += size;
    return buffer;
}

/// Takes a large enough buffer that GL no longer uses, else a new one. If there is no room for one, waits for
/// the buffer that GL finishes first.
void Transfers::next_to_write(std::size_t bytes) {
    if (filling_) waiting_.push_back({std::exchange(filling_, nullptr), Fence(gl_)});
    const std::size_t enough = std::min(bytes, kMostBuffer);
    auto found = waiting_.begin();
    while (found != waiting_.end() && found->fence.is_reached() && found->buffer->memory.size() < enough)
        ++found;
    const bool is_free = found != waiting_.end() && found->fence.is_reached();
    if (!is_free) {
        filling_ = make(bytes, false);
        found = waiting_.begin();
    }
    if (filling_ || waiting_.empty()) return;
    found->fence.wait();
    filling_ = std::move(found->buffer);
    filling_->used = 0;
    waiting_.erase(found);
}

std::optional<MappedPiece> Transfers::to_write(std::size_t row_bytes, std::size_t bytes) {
    // A few rows at a buffer's end are not worth a command.
    const std::size_t least = std::max(row_bytes, std::min(bytes, kLeastBuffer));
    if (!filling_ || room(*filling_) < least) next_to_write(bytes);
    if (!filling_ || room(*filling_) < row_bytes) return std::nullopt;
    return taken(filling_, row_bytes, bytes);
}

std::optional<MappedPiece> Transfers::to_read(std::size_t row_bytes, std::size_t bytes) {
    for (const auto& buffer : reads_)
        if (buffer.use_count() == 1) buffer->used = 0;  // nobody holds a piece of it
    const std::size_t least = std::max(row_bytes, std::min(bytes, kMostBuffer));
    auto found = std::ranges::find_if(reads_, [&](const auto& buffer) { return room(*buffer) >= least; });
    if (found == reads_.end()) {
        if (auto made = make(bytes, true)) {
            reads_.push_back(std::move(made));
            found = reads_.end() - 1;
        } else {
            found = std::ranges::find_if(reads_, [&](const auto& b) { return room(*b) >= row_bytes; });
        }
    }
    if (found == reads_.end()) return std::nullopt;
    return taken(*found, row_bytes, bytes);
}

void Transfers::share_out(std::size_t count, std::size_t value_bytes,
                          const std::function<void(std::size_t begin, std::size_t end)>& work) {
    const std::size_t parts = count * value_bytes / kWorthwhile;
    if (parts < 2) return work(0, count);
    if (!threads_) threads_ = std::make_unique<WorkThreads>(allotted_cores());
    // Several for each thread, since some may be late.
    constexpr std::size_t kPartsOfAThread = 4;
    const std::size_t most = std::min(parts, kPartsOfAThread * static_cast<std::size_t>(threads_->count()));
    threads_->run(static_cast<int>(most), [&](int i) {
        const auto part = static_cast<std::size_t>(i);
        work(count * part / most, count * (part + 1) / most);
    });
}

}  // namespace aftershade::gpu
