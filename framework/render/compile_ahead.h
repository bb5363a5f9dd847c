// Programs compiled on threads beside the one that draws, in contexts of their own.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "framework/effect/pass_program.h"
#include "framework/graph/rehearsal.h"

namespace aftershade {

/// Programs that a pass needs before it can be drawn, in the order of the passes.
struct PassToCompile {
    std::string pass;  ///< its name in the graph
    std::shared_ptr<const ProgramSources> sources;
    graph::PassShape shape{};
    bool is_drawn = true;  ///< false: of a pass that nothing needs, its program alone
};

/// Threads that begin with the last pass, while the caller links from the first one on, and then draw the
/// longest of what it linked; where it comes to a pass that a thread is at, it does so too meanwhile. They
/// hand over by two caches: programs by the ProgramStore, and the machine code that llvmpipe makes at a first
/// draw by Mesa's own, since no context sees another one's. They leave programs that do not compile to the
/// caller, who then meets the fault in its own order. [one thread, that of the context; threads of its own]
class CompileAhead {
public:
    /// The threads that are worth having for `context`: at most `threads`; none where a driver does not
    /// compile on the processor, and none where the address space is limited, since Mesa does not check
    /// what it allocates.
    static int useful_threads(const gpu::Context& context, int threads);
    /// Whether the Mesa of this GL_VERSION can compile on several threads at once. From 25.2 to 26.1 its
    /// compiler, LLVM's ORC JIT, is reported to crash (SkiaSharp issue 4604, wgpu issue 9903).
    static bool is_safe_on_threads(std::string_view gl_version);

    /// `context` and `programs` outlive this.
    CompileAhead(gpu::Context& context, ProgramCache& programs, std::vector<PassToCompile> passes,
                 int threads);
    /// Waits for the compilations at hand; begins no other.
    ~CompileAhead();
    CompileAhead(const CompileAhead&) = delete;
    CompileAhead& operator=(const CompileAhead&) = delete;

    /// Around the caller's own compiling of a pass's program, which then is on disk if a thread was quicker.
    class LinkScope {
    public:
        LinkScope(CompileAhead* ahead, const std::string& pass);
        ~LinkScope();
        LinkScope(const LinkScope&) = delete;
        LinkScope& operator=(const LinkScope&) = delete;

    private:
        CompileAhead* ahead_;
        int index_;
    };
    /// Before the caller draws a pass: no thread works on it from now on.
    void take(const std::string& pass);
    /// Programs that the threads have compiled so far.
    int programs_made() const;
    int passes_drawn() const;
    /// Passes that the caller drew ahead while it waited.
    int passes_drawn_here() const { return passes_drawn_here_; }

private:
    enum class State {
        open,
        linking,       // by a thread
        linking_here,  // by the caller
        linked,        // by the caller
        drawing,       // by a thread
        drawing_here,  // by the caller, ahead
        finished       // by a thread, or taken by the caller
    };

    int index_of(const std::string& pass) const;
    int begin_link(int index);
    int longest_linked() const;
    int last_open() const;
    void draw_here(int index);
    int begin_any();
    int next();
    void work();
    void work_on(ProgramCache& programs, gpu::Context& context, int index);

    gpu::Context& context_;
    ProgramCache& programs_;
    const std::filesystem::path glsl_folder_;
    const ProgramStore store_;
    const std::vector<PassToCompile> passes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<State> states_;
    std::vector<std::size_t> binary_bytes_;  ///< of what the caller linked
    bool stops_ = false;
    int programs_made_ = 0;
    int passes_drawn_ = 0;
    int passes_drawn_here_ = 0;
    std::vector<std::thread> threads_;
};

}  // namespace aftershade
