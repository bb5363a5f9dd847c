// Runs a compiled graph, frame after frame, in the same memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/gpu/buffer.h"
#include "framework/gpu/texture.h"
#include "framework/gpu/timer.h"
#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

/// Passes begin .. end - 1 by their index in the graph; end -1: to the last.
struct PassRange {
    int begin = 0;
    int end = -1;
    bool contains(int pass) const { return pass >= begin && (end < 0 || pass < end); }
};

struct PassTime {
    std::string pass;
    double milliseconds = 0;
};

/// One that the GPU may still be measuring.
struct PendingTime {
    std::string pass;
    gpu::Duration duration;
};
/// Waits for the GPU.
std::vector<PassTime> measured(std::vector<PendingTime> times);

/// [the context's thread]
class Executor {
public:
    /// Allocates every texture and buffer; histories begin as zero. Throws Error(ErrorKind::effect) when GL
    /// has no memory for them, GraphError if a pass that is not culled lacks its program. Without
    /// `shares_memory` the last passes may run again over what the others made (run(), `range`).
    Executor(gpu::Context& context, FrameGraph graph, bool shares_memory = true);
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    const FrameGraph& graph() const { return graph_; }
    const CompiledGraph& compiled() const { return compiled_; }
    /// The texture behind an imported or kept handle, the same in every frame; nullptr for one that no pass
    /// needs. A history's holds what it held at the end of the last run() until the next.
    gpu::Texture* texture(TextureHandle handle);
    gpu::Buffer* buffer(BufferHandle handle);
    /// Replaces the content of a uniform block of a pass; `bytes` has the size that the pass was added with.
    /// Without effect for a culled pass.
    void set_uniforms(int pass, int binding, std::vector<std::byte> bytes);

    /// The name of a pass that has just run, and its targets and written images, by their names in the
    /// graph.
    using PassObserver =
        std::function<void(const std::string& pass, const std::string& texture, const gpu::Texture& target)>;

    /// Called around each pass, with its name.
    struct PassHooks {
        std::function<void(const std::string& pass)> begins;
        std::function<void(const std::string& pass)> ended;  ///< may throw: the frame is lost then
        bool waits = false;          ///< a timed pass has ended on the GPU before the next begins
        gpu::BufferBinding storage;  ///< besides the pass's own, of all but clears; none: its buffer is null
    };
    /// Once, before the first run. The buffer must outlive this.
    void set_hooks(PassHooks hooks);

    /// Issues every pass. With `timed`, measures each (see gpu::Timer); else returns {}. `observer`, if any,
    /// sees each target right after its pass; its time counts for no pass.
    /// At the end, each history that was written becomes what the next run reads as its `previous`. `range`:
    /// only these, so that some passes may run several times in a frame; what was written before stays.
    std::vector<PendingTime> issue(bool timed, const PassObserver& observer = {}, PassRange range = {});
    /// The same; with `timed`, waits for the passes to end.
    std::vector<PassTime> run(bool timed, const PassObserver& observer = {}, PassRange range = {}) {
        return measured(issue(timed, observer, range));
    }

    /// The textures that the next run will read as `previous`, by the history's name; only those that some
    /// pass reads. The pointers hold until the next run.
    struct History {
        std::map<std::string, gpu::Texture*> textures;
        std::map<std::string, gpu::Buffer*> buffers;
    };
    History history();
    /// Sets every `previous` to zero: a cut, a gap, the first frame.
    void clear_history();
    /// Takes the histories over whose name and description are those of `other`, for a graph that was rebuilt
    /// between two frames; returns the names of those of this graph that found none and stay as they were.
    /// `other`, of the same context, is left with this one's in exchange. Copies nothing.
    std::vector<std::string> take_history_from(Executor& other);

private:
    /// The bindings of a pass. The pointers go to slots, which never move; a history's two slots exchange
    /// what they hold.
    struct BoundPass {
        const Pass* pass = nullptr;
        std::vector<gpu::SampledTexture> textures;
        std::vector<gpu::ImageBinding> images;
        std::vector<gpu::BufferBinding> uniforms;
        std::vector<gpu::BufferBinding> storage;
        std::vector<gpu::Target> targets;
        gpu::InstanceRange instances;
        const gpu::Buffer* groups = nullptr;
        std::vector<gpu::Texture*> clear_targets;  // of a clear pass, as Pass::targets
        std::vector<gpu::Texture*> mips;           // filled after the pass
        struct Observed {
            const std::string* name = nullptr;
            const gpu::Texture* texture = nullptr;
        };
        std::vector<Observed> observed;
    };
    /// Resources that are set to their `clear` before a pass.
    struct Clears {
        struct OfTexture {
            gpu::Texture* texture = nullptr;
            std::array<double, 4> value{};
            bool is_there = false;  ///< the memory is new, and a driver's zeros are the value
        };
        std::vector<OfTexture> textures;
        std::vector<std::pair<gpu::Buffer*, std::span<const std::uint32_t>>> buffers;
    };
    template <typename Memory>
    struct HistorySlots {
        const std::string* name = nullptr;
        Memory* previous = nullptr;
        Memory* current = nullptr;      // nullptr where no pass writes it
        int written_by = -1;            // the last pass that writes it, by its index in the graph
        bool current_is_newer = false;  // between a run and the next

        Memory* newest() const { return current_is_newer ? current : previous; }
        void advance() {
            if (current_is_newer) std::swap(*previous, *current);
            current_is_newer = false;
        }
    };

    void allocate();
    void find_histories();
    void bind_clears();
    BoundPass bind(int index);
    void run_clears(Clears& clears);
    void forget_new_memory();
    void run_pass(const BoundPass& bound);
    void run_program(const BoundPass& bound);

    gpu::Context& context_;
    FrameGraph graph_;
    CompiledGraph compiled_;
    std::vector<gpu::Texture> slots_;
    std::map<std::pair<int, gpu::TextureFormat>, gpu::Texture>
        views_;  // slots under other formats than theirs
    std::vector<gpu::Buffer> buffer_slots_;
    std::map<std::pair<int, int>, gpu::Buffer> uniforms_;  // by pass and binding
    std::vector<HistorySlots<gpu::Texture>> texture_histories_;
    std::vector<HistorySlots<gpu::Buffer>> buffer_histories_;
    std::vector<BoundPass> bound_;  // as compiled_.passes
    std::vector<Clears> clears_;    // one more than passes: what is cleared at the end
    gpu::Timer timer_;
    PassHooks hooks_;
};

}  // namespace aftershade::graph
