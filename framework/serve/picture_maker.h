// Pictures of a look over a capture's frames, made on one GL context: a later call draws only what changed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/base/status.h"
#include "framework/capture/capture.h"
#include "framework/capture/sequence.h"
#include "framework/gpu/context.h"
#include "framework/render/frame_drive.h"
#include "framework/run/frame_loader.h"
#include "framework/serve/frame_objects.h"
#include "framework/serve/look_model.h"
#include "framework/serve/view_picture.h"

namespace aftershade::serve {

struct PictureRequest {
    std::shared_ptr<const BoundText> look;
    int frame = 0;
    int scale = 1;               ///< the picture has 1/scale of the pixels of each side
    std::string view = "final";  ///< a view of view_picture(), or truth:NAME, difference:NAME
    double exposure_ev = 0;
    bool continues = false;  ///< history continues where the frame before this one was drawn last
    bool is_file = false;    ///< the PNG that `run` writes of the final picture at that scale
};

struct MadePicture {
    std::string png;
    std::string times;       ///< JSON, one line
    bool has_fault = false;  ///< the picture is the capture's
};

/// [the context's thread]
class PictureMaker {
public:
    /// Copies the sequence; `status`, which receives the pass at work, must outlive this. Throws
    /// Error(ErrorKind::gl) without a context.
    PictureMaker(Sequence sequence, std::vector<Profile> profiles, ReadLimits limits, const gpu::GlChoice& gl,
                 const std::filesystem::path& data_folder, StatusWriter& status);
    ~PictureMaker();

    const gpu::ContextInfo& gl() const { return context_.info(); }
    /// Throws Error as `run` does.
    MadePicture make(const PictureRequest& request);
    /// As make(). Where the capture lacks what a step takes from it, the view is that of the capture: its
    /// role, else its picture. The times have "fault": {"message", "step"}.
    MadePicture make_or_show_capture(const PictureRequest& request);
    CaptureHeader header_of(int frame) const;
    /// A look's text with the middle of the picture, where it focuses on that, replaced by the nearest place
    /// that shows a surface: the middle may be sky.
    std::string focused_on_surface(const std::string& text, int frame);
    /// Every role's value at a pixel of the whole picture, and the result's; null where the capture lacks
    /// what a step takes from it.
    nlohmann::ordered_json probe(const PictureRequest& request, int x, int y);
    /// The names of what the frame shows, as FrameObjects::list() has them.
    nlohmann::ordered_json objects(int frame);
    /// How many pixels of the final picture have each of 256 values.
    nlohmann::ordered_json histogram(const PictureRequest& request);
    /// How far the colour that the steps make is from a truth beside the frame.
    nlohmann::ordered_json metrics(const PictureRequest& request, const std::string& truth);

private:
    /// The captures of one frame.
    struct Loaded {
        int frame = 0;
        std::string key;
        RunOptions run;
        std::unique_ptr<FrameLoader> loader;
        std::vector<std::shared_ptr<const Capture>> captures;  // the sub-frames
        FrameLoader::Neighbours neighbours;
    };
    /// What is kept for one scale.
    struct Scaled {
        std::unique_ptr<Pipeline> pipeline;
        std::shared_ptr<const BoundText> look;  // owns the manifests that the renderer refers to
        int form = 0;                           // counts changes of the pipeline that ask for another graph
        std::vector<std::string> roles_asked;
        std::unique_ptr<PipelineRenderer> renderer;
        std::unique_ptr<Loaded> loaded;
        bool is_current = false;  // `result` is of what follows
        std::uint64_t revision = 0;
        FrameResult result;
        double total_ms = 0;
    };

    Scaled& draw(const PictureRequest& request);
    void adopt(Scaled& scaled, const PictureRequest& request, Pipeline pipeline);
    std::optional<ShownView> view_without_steps(const PictureRequest& request);
    std::string step_at_fault(const PictureRequest& request);
    bool load(Scaled& scaled, const PictureRequest& request);
    /// What decides which frame's images a step has besides those of the capture.
    enum class Start { same_frame, shot, next_frame };
    FrameResult draw_subframes(Scaled& scaled, const std::vector<std::string>& roles, Start start);
    bool is_next(const Scaled& scaled, int frame) const;
    /// What the steps make of `color`, at full size.
    const Image& made_color(const PictureRequest& request);
    ShownView difference(const PictureRequest& request, const std::string& truth);
    ShownView picture(const Scaled& scaled, const PictureRequest& request) const;
    std::string file_of(const Scaled& scaled) const;
    ShownView shown(const Scaled& scaled, const PictureRequest& request);
    const Capture& whole_capture(int frame);
    const FrameObjects& frame_objects(int frame);
    const Capture& truth(int frame, const std::string& name);

    Sequence sequence_;
    CaptureReader reader_;
    ReadLimits limits_;
    StatusWriter& status_;
    gpu::Context context_;
    std::shared_ptr<ProgramCache> programs_;
    std::map<int, Scaled> scaled_;    // by scale
    std::unique_ptr<Capture> whole_;  // with every role, for probes
    int whole_frame_ = 0;
    std::optional<FrameObjects> objects_;  // of the whole capture
    std::unique_ptr<Capture> truth_;       // the last that was requested
    std::pair<int, std::string> truth_key_;
    int drawn_ = 0;  // steps, by the last draw(); 0 where everything was there
};

}  // namespace aftershade::serve
