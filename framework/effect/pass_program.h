// Compiles the shaders of a pass and speaks of their faults in the author's files and lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/effect/compute_form.h"
#include "framework/effect/fused_shader.h"
#include "framework/effect/image_loads.h"
#include "framework/effect/program_store.h"
#include "framework/effect/shader_source.h"
#include "framework/gpu/program.h"

namespace aftershade {

/// The storage block of a guarded program: one word, which is not 0 once llvmpipe has ended a loop.
inline constexpr int kLoopGuardBinding = 15;

/// The texts of one program, as the driver gets them.
struct ProgramSources {
    bool is_compute = false;
    std::string vertex;         ///< of a draw
    ShaderSource vertex_lines;  ///< without lines for the host's own, which programs share
    ShaderSource main;
    std::string label;

    bool shares_vertex() const { return !is_compute && vertex_lines.lines.empty(); }
    const ShaderSource& of_stage(const std::string& stage) const {
        return stage == "vertex" ? vertex_lines : main;
    }
};

/// A draw as a compute shader; `why_not` says what keeps it from that, and then there is none.
std::optional<ProgramSources> in_compute_form(ProgramSources draw, const DrawShape& shape,
                                              std::string& why_not);

/// Programs by their full text, so that equal shaders compile once; those of earlier runs come from `store`.
/// [the context's thread]
class ProgramCache {
public:
    /// Programs that no graph holds; of more, those go that were not used for the longest time.
    static constexpr std::size_t kMostIdlePrograms = 128;

    ProgramCache(gpu::Context& context, std::filesystem::path glsl_folder,
                 ProgramStore store = ProgramStore::from_environment());

    /// The program of a draw or a compute pass. Throws Error(ErrorKind::effect) with one line per fault:
    /// "effects/bokeh/coc.frag:6:17: error: 'parm' undeclared   [pass coc, llvmpipe ...]".
    std::shared_ptr<const gpu::Program> get(const ShaderContext& context);
    /// The texts that get() compiles; what is wrong with them goes to `faults`.
    ProgramSources sources_of(const ShaderContext& context, Diagnostics& faults);
    std::shared_ptr<const gpu::Program> get(const ShaderContext& context, const ProgramSources& sources,
                                            Diagnostics& faults);
    /// Sources of several passes as one program.
    ProgramSources sources_of(const FusedProgram& passes, Diagnostics& faults) const;
    /// Throws gpu::ShaderError where the driver does not take it.
    std::shared_ptr<const gpu::Program> get(const ProgramSources& sources);
    /// Whether a program is there already, or on disk.
    bool has(const ProgramSources& sources) const;
    /// A full-screen shader of the host's own, glsl/host/<file>, with symbols defined after its first line.
    ProgramSources host_sources(const std::string& file, const std::vector<std::string>& defines) const;
    /// The same of a text.
    ProgramSources full_screen(std::string text, std::string label) const;
    /// Programs made from now on report into a storage block whether llvmpipe ended one of their loops.
    /// [before the first program]
    void guard_loops() { guards_loops_ = true; }
    bool is_guarding_loops() const { return guards_loops_; }
    const std::filesystem::path& glsl_folder() const { return glsl_folder_; }
    const ProgramStore& store() const { return store_; }
    /// Size in the driver's format of a program that get() made or loaded, which shows long programs; 0 if it
    /// is unknown.
    std::size_t binary_bytes(const ProgramSources& sources) const;
    /// Sentences on passes whose shader leaves a target out, since the last call.
    std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
    int compiled_count() const { return compiled_; }  ///< programs made from text
    int loaded_count() const { return loaded_; }      ///< programs taken from the store

private:
    struct Cached {
        std::shared_ptr<const gpu::Program> program;
        std::size_t binary_bytes = 0;
        std::uint64_t last_use = 0;
    };
    struct Kept {
        gpu::Program program;
        std::size_t binary_bytes = 0;  ///< 0: unknown
        bool is_loaded = false;        ///< from the store
    };
    template <typename Make>
    Kept kept(const std::string& key, gpu::Stages stages, const std::string& label,
              const std::shared_ptr<const gpu::Program>& vertex, const Make& make);
    void drop_idle();
    gpu::Program make(const ProgramSources& sources, const std::string& key, std::size_t& binary_bytes);
    std::shared_ptr<const gpu::Program> vertex_stage(const std::string& text);
    std::string key_of(gpu::Stages stages, const std::string& vertex, const std::string& main) const;
    std::string key_of(const ProgramSources& sources) const;

    gpu::Context& context_;
    std::filesystem::path glsl_folder_;
    ProgramStore store_;
    std::string full_screen_;  // the vertex shader of a draw that has none
    std::string over_tiles_;   // and of one over a tile list
    std::map<std::string, std::shared_ptr<const gpu::Program>> vertex_stages_;  // by text; the host has few
    std::map<std::string, Cached> programs_;
    std::uint64_t uses_ = 0;  // of the cache so far
    bool guards_loops_ = false;
    std::vector<std::string> warnings_;
    int compiled_ = 0;
    int loaded_ = 0;
};

}  // namespace aftershade
