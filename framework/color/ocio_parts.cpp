#include "framework/color/ocio_parts.h"

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace aftershade {

namespace {

/// Numbers beyond it count as it: far from light, and from overflow.
constexpr float kLargest = 0x1p64f;

bool is_diagonal(const ocio::MatrixTransform& transform) {
    double matrix[16] = {};
    transform.getMatrix(matrix);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (row != column && matrix[row * 4 + column] != 0) return false;
    return true;
}

/// Milliseconds of the text at 1080p on llvmpipe, about; nullopt where a channel's result is not of that
/// channel alone.
std::optional<int> cost_of(const ocio::ConstTransformRcPtr& transform) {
    switch (transform->getTransformType()) {
        case ocio::TRANSFORM_TYPE_MATRIX:
            if (!is_diagonal(dynamic_cast<const ocio::MatrixTransform&>(*transform))) return std::nullopt;
            return 1;
        case ocio::TRANSFORM_TYPE_RANGE: return 1;
        case ocio::TRANSFORM_TYPE_LOG:
        case ocio::TRANSFORM_TYPE_LOG_AFFINE:
        case ocio::TRANSFORM_TYPE_LOG_CAMERA:
        case ocio::TRANSFORM_TYPE_EXPONENT:
        case ocio::TRANSFORM_TYPE_EXPONENT_WITH_LINEAR: return 6;
        case ocio::TRANSFORM_TYPE_GRADING_RGB_CURVE: return 50;
        case ocio::TRANSFORM_TYPE_LUT1D: {
            const auto& lut = dynamic_cast<const ocio::Lut1DTransform&>(*transform);
            if (lut.getHueAdjust() != ocio::HUE_NONE) return std::nullopt;
            return 30;
        }
        default: return std::nullopt;
    }
}

/// The numbers without bits below `shift`, or between each and the next, in the order of their bits.
std::vector<float> numbers(int shift, std::uint32_t between) {
    std::vector<float> all(std::size_t(1) << (32 - shift));
    for (std::size_t i = 0; i < all.size(); ++i) {
        const float number = std::bit_cast<float>((std::uint32_t(i) << shift) + between);
        const bool is_small = std::abs(number) < kLargest;
        all[i] = is_small ? number : i < all.size() / 2 ? kLargest : -kLargest;
    }
    return all;
}

/// To colours, RGB interleaved.
void apply(const ocio::ConstProcessorRcPtr& processor, std::vector<float>& rgb) {
    ocio::PackedImageDesc pixels(rgb.data(), long(rgb.size() / 3), 1, 3);
    processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS)->apply(pixels);
}

/// What the processor makes of each number in every channel: RGB interleaved.
std::vector<float> applied(const ocio::ConstProcessorRcPtr& processor, const std::vector<float>& values) {
    std::vector<float> rgb;
    rgb.reserve(values.size() * 3);
    for (const float value : values) rgb.insert(rgb.end(), 3, value);
    apply(processor, rgb);
    for (float& value : rgb) value = std::clamp(value, -kLargest, kLargest);
    return rgb;
}

/// The red modifier of the ACES 1 RRT. OpenColorIO's text has the angle of the whole circle and all four
/// pieces of the spline around red, whose halves are the same; here is the half up to its end at 67.5
/// degrees. Polynomial for the angle: Abramowitz and Stegun, 4.4.47.
constexpr std::string_view kRedModifier10 = R"(vec3 $name(vec3 rgb) {
    float along = 2.0 * rgb.r - (rgb.g + rgb.b), across = abs(1.7320508 * (rgb.g - rgb.b));
    float ahead = max(along, 1e-30);
    float q = min(ahead, across) / max(ahead, across), q2 = q * q;
    float acute = q * (0.9998660 + q2 * (-0.3302995 + q2 * (0.1801410 + q2 * (-0.0851330 + q2 * 0.0208351))));
    float place = 1.6976527 * (across > ahead ? 1.57079633 - acute : acute);
    float outer = max(2.0 - place, 0.0), inner = max(1.0 - place, 0.0);
    float redness = along < 0.0 ? 0.0 : 0.25 * outer * outer * outer - inner * inner * inner;
    float high = max(rgb.r, max(rgb.g, rgb.b)), low = min(rgb.r, min(rgb.g, rgb.b));
    float saturation = (max(1e-10, high) - max(1e-10, low)) / max(1e-2, high);
    return vec3(rgb.r + redness * saturation * (0.03 - rgb.r) * 0.18, rgb.gb);
}
)";

std::string_view own_text_of(const ocio::ConstTransformRcPtr& transform) {
    const auto function = std::dynamic_pointer_cast<const ocio::FixedFunctionTransform>(transform);
    const bool is_red = function && function->getStyle() == ocio::FIXED_FUNCTION_ACES_RED_MOD_10 &&
                        function->getDirection() == ocio::TRANSFORM_DIR_FORWARD;
    return is_red ? kRedModifier10 : "";
}

class CurveSampler {
public:
    CurveSampler(const ocio::ConstProcessorRcPtr& processor, int shift)
        : processor_(processor), shift_(shift), rgb_(applied(processor_, numbers(shift, 0))) {}

    std::optional<BitCurve> curve() const {
        // A LUT of 4096 points has 32 of them between two of these numbers in [0.5, 1].
        constexpr int kPlaces = 32;
        for (int i = 1; i < kPlaces; ++i)
            if (!is_near(double(i) / kPlaces)) return std::nullopt;
        BitCurve curve{shift_, {}};
        for (std::size_t c = 0; c < (is_common() ? 1 : 3); ++c)
            for (std::size_t i = 0; i < size(); ++i)
                curve.values.insert(curve.values.end(), {rgb_[i * 3 + c], way(i, c)});
        return curve;
    }

private:
    std::size_t size() const { return rgb_.size() / 3; }

    bool is_common() const {
        for (std::size_t i = 0; i < rgb_.size(); i += 3)
            if (rgb_[i] != rgb_[i + 1] || rgb_[i] != rgb_[i + 2]) return false;
        return true;
    }

    /// From a number's value to that of the next; of the largest 0.
    float way(std::size_t i, std::size_t c) const {
        return (i + 1) % (size() / 2) == 0 ? 0 : rgb_[(i + 1) * 3 + c] - rgb_[i * 3 + c];
    }

    bool is_near(double share) const {
        const auto between = std::uint32_t(share * double(1u << shift_));
        const std::vector<float> exact = applied(processor_, numbers(shift_, between));
        for (std::size_t i = 0; i < size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const double expected = double(exact[i * 3 + c]);
                const double line = double(rgb_[i * 3 + c]) + share * double(way(i, c));
                const double limit = kCurveTolerance * std::max(std::abs(expected), 0.01);
                if (std::abs(expected) < double(kLargest) / 2 && !(std::abs(line - expected) <= limit))
                    return false;
            }
        return true;
    }

    ocio::ConstProcessorRcPtr processor_;
    int shift_;
    std::vector<float> rgb_;
};

/// The curve with the fewest numbers that is near enough.
std::optional<BitCurve> curve_of(const ocio::ConstProcessorRcPtr& processor) {
    for (const int shift : {17, 15})
        if (auto curve = CurveSampler(processor, shift).curve()) return curve;
    return std::nullopt;
}

float value_of(const BitCurve& curve, float x, std::size_t channel) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    const std::size_t line = (bits >> curve.shift) + (curve.is_common() ? 0 : channel * curve.size());
    const std::uint32_t rest = bits & ((1u << curve.shift) - 1);
    return curve.values[2 * line] + curve.values[2 * line + 1] * std::ldexp(float(rest), -curve.shift);
}

/// Colours of light and of displays: all of three of these.
std::vector<float> test_colors() {
    std::vector<float> values = {-0.05f, 0, 0.001f, 0.01f, 0.045f, 0.11f, 0.18f, 0.31f, 0.43f, 0.6f, 0.77f};
    values.insert(values.end(), {0.9f, 1, 1.7f, 5, 21, 140});
    std::vector<float> rgb;
    for (const float r : values)
        for (const float g : values)
            for (const float b : values) rgb.insert(rgb.end(), {r, g, b});
    return rgb;
}

void apply(const TransformPart& part, std::vector<float>& rgb) {
    if (part.curve)
        for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = value_of(*part.curve, rgb[i], i % 3);
    else apply(part.processor, rgb);
}

/// Whether the curves are near enough in the end: a matrix behind one may leave small differences of large
/// numbers. Of a display's numbers, in [0, 1], that is the difference itself.
bool are_near(const std::vector<TransformPart>& parts, const ocio::ConstProcessorRcPtr& processor,
              bool is_view) {
    std::vector<float> exact = test_colors(), whole = exact;
    apply(processor, exact);
    for (const TransformPart& part : parts) apply(part, whole);
    return std::ranges::equal(whole, exact, [&](float a, float b) {
        if (is_view)
            return std::abs(std::clamp(a, 0.0f, 1.0f) - std::clamp(b, 0.0f, 1.0f)) <= kPartsTolerance;
        return a == b || std::abs(a - b) <= kPartsTolerance * std::max(std::abs(b), 0.01f);
    });
}

/// Gathers parts in their order.
class Parts {
public:
    explicit Parts(ocio::ConstConfigRcPtr config) : config_(std::move(config)) {}

    void add(const ocio::ConstTransformRcPtr& transform) {
        const std::string_view text = own_text_of(transform);
        if (text.empty()) return others_->appendTransform(transform->createEditableCopy());
        end_others();
        parts_.push_back({config_->getProcessor(transform), std::nullopt, text});
    }

    /// Adds transforms that are curves of each channel. Those that a table would hardly shorten stay exact,
    /// but for a display's encoding, behind which nothing is left that could make its error larger.
    void add_run(const ocio::GroupTransformRcPtr& run, int cost, bool is_encoding) {
        const auto processor = config_->getProcessor(run);
        auto curve = cost > (is_encoding ? 5 : 12) ? curve_of(processor) : std::nullopt;
        if (!curve) return others_->appendTransform(run);
        end_others();
        parts_.push_back({processor, std::move(curve), ""});
    }

    std::vector<TransformPart> take() {
        end_others();
        return std::move(parts_);
    }

private:
    void end_others() {
        if (others_->getNumTransforms() > 0)
            parts_.push_back({config_->getProcessor(others_), std::nullopt, ""});
        others_ = ocio::GroupTransform::Create();
    }

    ocio::ConstConfigRcPtr config_;
    ocio::GroupTransformRcPtr others_ = ocio::GroupTransform::Create();
    std::vector<TransformPart> parts_;
};

}  // namespace

std::vector<TransformPart> parts_of(const ocio::ConstConfigRcPtr& config,
                                    const ocio::ConstProcessorRcPtr& processor, bool is_view) {
    const ocio::GroupTransformRcPtr all =
        processor->getOptimizedProcessor(ocio::OPTIMIZATION_DEFAULT)->createGroupTransform();
    Parts parts(config);
    for (int i = 0; i < all->getNumTransforms();) {
        const ocio::GroupTransformRcPtr run = ocio::GroupTransform::Create();
        int cost = 0;
        for (; i < all->getNumTransforms(); ++i) {
            const auto its_cost = cost_of(all->getTransform(i));
            if (!its_cost) break;
            cost += *its_cost;
            run->appendTransform(all->getTransform(i));
        }
        const bool is_last = i == all->getNumTransforms();
        if (run->getNumTransforms() > 0) parts.add_run(run, cost, is_view && is_last);
        if (i < all->getNumTransforms()) parts.add(all->getTransform(i++));
    }
    std::vector<TransformPart> made = parts.take();
    if (!are_near(made, processor, is_view)) made = {{processor, std::nullopt, ""}};
    return made;
}

}  // namespace aftershade
#endif
