#include "framework/capture/decode.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "framework/base/error.h"
#include "framework/base/parallel.h"
#include "framework/capture/capture_grammar.h"
#include "framework/image/image.h"
#include "framework/image/role.h"

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
        throw Error(ErrorKind::capture,
                    context.file +
                        ": this depth needs the camera's near and far, with near < far (give "
                        "'near' and 'far' in capture.json's camera)");
    return {*near_m, *far_m};
}

/// Metres for a stored z-buffer or normalised value. Values at or beyond the far plane are nothing hit.
float ranged_depth(float stored, const RoleDecoding& decoding, const DepthRange& range) {
    const double t = decoding.reversed ? 1 - double(stored) : double(stored);
    if (!(t < 1)) return kNothingHit;
    if (decoding.encoding == DepthEncoding::normalized)
        return float(range.near_m + t * (range.far_m - range.near_m));
    return float(range.near_m * range.far_m / (range.far_m - t * (range.far_m - range.near_m)));
}

/// The inverse of ranged_depth.
float ranged_value(float depth_m, const RoleDecoding& decoding, const DepthRange& range) {
    double t = 1;
    if (std::isfinite(depth_m)) {
        const double span_m = range.far_m - range.near_m;
        const bool normalized = decoding.encoding == DepthEncoding::normalized;
        t = normalized ? (depth_m - range.near_m) / span_m
                       : (range.far_m - range.near_m * range.far_m / double(depth_m)) / span_m;
    }
    return float(decoding.reversed ? 1 - t : t);
}

bool is_ranged(const RoleDecoding& decoding) {
    return decoding.encoding == DepthEncoding::z_buffer || decoding.encoding == DepthEncoding::normalized;
}

enum class RayScale { to_axis, to_ray };

/// The cosine between a pixel's ray and the view axis turns distance along the ray into distance along the
/// axis.
void scale_by_cosine(Image& depth, const DecodeContext& context, RayScale scale) {
    const auto focal_length_mm = context.camera.get("focal_length"),
               sensor_width_mm = context.camera.get("sensor_width");
    if (!focal_length_mm || !sensor_width_mm)
        throw Error(ErrorKind::capture, context.file +
                                            ": this depth is radial and needs the camera's focal_length and "
                                            "sensor_width (give them in capture.json's camera)");
    const double focal_px = *focal_length_mm / *sensor_width_mm * context.display.width();
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x) {
            const double dx =
                x + context.grid.min_x - context.display.min_x + 0.5 - 0.5 * context.display.width();
            const double dy =
                y + context.grid.min_y - context.display.min_y + 0.5 - 0.5 * context.display.height();
            const double cosine = focal_px / std::sqrt(focal_px * focal_px + dx * dx + dy * dy);
            depth.at(x, y, 0) *= float(scale == RayScale::to_axis ? cosine : 1 / cosine);
        }
}

/// What a stored component, its bias taken away, is multiplied by: px, cur-prev or next-cur, +y down.
struct VelocityFactor {
    float x = 1;
    float y = 1;
};

VelocityFactor velocity_factor(const RoleDecoding& decoding, const DecodeContext& context) {
    const bool reversed =
        decoding.delta == VelocityDelta::prev_minus_cur || decoding.delta == VelocityDelta::cur_minus_next;
    const bool px = decoding.unit == VelocityUnit::px;
    const double part = decoding.unit == VelocityUnit::ndc ? 0.5 : 1;
    const double per_frame = 1 / decoding.shutter_frames * (reversed ? -1 : 1);
    const double unit_x = px ? 1 : part * context.display.width(),
                 unit_y = px ? 1 : part * context.display.height();
    return {float(unit_x * decoding.velocity_scale[0] * per_frame),
            float(unit_y * decoding.velocity_scale[1] * per_frame * (decoding.y_axis_up ? -1 : 1))};
}

/// Values that are looked at together, so that those without a fault are decoded without a branch.
constexpr std::size_t kRun = 1024;

/// Whether each is the depth of something. Written so that NaN is nothing hit too: effects never see one.
bool has_hits(std::span<const float> values, const RoleDecoding& decoding) {
    const unsigned zero_is_no_hit = decoding.zero_is_no_hit;
    unsigned nothing_hit = 0;
    for (const float z : values)
        nothing_hit |= unsigned(!(z < decoding.no_hit)) | (zero_is_no_hit & unsigned(z == 0));
    return nothing_hit == 0;
}

/// Whether all lie between the marks and are finite; a NaN compares true with no limit. Marks are of x alone,
/// so a y beyond them only sends the run to the slow path.
bool has_motion(std::span<const float> values, const RoleDecoding& decoding) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    const float high = std::min(kLargest, decoding.no_motion_above.value_or(kLargest));
    const float low = std::max(-kLargest, decoding.no_motion_below.value_or(-kLargest));
    unsigned outside = 0;
    for (const float value : values) outside |= unsigned(!(value >= low)) | unsigned(!(value <= high));
    return outside == 0;
}

void scale_vectors(std::span<float> values, float bias, const VelocityFactor& factor) {
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
        values[i] = (values[i] - bias) * factor.x;
        values[i + 1] = (values[i + 1] - bias) * factor.y;
    }
}

/// By which a premultiplied vector is divided.
float vector_alpha(std::size_t pixel, const RoleDecoding& decoding, const DecodeContext& context) {
    const float alpha = decoding.premultiplied && context.color ? context.color->floats()[4 * pixel + 3] : 1;
    return alpha >= kLeastAlpha ? alpha : 1;
}

/// Whether all are whole numbers from 0 to below 2^24, which `ids` then has.
bool are_small_ids(std::span<const float> values, std::span<std::uint32_t> ids) {
    constexpr float kEnd = 1 << 24;
    unsigned others = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float value = values[i];
        const bool is_near = value >= 0 && value < kEnd;
        const std::int32_t whole = std::int32_t(is_near ? value : 0);
        others |= unsigned(float(whole) != value);
        ids[i] = std::uint32_t(whole);
    }
    return others == 0;
}

constexpr float kLargestId = 4294967040.0f;  // the last float below 2^32

bool is_id(float value) {
    return value >= 0 && value <= kLargestId && value == std::floor(value);
}

[[noreturn]] void refuse_id(float value, std::size_t pixel, std::size_t width, const std::string& file) {
    constexpr const char* kRemedyOfMeanIds =
        "; ids that are averaged over samples name no object (render them with one sample a pixel and "
        "without a filter, or render a Cryptomatte)";
    const bool is_between = std::isfinite(value) && value > 0 && value <= kLargestId;
    throw Error(ErrorKind::capture, file + ": object id " + std::to_string(value) + " at pixel (" +
                                        std::to_string(pixel % width) + ", " + std::to_string(pixel / width) +
                                        ") is not a whole number from 0 to 4294967040" +
                                        (is_between ? kRemedyOfMeanIds : ""));
}

/// Pixels from `first` on. Those without motion become 0 and are listed.
void decode_vectors(std::span<float> values, std::size_t first, const RoleDecoding& decoding,
                    const DecodeContext& context, const VelocityFactor& factor,
                    std::vector<std::size_t>& without_motion) {
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
        float& x = values[i];
        float& y = values[i + 1];
        const bool marked = (decoding.no_motion_above && x > *decoding.no_motion_above) ||
                            (decoding.no_motion_below && x < *decoding.no_motion_below);
        if (marked || !std::isfinite(x) || !std::isfinite(y)) {
            x = y = 0;
            without_motion.push_back(first + i / 2);
            continue;
        }
        const float alpha = vector_alpha(first + i / 2, decoding, context);
        x = (x / alpha - decoding.bias) * factor.x;
        y = (y / alpha - decoding.bias) * factor.y;
    }
}

}  // namespace

std::string range_fault(const std::string& role, const Image& stored, const RoleDecoding& decoding) {
    constexpr float kSlack = 1e-3f;  // of half floats and filters
    const RoleKind kind = kind_of_role(role);
    const bool is_mask = kind == RoleKind::coverage;
    const bool is_ranged =
        decoding.encoding == DepthEncoding::z_buffer || decoding.encoding == DepthEncoding::normalized;
    if (!is_mask && (kind != RoleKind::distance || !is_ranged)) return "";
    const auto is_outside = [&](float value) {
        const bool counts = std::isfinite(value) && (is_mask || value < decoding.no_hit);
        return counts && (value < -kSlack || value > 1 + kSlack);
    };
    if (std::ranges::none_of(stored.floats(), is_outside)) return "";
    if (is_mask)
        return role +
               " has values outside of 0 to 1, which no coverage has: check its channel in capture.json";
    return role + " is stored outside of 0 to 1 in places, and its encoding, " +
           depth_encoding_names()[std::size_t(decoding.encoding)] +
           ", has no such values: check the channel and \"encoding\" in capture.json";
}

void decode_depth(Image& depth, const RoleDecoding& decoding, const DecodeContext& context) {
    const bool ranged = is_ranged(decoding);
    const DepthRange range = ranged ? depth_range(decoding, context) : DepthRange{};
    const std::span<float> values = depth.floats();
    const bool is_scaled_alone = !ranged && decoding.encoding != DepthEncoding::inverse;
    const auto decode = [&](const Part& part) {
        for (std::size_t first = part.begin; first < part.end; first += kRun) {
            const std::span<float> run = values.subspan(first, std::min(kRun, part.end - first));
            if (is_scaled_alone && has_hits(run, decoding)) {
                // Without a write, the memory need not be written back.
                if (decoding.scale != 1)
                    for (float& z : run) z *= decoding.scale;
                continue;
            }
            for (float& z : run) {
                if (!has_hits({&z, 1}, decoding)) z = kNothingHit;
                else if (ranged) z = ranged_depth(z, decoding, range) * decoding.scale;
                else if (decoding.encoding == DepthEncoding::inverse)
                    z = z == 0 ? kNothingHit : decoding.scale / z;
                else z *= decoding.scale;
            }
        }
        return true;
    };
    for_each_part(parts_for_threads(values.size(), kRun, context.threads), decode);
    if (decoding.radial) scale_by_cosine(depth, context, RayScale::to_axis);
    if (decoding.offset_m != 0)
        for (float& z : depth.floats()) z = float(z + decoding.offset_m);
}

namespace {

/// NaN compares false.
float above_floor(float albedo, float floor) {
    return albedo >= floor ? albedo : floor;
}

}  // namespace

std::size_t divide_by_albedo(Image& light, const Image& albedo, float floor) {
    const std::span<float> values = light.floats();
    const std::span<const float> divisors = albedo.floats();
    std::size_t inexact = 0;
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        bool is_inexact = false;
        for (std::size_t c = i; c < i + 3; ++c) {
            is_inexact = is_inexact || (!(divisors[c] >= floor) && values[c] != 0);
            values[c] /= above_floor(divisors[c], floor);
        }
        inexact += is_inexact ? 1 : 0;
    }
    return inexact;
}

void multiply_by_albedo(Image& light, const Image& albedo, float floor) {
    for (std::size_t i = 0; i < light.floats().size(); ++i)
        light.floats()[i] *= above_floor(albedo.floats()[i], floor);
}

void encode_depth(Image& depth, const RoleDecoding& decoding, const DecodeContext& context) {
    const bool ranged = is_ranged(decoding);
    const DepthRange range = ranged ? depth_range(decoding, context) : DepthRange{};
    if (decoding.offset_m != 0)
        for (float& z : depth.floats()) z = float(z - decoding.offset_m);
    if (decoding.radial) scale_by_cosine(depth, context, RayScale::to_ray);
    const bool zero = decoding.zero_is_no_hit || decoding.encoding == DepthEncoding::inverse;
    const float no_hit = zero ? 0 : decoding.no_hit_stored.value_or(decoding.no_hit);
    for (float& z : depth.floats()) {
        if (ranged) z = ranged_value(z / decoding.scale, decoding, range);
        else if (std::isinf(z)) z = no_hit;
        else if (decoding.encoding == DepthEncoding::inverse) z = decoding.scale / z;
        else z /= decoding.scale;
    }
}

std::vector<std::size_t> decode_velocity(Image& velocity, const RoleDecoding& decoding,
                                         const DecodeContext& context) {
    const VelocityFactor factor = velocity_factor(decoding, context);
    const std::span<float> values = velocity.floats();
    const auto decode = [&](const Part& part) {
        std::vector<std::size_t> without_motion;
        for (std::size_t first = part.begin; first < part.end; first += kRun) {
            const std::span<float> run = values.subspan(first, std::min(kRun, part.end - first));
            if (!decoding.premultiplied && has_motion(run, decoding))
                scale_vectors(run, decoding.bias, factor);
            else decode_vectors(run, first / 2, decoding, context, factor, without_motion);
        }
        return without_motion;
    };
    std::vector<std::size_t> all;
    for (const auto& found : for_each_part(parts_for_threads(values.size(), kRun, context.threads), decode))
        all.insert(all.end(), found.begin(), found.end());
    return all;
}

void encode_velocity(Image& velocity, const RoleDecoding& decoding, const DecodeContext& context) {
    const VelocityFactor factor = velocity_factor(decoding, context);
    const std::span<float> values = velocity.floats();
    for (std::size_t pixel = 0; 2 * pixel + 1 < values.size(); ++pixel) {
        const float alpha = vector_alpha(pixel, decoding, context);
        values[2 * pixel] = (values[2 * pixel] / factor.x + decoding.bias) * alpha;
        values[2 * pixel + 1] = (values[2 * pixel + 1] / factor.y + decoding.bias) * alpha;
    }
}

Image decode_ids(const Image& stored, const std::string& file, int threads) {
    Image ids(stored.width(), stored.height(), 1, ComponentType::uint32);
    const std::span<const float> values = stored.floats();
    const std::span<std::uint32_t> made = ids.uints();
    const auto decode = [&](const Part& part) -> std::optional<std::size_t> {
        for (std::size_t first = part.begin; first < part.end; first += kRun) {
            const std::size_t end = std::min(first + kRun, part.end);
            if (are_small_ids(values.subspan(first, end - first), made.subspan(first, end - first))) continue;
            for (std::size_t i = first; i < end; ++i) {
                if (!is_id(values[i])) return i;
                made[i] = std::uint32_t(values[i]);
            }
        }
        return std::nullopt;
    };
    for (const auto& fault : for_each_part(parts_for_threads(values.size(), kRun, threads), decode))
        if (fault) refuse_id(values[*fault], *fault, std::size_t(stored.width()), file);
    return ids;
}

}  // namespace aftershade
