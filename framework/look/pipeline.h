// A look bound to its effects: what each step reads, and which values were chosen.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/capture/capture.h"
#include "framework/document/document.h"
#include "framework/document/param.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/effect/registry.h"
#include "framework/look/look.h"
#include "framework/look/value_source.h"

namespace aftershade {

namespace gpu {
class Texture;
}  // namespace gpu

/// Where an input takes its image from.
struct InputSource {
    int step = -1;       ///< index of an earlier step; -1: the capture
    std::string output;  ///< that step's output or texture; for the capture, the role
    bool operator==(const InputSource&) const = default;
};

/// One use of an effect. Values are, from the most to the least binding: set by the caller, look, preset;
/// below them come the capture and the manifest.
struct PipelineStep {
    std::string name;
    const EffectManifest* manifest = nullptr;
    std::map<std::string, InputSource> inputs;   ///< by input name
    std::map<std::string, ValueSource> values;   ///< asked for by the user; paths of files are complete
    std::map<std::string, std::string> origins;  ///< of each of `values`: "the look", "preset fast"
    std::map<std::string, Place> places;         ///< of each of `values`
    ValueSource mix = ParamValue(1.0);
    std::optional<MaskSpec> mask;
    /// By output: the image of that role before the step, which `mix` and `mask` let through. Empty where the
    /// step has neither; a source without a name where no step has made an image of that role, and no capture
    /// can.
    std::map<std::string, InputSource> before;
    bool is_foreign = false;  ///< the effect is not one of the shipped ones

    /// Whether the input's conditions may hold: with values that differ from frame to frame they may.
    bool may_take(const InputSpec& input) const;
    /// The last step whose color it takes, which the look may wire past others; -1: the capture's.
    int step_of_color() const;
    /// Every value that the parameter may have in any frame, except those that only the capture holds: the
    /// user's value (all of its keys), else the manifest's. Paths of files are complete.
    std::vector<ParamValue> known_values(const ParamSpec& spec) const;
};

/// "bokeh.coc": an intermediate to be written out.
struct Tap {
    std::string step;
    std::string texture;
    std::string text() const { return step + "." + texture; }
    bool operator==(const Tap&) const = default;
};

struct Pipeline {
    std::vector<PipelineStep> steps;
    std::vector<Tap> taps;

    /// Roles that some step takes from the capture, required or not, and `color` for the outputs.
    std::vector<RoleId> capture_roles() const;
    /// Objects that parameters of steps name, for which object_id must hold the hashes of names; masks
    /// and values from pixels take their coverage instead.
    std::vector<std::string> object_names() const;
    /// Roles that some input takes from the capture `offset` frames after, or before where it is negative.
    std::vector<RoleId> neighbour_roles(int offset) const;
    /// Offsets of the captures that some input takes, without 0.
    std::set<int> neighbour_offsets() const;
    bool writes_role(const std::string& role) const;
    bool has_history() const;
    /// Whether some effect is not one of the shipped ones.
    bool has_foreign() const;
    /// The last step whose effect accumulates sub-frames; -1: none does.
    int last_accumulating_step() const;
    /// Whether graphs of this pipeline are graphs of the other: where only values differ, a graph's key has
    /// those that decide over it (framework/render/graph_key.h).
    bool has_form_of(const Pipeline& other) const;
};

/// The captures of one frame. [refers to what the caller keeps]
struct FrameInputs {
    const Capture* capture = nullptr;
    std::map<int, const Capture*> neighbours{};  ///< by offset: of the same shot, where some input wants them
    bool begins_shot = false;                    ///< a cut: nothing before it counts
    int subframe = 0;
    int subframe_count = 1;
    const Capture* centre = nullptr;  ///< of several sub-frames: the one at the middle of the exposure
    double scale = 1;  ///< of the capture's pixels relative to those that values in px refer to
    double fps = 24;
    /// Fills the texture of a capture's image that is not in memory; false where it is. Empty: each is.
    std::function<bool(const RoleId& role, int offset, gpu::Texture& texture)> fill{};

    const Capture* at(int offset) const;
    /// Whether there is a capture at that offset, with an image of that role.
    bool has_image(const RoleId& role, int offset) const {
        const Capture* const from = at(offset);
        return from && from->images.contains(role);
    }
};

/// A value of a program's, above the look's own. Messages say value.place.
struct ValueOverride {
    std::string name;  ///< "bokeh.f_number"
    Node value;
};

/// One step.param=value or step.texture, as given.
struct PipelineOptions {
    std::vector<std::string> sets;
    std::vector<std::string> taps;
    std::vector<ValueOverride> overrides{};
};

/// Binds a look. Each input takes its role from the nearest earlier step that outputs it, else from the
/// capture (from the capture alone where the manifest has "from": "capture"), unless the step's "in" says
/// otherwise. Faults go to `diagnostics`, all of them; the result is
/// usable if there was none.
Pipeline bind_pipeline(const Look& look, EffectRegistry& effects, const PipelineOptions& options,
                       Diagnostics& diagnostics);

/// The value with the path of a file, where it is one, named from `folder`; "" stays "".
ParamValue with_file(const ParamSpec& spec, ParamValue value, const std::filesystem::path& folder);

/// The parameter that every step has from the host: "mix", 0 to 1.
const ParamSpec& mix_spec();

/// A role that the pipeline requires and a capture lacks.
struct MissingRole {
    std::string who;  ///< "step 'bokeh' (effect bokeh)"
    std::string role;
    std::string instead{};  ///< another that would do
};
/// "step 'blur' (effect blur) needs the role 'velocity' or 'position'"
std::string need_of(const MissingRole& missing);

/// Each role once, for the first that requires it.
std::vector<MissingRole> find_missing_roles(const Pipeline& pipeline, const CaptureHeader& header);

/// Of one role or more, with the remedies; `reader` may be null.
Error missing_roles(const std::vector<MissingRole>& missing, const CaptureHeader& header,
                    const CaptureReader* reader);

/// A step that reads the color of layers behind the picture, and earlier steps that change the picture's
/// color, which changes no layer.
struct StaleLayers {
    std::string step;
    std::vector<std::string> changed_by;
};
std::vector<StaleLayers> find_stale_layers(const Pipeline& pipeline);

/// Throws Error(ErrorKind::capture) if the capture lacks roles that steps require, naming for each the effect
/// and what would give the role: the producer's settings, other profiles and layers, found by the reader that
/// the header comes from, where it is given. It also lists the channels that the file does have.
void require_capture_roles(const Pipeline& pipeline, const CaptureHeader& header,
                           const CaptureReader* reader = nullptr);

/// A parameter of a step for one frame, in the declared unit, and where it is from: "the look, by keys".
struct ResolvedValue {
    ParamValue value;
    std::string origin;
};
/// As resolve_params(), of one parameter, at full scale.
ResolvedValue resolve_param(const PipelineStep& step, const ParamSpec& spec, const FrameInputs& frame);

/// Every parameter of the step: the user's value, else the capture's (the manifest's "from"), else the
/// default; values in px times frame.scale. Throws Error(ErrorKind::capture) where the capture's values do
/// not fit.
ParamSet resolve_params(const PipelineStep& step, const FrameInputs& frame);

/// One line per parameter of every step: its value, its unit, and where the value is from.
std::string explain_params(const Pipeline& pipeline, const FrameInputs& frame);

}  // namespace aftershade
