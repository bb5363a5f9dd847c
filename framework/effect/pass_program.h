// Compiles the shaders of a pass and speaks of their faults in the author's files and lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/effect/fused_shader.h"
#include "framework/effect/program_store.h"
#include "framework/effect/shader_source.h"
#include "framework/gpu/program.h"

namespace aftershade {

/// The storage block of a guarded program: one word, which is not 0 once llvmpipe has ended a loop.
inline constexpr int kLoopGuardBinding = 15;

/// Programs by their full text, so that equal shaders compile once; those of earlier runs come from `store`.
/// [the context's thread]
class ProgramCache {
public:
    /// Programs that no graph holds; of more, those go that were not used for the longest time.
    static constexpr std::size_t kMostIdlePrograms = 128;

    ProgramCache(gpu::Context& context, std::filesystem::path glsl_folder,
                 ProgramStore store = ProgramStore::from_environment());

    /// The program of a draw or a compute pass. Throws Error(ExitCode::effect) with one line per fault:
    /// "effects/bokeh/coc.frag:6:17: error: 'parm' undeclared   [pass coc, llvmpipe ...]".
    std::shared_ptr<const gpu::Program> get(const ShaderContext& context);
    /// The program of several passes; nullptr where the driver does not take it, or a part has a fault that
    /// get() reports.
    std::shared_ptr<const gpu::Program> fused(const FusedProgram& passes);
    /// A full-screen shader of the host's own, glsl/host/<file>, with symbols defined after its first line.
    std::shared_ptr<const gpu::Program> host(const std::string& file,
                                             const std::vector<std::string>& defines);
    /// Programs made from now on report into a storage block whether llvmpipe ended one of their loops.
    /// [before the first program]
    void guard_loops() { guards_loops_ = true; }
    bool is_guarding_loops() const { return guards_loops_; }
    const std::filesystem::path& glsl_folder() const { return glsl_folder_; }
    int compiled_count() const { return compiled_; }  ///< programs made from text
    int loaded_count() const { return loaded_; }      ///< programs taken from the store

private:
    struct Sources;
    struct Cached {
        std::shared_ptr<const gpu::Program> program;
        std::uint64_t last_use = 0;
    };
    std::shared_ptr<const gpu::Program> made_once(const Sources& sources, const std::string& label);
    void drop_idle();
    Sources assemble(const ShaderContext& context, Diagnostics& faults) const;
    gpu::Program make(const Sources& sources, const std::string& label);
    std::string key_of(const Sources& sources) const;

    gpu::Context& context_;
    std::filesystem::path glsl_folder_;
    ProgramStore store_;
    std::string full_screen_;  // the vertex shader of a draw that has none
    std::map<std::string, Cached> programs_;
    std::uint64_t uses_ = 0;  // of the cache so far
    bool guards_loops_ = false;
    int compiled_ = 0;
    int loaded_ = 0;
};

}  // namespace aftershade
