#include "framework/image/decode.h"

#include <cmath>
#include <limits>
#include <span>

#include "framework/core/error.h"

namespace aftershade {

namespace {

constexpr float kNothingHit = std::numeric_limits<float>::infinity();

struct DepthRange {
    double near_m = 0;
    double far_m = 0;
};

DepthRange depth_range(const RoleDecoding& decoding, const DecodeContext& context) {
    const auto near_m = decoding.near_m ? decoding.near_m : context.camera.get("near");
    const auto far_m = decoding.far_m ? decoding.far_m : context.camera.get("far");
    if (!near_m || !far_m || !(*near_m < *far_m))
        throw Error(ExitCode::capture, context.file + ": this depth needs the camera's near and far, with near < far (give "
                                                      "'near' and 'far' in capture.json's camera)");
    return {*near_m, *far_m};
}

/// Metres for a stored z-buffer or normalised value. Values at or beyond the far plane are nothing hit.
float ranged_depth(float stored, const RoleDecoding& decoding, const DepthRange& range) {
    const double t = decoding.reversed ? 1 - double(stored) : double(stored);
    if (!(t < 1)) return kNothingHit;
    if (decoding.encoding == DepthEncoding::normalized) return float(range.near_m + t * (range.far_m - range.near_m));
    return float(range.near_m * range.far_m / (range.far_m - t * (range.far_m - range.near_m)));
}

/// The cosine between each pixel's ray and the view axis turns distance along the ray into distance along the axis.
void planar_from_radial(Image& depth, const DecodeContext& context) {
    const auto focal_length_mm = context.camera.get("focal_length"), sensor_width_mm = context.camera.get("sensor_width");
    if (!focal_length_mm || !sensor_width_mm)
        throw Error(ExitCode::capture, context.file + ": this depth is radial and needs the camera's focal_length and "
                                                      "sensor_width (give them in capture.json's camera)");
    const double focal_px = *focal_length_mm / *sensor_width_mm * context.display.width();
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x) {
            const double dx = x + context.grid.min_x - context.display.min_x + 0.5 - 0.5 * context.display.width();
            const double dy = y + context.grid.min_y - context.display.min_y + 0.5 - 0.5 * context.display.height();
            depth.at(x, y, 0) *= float(focal_px / std::sqrt(focal_px * focal_px + dx * dx + dy * dy));
        }
}

}  // namespace

void decode_depth(Image& depth, const RoleDecoding& decoding, const DecodeContext& context) {
    const bool ranged =
        decoding.encoding == DepthEncoding::z_buffer || decoding.encoding == DepthEncoding::normalized;
    const DepthRange range = ranged ? depth_range(decoding, context) : DepthRange{};
    for (float& z : depth.floats()) {
        // Written so that NaN is nothing hit too: effects never see one.
        const bool nothing_hit = !(z < decoding.no_hit) || (decoding.zero_is_no_hit && z == 0);
        if (nothing_hit) z = kNothingHit;
        else if (ranged) z = ranged_depth(z, decoding, range) * decoding.scale;
        else if (decoding.encoding == DepthEncoding::inverse) z = z == 0 ? kNothingHit : decoding.scale / z;
        else z *= decoding.scale;
    }
    if (decoding.radial) planar_from_radial(depth, context);
}

std::vector<std::size_t> decode_velocity(Image& velocity, const RoleDecoding& decoding, const DecodeContext& context) {
    const bool reversed =
        decoding.delta == VelocityDelta::prev_minus_cur || decoding.delta == VelocityDelta::cur_minus_next;
    const double side_part = decoding.unit == VelocityUnit::px ? 0 : decoding.unit == VelocityUnit::uv ? 1 : 0.5;
    const double unit_x = side_part == 0 ? 1 : side_part * context.display.width();
    const double unit_y = side_part == 0 ? 1 : side_part * context.display.height();
    const double per_frame = 1 / decoding.shutter_frames * (reversed ? -1 : 1);
    const float factor_x = float(unit_x * decoding.velocity_scale[0] * per_frame);
    const float factor_y = float(unit_y * decoding.velocity_scale[1] * per_frame * (decoding.y_axis_up ? -1 : 1));

    std::vector<std::size_t> without_motion;
    const std::span<float> values = velocity.floats();
    for (std::size_t pixel = 0; 2 * pixel + 1 < values.size(); ++pixel) {
        float& x = values[2 * pixel];
        float& y = values[2 * pixel + 1];
        const bool marked = decoding.no_motion_above && x > *decoding.no_motion_above;
        if (marked || !std::isfinite(x) || !std::isfinite(y)) {
            x = y = 0;
            without_motion.push_back(pixel);
            continue;
        }
        const float alpha = decoding.premultiplied && context.color ? context.color->floats()[4 * pixel + 3] : 1;
        const float coverage = alpha > 0 ? 1 / alpha : 1;
        x = (x * coverage - decoding.bias) * factor_x;
        y = (y * coverage - decoding.bias) * factor_y;
    }
    return without_motion;
}

Image decode_ids(const Image& stored, const std::string& file) {
    constexpr float kLargest = 4294967040.0f;  // the last float below 2^32
    Image ids(stored.width(), stored.height(), 1, ComponentType::uint32);
    const std::span<const float> values = stored.floats();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float id = values[i];
        if (!(id >= 0 && id <= kLargest) || id != std::floor(id)) {
            const std::size_t width = std::size_t(stored.width());
            throw Error(ExitCode::capture, file + ": object id " + std::to_string(id) + " at pixel (" +
                                               std::to_string(i % width) + ", " + std::to_string(i / width) +
                                               ") is not a whole number from 0 to 4294967040");
        }
        ids.uints()[i] = std::uint32_t(id);
    }
    return ids;
}

}  // namespace aftershade
