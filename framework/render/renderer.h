// Runs a pipeline over captures on one GL context.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/effect/pass_program.h"
#include "framework/gpu/buffer.h"
#include "framework/gpu/texture.h"
#include "framework/gpu/timer.h"
#include "framework/graph/executor.h"
#include "framework/image/color_encoding.h"
#include "framework/image/image.h"
#include "framework/look/pipeline.h"
#include "framework/render/audit.h"
#include "framework/render/native_steps.h"
#include "framework/render/renderer_options.h"
#include "framework/render/step_files.h"
#include "framework/render/telemetry.h"

namespace aftershade {

struct FrameResult {
    std::map<std::string, Image> images;      ///< by role: what the steps made of the roles asked for
    std::set<std::string> finite_roles;       ///< of images that were seen to hold no NaN and no infinity
    std::map<std::string, Image> taps;        ///< by "step.texture"
    std::vector<graph::PassTime> times;       ///< upload, each pass, readback; empty unless timed
    std::vector<AuditFinding> audit;          ///< in the order of the passes; empty unless audited
    std::optional<Window> region;             ///< the part of the display window that was requested
    std::vector<std::string> messages;        ///< what native code logged
    std::optional<FrameTelemetry> telemetry;  ///< where it was requested
    ColorEncoding display_encoding = kSrgbDisplay;  ///< of the image `display`; its curve may be unknown
    /// The encoding of the image `color`, if it is not light in the capture's primaries.
    std::optional<ColorEncoding> color_encoding;
    std::string history_reset;  ///< why history restarted: "a cut"; "" where it continued or is none
};

/// Made by PipelineRenderer::begin(). [the context's thread, within the renderer's life]
class PendingFrame {
public:
    /// The texels of a role or a tap.
    struct Read {
        std::string name;
        bool is_tap = false;
        Image image;  ///< where they will be
        gpu::TexelRead texels;
    };

    explicit PendingFrame(gpu::Context& context) : context_(context) {}
    PendingFrame(PendingFrame&&) noexcept = default;

    /// What was known when the passes had been issued: all but images, taps and times.
    FrameResult result;
    std::vector<Read> reads;
    bool is_timed = false;
    bool is_partial = false;  ///< of a sub-frame before the last: nothing is read
    std::vector<gpu::Duration> uploads;
    std::vector<graph::PendingTime> passes;
    std::optional<gpu::Duration> readback;  ///< of reads that were issued; nullopt: finish() does it all

    /// Waits for the passes and the texels. Once.
    FrameResult finish();

private:
    gpu::Context& context_;
};

/// A frame graph for one size and one choice of passes (framework/render/built_graph.h).
struct BuiltGraph;
struct FrameBefore;
struct GraphFeed;
struct SavedHistory;

/// Builds the frame graph on the first frame and again only when something changes that the build looked at:
/// the size, the presence of an image, a value that chooses passes, sizes or programs.
/// [the context's thread]
class PipelineRenderer {
public:
    PipelineRenderer(gpu::Context& context, const Pipeline& pipeline,
                     const std::filesystem::path& data_folder, NativeSources natives = {},
                     const RendererOptions& options = {});
    /// The same with programs that several renderers of one context share.
    PipelineRenderer(gpu::Context& context, const Pipeline& pipeline, std::shared_ptr<ProgramCache> programs,
                     NativeSources natives = {}, const RendererOptions& options = {});
    ~PipelineRenderer();

    /// Builds the first frame's graph and has the driver make its programs, before the frame's pixels are
    /// known: images of `frame` are empty. If render() finds differences, it builds the graph again. Failures
    /// here occur there again. Does nothing unless can_build_ahead(). Throws Error(ErrorKind::memory).
    void build_ahead(const FrameInputs& frame, const std::vector<std::string>& roles);
    /// Whether there is no graph yet, and no step needs more than a frame's header: native code is called
    /// once a frame, and values may be measured in the pixels.
    bool can_build_ahead() const;
    /// Renders one frame; of sub-frames, give each in turn. Steps up to the last one that accumulates run for
    /// each sub-frame; the others run once, with the last, over `frame.centre`. `roles` are read back where a
    /// step makes them; of sub-frames before the last the result is empty. Frames follow each other in
    /// `frame.capture->header.frame`; anything else restarts history. Throws Error(ErrorKind::effect).
    FrameResult render(const FrameInputs& frame, const std::vector<std::string>& roles, bool timed);
    /// The same as far as it needs no waiting: the frame's passes are issued, and its results are on their
    /// way when PendingFrame::finish() is called. Where transfers are mapped (gpu::ContextInfo), the next
    /// frame may begin before. Elsewhere finish() comes first.
    PendingFrame begin(const FrameInputs& frame, const std::vector<std::string>& roles, bool timed);
    /// The last call's frame once more, of which nothing changed but what the pipeline's values give: steps
    /// before the first that differs are not drawn again, if they are kept and no step has a history. The
    /// captures must be the same objects with the same pixels.
    FrameResult render_again(const FrameInputs& frame, const std::vector<std::string>& roles, bool timed);
    /// How many programs of the last graph the threads of RendererOptions compiled.
    int programs_compiled_ahead() const;
    /// How many of the pipeline's steps the last frame drew.
    int steps_drawn() const { return steps_drawn_; }
    /// From the next frame on, which builds another graph if that changes.
    void set_telemetry(bool telemetry) {
        is_stale_ |= std::exchange(options_.telemetry, telemetry) != telemetry;
    }

    /// Results of these roles are not read back: result_texture() has them, FrameResult::images has not.
    void keep_on_gpu(std::vector<std::string> roles) { kept_on_gpu_ = std::move(roles); }
    /// Results of these roles are rounded to halfs by whoever takes them, and may come so (gpu::ReadAs).
    void read_as_halfs(std::vector<std::string> roles) { read_as_halfs_ = std::move(roles); }
    /// The last frame's image of a requested role; nullptr if no step makes it. Valid until the next frame.
    const gpu::Texture* result_texture(const std::string& role) const;
    /// Call after a change of the pipeline that the renderer refers to, unless only values changed that
    /// decide over no input, mix or mask. History lives on where it fits.
    void pipeline_changed() { is_stale_ = true; }

    /// The history that the next frame would read (framework/render/history_file.h). Throws
    /// Error(ErrorKind::output).
    void save_history(const std::filesystem::path& path, const std::string& fingerprint = "");
    /// Takes up where a run over the frames before this one ended. Throws Error(ErrorKind::usage) where the
    /// file is damaged or of another look, effect version, size or last frame: at once, or by render().
    void load_history(const std::filesystem::path& path);
    /// Drops a history that was loaded for a frame that could not be read.
    void drop_loaded_history();

    /// The graph of the last frame in Graphviz's language; "" before the first.
    std::string graph_dot() const;
    /// The draws of the last frame's graph, in its order.
    std::vector<DrawnPass> draws() const;
    /// How often the graph was built.
    int graphs_built() const { return graphs_built_; }
    /// Bytes of all textures and buffers of the last frame, and their bytes without shared memory.
    std::pair<std::uint64_t, std::uint64_t> graph_bytes() const;

private:
    struct Last {
        int frame = 0;
        Window window;
        Camera camera;
        float pixel_aspect = 1;
    };
    void resolve(const FrameInputs& frame);
    int first_changed_step(const std::vector<ParamSet>& before, const std::vector<std::string>& mixes) const;
    std::vector<std::string> mixes() const;
    void prepare(const FrameInputs& frame, const std::vector<std::string>& roles);
    void build(const FrameInputs& frame, const std::vector<std::string>& roles, bool primes);
    std::string history_fault(const FrameInputs& frame) const;
    void feed(const GraphFeed& feed, PendingFrame& pending);
    void set_hooks();
    void require_whole_loops(const std::string& pass);
    void issue_passes(graph::PassRange range, PendingFrame& pending);
    FrameTelemetry read_telemetry(int frame) const;
    void begin_reads(const std::vector<std::string>& roles, PendingFrame& pending);
    /// Sets the encodings of `display` and `color` by the last steps that made them of other images, with the
    /// transforms that the steps' files hold now.
    void set_encodings(FrameResult& result) const;
    void begin_from_saved(const FrameInputs& frame);
    void restore(const SavedHistory& saved);

    gpu::Context& context_;
    const Pipeline& pipeline_;
    std::shared_ptr<ProgramCache> programs_;
    StatusWriter* status_ = nullptr;
    std::optional<gpu::Buffer> loop_guard_;  // before the graph, whose passes it is bound to
    StepFiles files_;
    NativeSteps natives_;
    std::vector<ParamSet> params_;
    std::unique_ptr<BuiltGraph> built_;
    int graphs_built_ = 0;
    std::optional<Last> last_;             // capture, sub-frames too
    bool is_partial_ = false;              // of the last frame not all sub-frames came
    std::optional<Camera> camera_before_;  // of the last whole frame
    float aspect_ = 1;                     // of the pixels of the frame before
    std::string frame_fault_;              // why this frame restarted history
    std::unique_ptr<SavedHistory> saved_;  // loaded and not yet taken up
    RendererOptions options_;
    std::vector<std::string> kept_on_gpu_, read_as_halfs_;
    bool is_stale_ = false;
    int steps_drawn_ = 0;
    std::vector<std::string> mixes_drawn_;  // by step, as a document would write them
};

}  // namespace aftershade
