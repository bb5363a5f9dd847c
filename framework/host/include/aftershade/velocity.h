// Whether motion vectors mean what the profile declares: what `aftershade inspect --check-velocity` computes.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "aftershade/capture.h"
#include "aftershade/export.h"

namespace aftershade::host {

class Host;

/// How stored vectors are read, in the words of a profile. At first: the conventions of arrays.
struct VelocitySettings {
    std::string delta = "cur-prev";     ///< cur-prev, prev-cur, next-cur, cur-next
    std::string y_axis = "down";        ///< down, up
    std::string unit = "px";            ///< px, uv, ndc
    std::array<double, 2> scale{1, 1};  ///< of x and y
    bool exchange_channels = false;     ///< the two channels are to be named in the other order
};

enum class VelocityVerdict {
    confirmed,  ///< the claim explains the pictures, and every other reading explains clearly less
    undecided,  ///< the claim explains them, but these frames do not tell it from another: see `untold`
    wrong,      ///< another reading explains them: see `suggested`
    no_fit,     ///< no reading by sign, order or factor of 2 does; `suggested` may have free scales
    untestable  ///< nothing moves, or the frame that the claim reads has no vectors
};
/// "confirmed", "undecided", "wrong", "no_fit", "untestable". Never fails.
AFTERSHADE_API const char* velocity_verdict_name(VelocityVerdict verdict) noexcept;

/// The check of one role of motion.
struct VelocityCheck {
    std::string role;  ///< velocity or velocity_next
    VelocityVerdict verdict = VelocityVerdict::untestable;
    std::string sentence;  ///< the verdict, its reason and the remedy
    /// Share of the difference between the frames that the vectors remove, at most 1; negative where they
    /// add: by the claim, and by the best other reading.
    double score = 0, rival_score = 0;
    VelocitySettings settings;        ///< the claim
    VelocitySettings suggested;       ///< `settings` where nothing better is known
    std::vector<std::string> untold;  ///< settings that these frames do not tell
    double longest_px = 0;            ///< the longest vector of both frames
};

/// Warps one of two consecutive frames by its vectors, in each of the ways in which a profile can be wrong,
/// and compares it with the other. The claim is the profile's. Empty where neither frame has motion vectors.
/// Throws as Capture::read; Error(capture) too where a frame has no color, or where the sizes differ.
/// [the host's thread]
AFTERSHADE_API std::vector<VelocityCheck> check_velocity(const Host& host, const std::filesystem::path& frame,
                                                         const std::filesystem::path& next_frame,
                                                         const CaptureOptions& options = {});

/// The same of frames in memory. The claim is the conventions of arrays, into which reading a file has
/// brought its vectors. Throws Error(usage) where an image is a texture. [thread-safe]
AFTERSHADE_API std::vector<VelocityCheck> check_velocity(const Capture& frame, const Capture& next_frame);

}  // namespace aftershade::host
