// A picture for people out of the image of any role. Shaders make the same colours: glsl/false_color.glsl.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/image/color_space.h"
#include "framework/image/image.h"
#include "framework/image/label_text.h"
#include "framework/image/role.h"
#include "glsl/false_color_tables.glsl"

namespace aftershade {

/// Faults of a pixel; a later one takes precedence over an earlier one.
enum class PixelFault { none, negative, infinite, nan };
inline constexpr std::array kPixelFaults = {PixelFault::negative, PixelFault::infinite, PixelFault::nan};
std::string_view pixel_fault_name(PixelFault fault);
DisplayColor pixel_fault_color(PixelFault fault);

/// Depth where nothing was hit: a grey, which the ramp has not.
inline constexpr DisplayColor kNothingHitColor = {FALSE_COLOR_NOTHING_HIT};

/// viridis, from dark to bright, t in 0..1.
DisplayColor ramp_color(float t);
/// Direction (+x right, +y down) as hue, length 0..1 from black to the full colour; longer vectors turn
/// paler.
DisplayColor wheel_color(float x, float y);
/// Signed values t in -1..1: blue below 0, white at 0, red above.
DisplayColor diverging_color(float t);
/// Neighbouring ids get hues far apart: multiples of the golden ratio (Knuth, TAOCP 3, 6.4). 0 is black.
DisplayColor id_color(std::uint32_t id);

/// The drawing in the legend, in addition to its words.
enum class Legend { none, ramp, wheel };

/// The word for an image without a role, such as an effect's texture: one channel is shown as
/// diverging_color where any value is below 0, else as ramp_color from 0 to the largest; two as vectors;
/// three and four as light.
inline constexpr std::string_view kDataRole = "data";

/// Shows one role's image. Negative values are faults only where the role's contract forbids them.
/// [thread-safe; `image` must outlive it]
class FalseColor {
public:
    /// `primaries` of the stored colours; all zero: Rec. 709.
    FalseColor(const std::string& role, const Image& image, const Chromaticities& primaries);

    DisplayColor color(int x, int y) const;
    PixelFault fault(int x, int y) const;
    std::uint64_t fault_count(PixelFault fault) const { return fault_counts_[std::size_t(fault)]; }
    /// Two lines: range and unit, and how they are shown.
    const std::array<std::string, 2>& label() const { return label_; }
    Legend legend() const;
    bool is_blendable() const {
        return kind_ != Kind::ids;
    }  ///< false: the mean of two colours would be a third id

private:
    FalseColor(const std::string& role, const std::optional<ChannelRole>& contract, const Image& image,
               const Chromaticities& primaries);
    enum class Kind { color, depth, velocity, normal, position, ids, grey, signed_data, data };
    static Kind kind_of(const std::string& role, RoleKind role_kind, const Image& image);
    void count_faults();
    void fit_color(bool is_share, const Chromaticities& primaries);
    void fit_depth();
    void fit_velocity();
    void fit_ids();
    void fit_position();
    void fit_grey();
    void fit_data();
    DisplayColor exposed(const float* pixel) const;
    DisplayColor scaled(const float* pixel) const;
    const float* pixel(int x, int y) const;
    float luminance(const float* pixel) const;

    const Image& image_;
    Kind kind_;
    bool may_be_negative_;
    bool may_be_infinite_;
    ColorMatrix to_rec709_ = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    float exposure_ = 1;                    // color: factor
    std::array<float, 3> low_ = {0, 0, 0};  // of the range shown; depth: ln m
    std::array<float, 3> high_ = {1, 1, 1};
    float longest_px_ = 1;  // velocity: at the rim of the wheel
    std::array<std::uint64_t, 4> fault_counts_{};
    std::array<std::string, 2> label_;
};

}  // namespace aftershade
