// The key of a frame graph: every fact about a frame that its build read.
#pragma once

#include <compare>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "framework/effect/param_reader.h"
#include "framework/gpu/texture.h"
#include "framework/image/square_pixels.h"
#include "framework/look/pipeline.h"
#include "framework/render/native_steps.h"

namespace aftershade {

/// One frame, for which a graph is built or used again. [refers to what the caller keeps]
struct GraphFrame {
    const Pipeline& pipeline;
    const FrameInputs& inputs;
    const std::vector<ParamSet>& params;    ///< by step
    const NativeSteps& natives;             ///< prepared for this frame
    const std::vector<std::string>& roles;  ///< to be read back
};

/// One thing that a build may read of a frame; what a pipeline says without a frame needs no question.
struct GraphQuestion {
    enum class About {
        width_px,
        height_px,
        square_pixels,   ///< of the steps that work on them: axis, to, from, phase, width, height
        display_window,  ///< `of` the capture, 0, or of square pixels, 1: x and y in the data window, width,
                         ///< height
        image,           ///< whether the capture `of` frames after has the role `name`
        wanted_role,     ///< whether the role `name` is to be read back
        param,           ///< the `aspect` of the parameter `name` of step `of`
        native_enabled,  ///< whether step `of` runs the pass `name`
        native_turns,    ///< of the pass `name`; -1: as the manifest says
        native_table     ///< width and height of the table `name`
    };
    About about;
    int of = 0;
    std::string name;
    ParamAspect aspect = ParamAspect::value;
    auto operator<=>(const GraphQuestion&) const = default;
};

/// Two frames that answer each question alike have graphs of one form.
class GraphKey {
public:
    using Answers = std::map<GraphQuestion, ParamValue>;

    GraphKey() = default;
    explicit GraphKey(const Answers& answers) : answers_(answers.begin(), answers.end()) {}

    /// Whether the graph can be used for `frame`, of the pipeline that it was built for.
    bool holds(const GraphFrame& frame) const;
    bool asked(const GraphQuestion& question) const;

private:
    std::vector<std::pair<GraphQuestion, ParamValue>> answers_;
};

/// The only way in which a build sees a frame: what it reads becomes the graph's key.
class GraphFrameReader {
public:
    explicit GraphFrameReader(const GraphFrame& frame) : frame_(frame) {}
    GraphFrameReader(const GraphFrameReader&) = delete;
    GraphFrameReader& operator=(const GraphFrameReader&) = delete;

    const Pipeline& pipeline() const { return frame_.pipeline; }
    int width_px();
    int height_px();
    /// The grid of the steps that work on square pixels, and how it begins.
    struct SquareGrid {
        PixelStretch stretch;  ///< none where no step does
        int phase = 0;         ///< of the data window's first pixel
        int width_px = 0;
        int height_px = 0;
    };
    SquareGrid square_pixels();
    /// Where the display window begins in the data window, and its size, in px of the steps' grid.
    struct DisplayWindow {
        int x = 0, y = 0;
        int width_px = 0, height_px = 0;
    };
    DisplayWindow display_window(bool is_square);
    /// `offset`: of which capture, in frames.
    bool has_image(const RoleId& role, int offset);
    bool wants(const std::string& role);
    /// Refers to this reader.
    ParamReader params(int step);
    /// Whether native code enables the pass of its step.
    bool native_enabled(int step, const std::string& pass);
    /// `otherwise` where the code says nothing of it.
    int native_turns(int step, const std::string& pass, int otherwise);
    gpu::TextureDesc native_table(int step, const NativeTableSpec& table);

    GraphKey key() const { return GraphKey(answers_); }

private:
    const ParamValue& ask(const GraphQuestion& question);

    GraphFrame frame_;
    GraphKey::Answers answers_;
};

}  // namespace aftershade
