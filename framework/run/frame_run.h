// One frame of a run, from its first sub-frame to its results.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "framework/render/frame_drive.h"
#include "framework/run/frame_loader.h"
#include "framework/run/nan_policy.h"
#include "framework/run/run_report.h"

namespace aftershade {

/// Refers to what its caller keeps. [one thread]
class FrameRun {
public:
    FrameRun(PipelineRenderer& renderer, FrameLoader& loader, const Sequence& sequence, const RunOptions& run)
        : renderer_(renderer), loader_(loader), sequence_(sequence), run_(run) {}

    struct Rendered {
        std::shared_ptr<const Capture> capture;
        std::shared_ptr<const FrameResult> result;
        std::vector<NonFiniteOutput> non_finite;
        std::vector<std::string>
            differences;      ///< from the first frame, of all sub-frames, each with its path
        std::string message;  ///< warnings and differences, for reports
    };

    /// While the frame is read: builds its graph by what its header says, if that is enough. Faults are left
    /// to render(), which meets them in their order.
    void build_ahead(std::size_t index, const std::vector<std::string>& roles);
    /// A frame whose passes were issued.
    struct Begun {
        BegunFrame frame;
        std::vector<std::string> differences;
        std::string message;
    };
    /// The same as render() in two parts, between which the next frame may begin where transfers are mapped.
    Begun begin(std::size_t index, const std::vector<std::string>& roles, RunReport& report,
                const RunObserver& observer);
    Rendered finish(Begun begun) const;
    /// Reading's faults come as Error(ErrorKind::capture), and so do pixels that NanPolicy::fail refuses.
    Rendered render(std::size_t index, const std::vector<std::string>& roles, RunReport& report,
                    const RunObserver& observer) {
        return finish(begin(index, roles, report, observer));
    }

private:
    FrameSetting setting_of(std::size_t index) const;
    void meet_non_finite(const Capture& capture, RunReport& report, const RunObserver& observer) const;
    Rendered finished(std::shared_ptr<const Capture> capture, FrameResult result) const;

    PipelineRenderer& renderer_;
    FrameLoader& loader_;
    const Sequence& sequence_;
    const RunOptions& run_;
};

/// The window that a run writes of a frame whose display window at full scale is `display`: all of it or the
/// region, at the run's scale.
Window written_window(const Window& display, const RunOptions& run);

/// Adds a frame with NaN or infinite pixels to the report, once.
void note_non_finite(int frame, RunReport& report);

}  // namespace aftershade
