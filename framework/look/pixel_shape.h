// Steps whose shapes are round, over frames whose pixels are not square: they work on square pixels.
#pragma once

#include <string>
#include <vector>

#include "framework/image/square_pixels.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// The grid that a step works on. Of a step in the display window, that is the data window, too.
struct StepGrid {
    Window data_window;
    Window display_window;
    PixelStretch stretch;  ///< of the capture's pixels, which gave these windows
};

/// From the first step to the last that measures both axes by one length in pixels (blurs by a radius,
/// lenses, scattering, vignettes, grain), all work on square pixels; those before and after work on the
/// capture's.
class SquareSteps {
public:
    SquareSteps(const Pipeline& pipeline, const PixelStretch& stretch);
    SquareSteps(const Pipeline& pipeline, float pixel_aspect)
        : SquareSteps(pipeline, square_pixels(pixel_aspect)) {}

    const PixelStretch& stretch() const { return stretch_; }  ///< none where no step needs it
    bool contains(int step) const { return !stretch_.is_none() && step >= first_ && step <= last_; }
    StepGrid grid_of(int step, const CaptureHeader& header) const;
    /// Whether the step works on the display window; the capture, step -1, does not.
    bool is_in_display_window(int step) const { return step >= 0 && in_display_window_[std::size_t(step)]; }
    /// "steps 'dof' to 'bloom' work on 400 x 100 square pixels (the capture's pixel aspect is 2)"; "" where
    /// there is no stretch.
    std::string note(const Pipeline& pipeline, const CaptureHeader& header) const;

private:
    PixelStretch stretch_;
    std::vector<bool> in_display_window_;  // by step
    int first_ = 0, last_ = -1;
};

}  // namespace aftershade
