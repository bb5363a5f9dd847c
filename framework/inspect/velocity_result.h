// The check of a capture's motion vectors: the profile's claim, its rivals, the verdict.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aftershade {

/// The settings of a profile's velocity role, in the profile's words.
struct VelocitySettings {
    std::string delta = "cur-prev";  ///< cur-prev, prev-cur, next-cur, cur-next; the claim is that it holds
    std::string y_axis = "down";     ///< down, up
    std::string unit = "px";         ///< px, uv, ndc
    std::array<double, 2> scale = {1, 1};
    double bias = 0;                 ///< the stored value of no motion
    double shutter_frames = 1;       ///< frames that a vector spans
    bool exchange_channels = false;  ///< the two channels are to be named in the other order

    /// The vectors go from a frame to the next one: the role is velocity_next.
    bool is_next() const { return delta.starts_with("next") || delta.ends_with("next"); }
    bool operator==(const VelocitySettings&) const = default;
};

/// The change of the decoded vectors that makes them explain the pictures; the default is the profile's
/// claim.
struct VelocityHypothesis {
    /// velocity is in truth next - cur and read in A; velocity_next is cur - prev and read in B.
    bool other_time = false;
    bool swapped = false;  ///< x and y exchanged first ...
    double scale_x = 1;    ///< ... then multiplied, negative where the sign is wrong
    double scale_y = 1;
    bool operator==(const VelocityHypothesis&) const = default;
};

struct VelocityScore {
    VelocityHypothesis hypothesis;
    double score = 0;  ///< share of the error of "nothing moves" that it removes; negative adds; 0 untested
    bool tested = false;  ///< the frame that it reads has vectors of at least a pixel
};

/// The best scale per axis where it need not be a listed one.
struct VelocityFit {
    bool other_time = false;
    bool swapped = false;
    std::optional<double> scale_x;  ///< negative where the sign is wrong; nullopt: no motion shows it
    std::optional<double> scale_y;
    double score = 0;
};

/// The claim with another bias or unit, which the stored values hint at.
struct VelocityReading {
    VelocitySettings settings;  ///< the best under that bias and unit
    double score = 0;
};

enum class VelocityVerdict {
    confirmed,  ///< the claim explains the pictures, every rival clearly less; no other scale is better
    undecided,  ///< the claim explains them, but these frames do not tell it from another: see `untold`
    wrong,      ///< another listed hypothesis explains them: see `suggested`
    no_fit,     ///< no listed one does; perhaps the free scale
    untestable  ///< nothing moves, or the frame that the claim reads has no vectors
};

struct VelocityCheck {
    VelocityVerdict verdict = VelocityVerdict::untestable;
    std::vector<VelocityScore> hypotheses;  ///< the 48 listed, best first
    VelocityScore best;
    VelocityScore identity;                  ///< the claim
    VelocityScore rival;                     ///< the best of all others
    std::optional<VelocityFit> fit;          ///< where anything was tested
    std::optional<VelocityReading> reading;  ///< where it refutes the claim, or these frames do not decide
    std::string at_limit;  ///< "1298 pixels ... are stored as 1, ..."; "" where no values pile up at a limit
    VelocitySettings settings;   ///< as given
    VelocitySettings suggested;  ///< `settings` where nothing better is known
    /// Settings that these frames leave undecided, in the profile's words: "delta" (its sign), "delta
    /// (cur-prev or next-cur)", "y_axis", "order of channels", "scale", "bias".
    std::vector<std::string> untold;
    int moving_px_a = 0;  ///< pixels with vectors of at least one pixel
    int moving_px_b = 0;
    double longest_px = 0;  ///< vector of both frames
    std::string sentence;   ///< the verdict, its reason and the remedy

    bool confirmed() const { return verdict == VelocityVerdict::confirmed; }
};

}  // namespace aftershade
