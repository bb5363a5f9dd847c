#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "aftershade/compare.h"
#include "aftershade/velocity.h"
#include "framework/base/text.h"
#include "framework/capture/profile.h"
#include "framework/compare/compare_files.h"
#include "framework/host/failures.h"
#include "framework/host/host_data.h"
#include "framework/host/image_data.h"
#include "framework/inspect/velocity_frames.h"
#include "framework/inspect/velocity_report.h"

namespace aftershade::host {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxStops = 100;
constexpr int kMaxExposures = 1000;
constexpr int kMaxThreads = 1024;
constexpr const char* kIgnore = "ignore";

static_assert(int(Verdict::file_error) == int(aftershade::Verdict::file_error) &&
              int(FlipChoice::none) == int(aftershade::FlipChoice::none) &&
              int(ToneMapper::hable) == int(aftershade::ToneMapper::hable));

/// Holds options against their ranges.
class OptionCheck {
public:
    void number(const std::string& option, const std::optional<double>& value, double min, double max) {
        if (!value || (*value >= min && *value <= max)) return;
        const std::string range =
            std::isinf(max) ? fmt::format("at least {:g}", min) : fmt::format("from {:g} to {:g}", min, max);
        fault(option, fmt::format("{:g} is not {}", *value, range));
    }
    void tolerance(const std::string& option, const Tolerance& value) {
        number(option + ".limit", value.limit, 0, kInfinity);
        number(option + ".percent", value.percent, 0, 100);
        number(option + ".hard", value.hard, 0, kInfinity);
        number(option + ".relative", value.relative, 0, kInfinity);
        number(option + ".ulp", value.ulp, 0, kInfinity);
    }
    void fault(const std::string& option, const std::string& text) {
        faults_.error({"CompareOptions::" + option}, text);
    }
    void stop() const { stop_at_errors(ErrorKind::usage, faults_); }

private:
    Diagnostics faults_;
};

void check_roles(const CompareOptions& options, OptionCheck& check) {
    std::vector<std::string> known = layer_role_names();
    known.emplace_back(kIgnore);
    for (const auto& [label, role] : options.roles)
        if (std::find(known.begin(), known.end(), role) == known.end())
            check.fault("roles", "'" + role + "' is not a role; choose from " + list_of_names(known, "and") +
                                     did_you_mean(role, known));
}

void check_compare_options(const CompareOptions& options) {
    OptionCheck check;
    check.tolerance("fail", options.fail);
    if (options.warn) check.tolerance("warn", *options.warn);
    check.number("fail_flip", options.fail_flip, 0, 1);
    check.number("warn_flip", options.warn_flip, 0, 1);
    check.number("fail_ssim", options.fail_ssim, 0, 1);
    check.number("warn_ssim", options.warn_ssim, 0, 1);
    check.number("pixels_per_degree", options.pixels_per_degree, 1, 1000);
    check.number("start_exposure", options.start_exposure, -kMaxStops, kMaxStops);
    check.number("stop_exposure", options.stop_exposure, -kMaxStops, kMaxStops);
    if (options.start_exposure && options.stop_exposure && *options.start_exposure > *options.stop_exposure)
        check.fault("start_exposure", "is above stop_exposure");
    if (options.exposures) check.number("exposures", double(*options.exposures), 1, kMaxExposures);
    check.number("threads", double(options.threads), 0, kMaxThreads);
    check.number("flip", double(int(options.flip)), 0, double(int(FlipChoice::none)));
    check.number("tone_mapper", double(int(options.tone_mapper)), 0, double(int(ToneMapper::hable)));
    check_roles(options, check);
    check.stop();
}

aftershade::Tolerance internal(const Tolerance& tolerance) {
    return {tolerance.limit,   tolerance.percent,  tolerance.hard,
            tolerance.allowed, tolerance.relative, tolerance.ulp};
}

CompareRules rules_of(const CompareOptions& options) {
    check_compare_options(options);
    CompareRules rules;
    rules.fail = internal(options.fail);
    if (options.warn) rules.warn = internal(*options.warn);
    rules.fail_flip = options.fail_flip;
    rules.warn_flip = options.warn_flip;
    rules.fail_ssim = options.fail_ssim;
    rules.warn_ssim = options.warn_ssim;
    rules.nan_equal = options.nan_equal;
    rules.fill_outside = options.fill_outside;
    rules.flip_choice = aftershade::FlipChoice(int(options.flip));
    rules.flip.pixels_per_degree = options.pixels_per_degree;
    rules.flip.tone_mapper = aftershade::ToneMapper(int(options.tone_mapper));
    rules.flip.start_exposure = options.start_exposure;
    rules.flip.stop_exposure = options.stop_exposure;
    rules.flip.exposures = options.exposures;
    rules.flip.threads = rules.threads = options.threads;
    rules.ssim = options.ssim;
    rules.ssim_map = options.maps;
    for (const auto& [label, role] : options.roles) rules.roles[label] = find_layer_role(role);
    return rules;
}

Image public_map(const aftershade::Image& map) {
    return Access::image(std::make_shared<const aftershade::Image>(map));
}

void add_maps(const LayerComparison& layer, LayerFigures& figures) {
    const auto& flip = layer.hdr_flip ? layer.hdr_flip : layer.ldr_flip;
    if (flip) figures.flip_map = public_map(flip->error);
    if (!layer.ssim_map.empty()) figures.ssim_map = public_map(layer.ssim_map);
}

LargestDifference largest_of(const LayerComparison& layer) {
    const auto& from = layer.differences.largest;
    const auto channel = std::size_t(from.channel);
    return {from.value,
            from.x + layer.window.min_x,
            from.y + layer.window.min_y,
            channel < layer.channels.size() ? layer.channels[channel] : "",
            from.reference,
            from.test};
}

LayerFigures figures_of(const LayerComparison& layer, bool maps) {
    const PixelDifferences& differences = layer.differences;
    LayerFigures figures;
    figures.label = layer.label;
    figures.role = layer_role_name(layer.role);
    figures.channels = layer.channels;
    figures.window = public_window(layer.window);
    figures.pixels = differences.pixels;
    figures.failing = differences.failing.count;
    figures.warning = differences.warning.count;
    figures.bits_equal = differences.bits_equal;
    figures.mean_absolute = differences.mean_absolute;
    figures.rmse = differences.rmse;
    figures.psnr_db = differences.psnr_db;
    figures.mean_pixel = differences.mean_pixel;
    figures.largest = largest_of(layer);
    if (layer.ldr_flip) figures.ldr_flip = layer.ldr_flip->mean;
    if (layer.hdr_flip) figures.hdr_flip = layer.hdr_flip->mean;
    figures.ssim = layer.ssim;
    figures.ms_ssim = layer.ms_ssim;
    figures.verdict = Verdict(int(layer.verdict));
    figures.reasons = layer.reasons;
    figures.is_judged = layer.not_judged.empty();
    if (maps) add_maps(layer, figures);
    return figures;
}

/// `count` channels from `first` on, of an image of floats.
aftershade::Image channels_of(const aftershade::Image& image, int first, int count) {
    aftershade::Image part(image.width(), image.height(), count);
    const auto from = std::size_t(image.channels()), to = std::size_t(count);
    for (std::size_t i = 0; i < part.floats().size() / to; ++i)
        std::copy_n(&image.floats()[i * from + std::size_t(first)], to, &part.floats()[i * to]);
    return part;
}

Comparison compare_arrays(const aftershade::Image& reference, const aftershade::Image& test,
                          const std::string& role, const CompareOptions& options) {
    const CompareRules rules = rules_of(options);
    const auto layer_role = find_layer_role(role);
    if (!layer_role)
        fail_at(ErrorKind::usage, "role",
                "'" + role + "' is not a role; choose from " + list_of_names(layer_role_names(), "and") +
                    did_you_mean(role, layer_role_names()));
    if (!options.roles.empty())
        fail_at(ErrorKind::usage, "CompareOptions::roles", "two images are one layer; give its role alone");
    if (reference.empty() || test.empty()) fail_at(ErrorKind::usage, "image", "the image has no pixels");
    if (reference.width() != test.width() || reference.height() != test.height() ||
        reference.channels() != test.channels() || reference.type() != test.type())
        fail_at(ErrorKind::usage, "test",
                fmt::format("{} x {} px of {} channels of {}; the reference has {} x {} px of {} of {}",
                            test.width(), test.height(), test.channels(),
                            test.type() == ComponentType::uint32 ? "uint32" : "float32", reference.width(),
                            reference.height(), reference.channels(),
                            reference.type() == ComponentType::uint32 ? "uint32" : "float32"));
    const bool is_id = *layer_role == LayerRole::id;
    if (is_id != (reference.type() == ComponentType::uint32))
        fail_at(ErrorKind::usage, "role",
                is_id ? "id compares uint32; these images hold float32"
                      : "images of uint32 are compared as id, not as " + role);
    Comparison comparison;
    const auto add = [&](const aftershade::Image& a, const aftershade::Image& b, LayerRole as,
                         const std::string& label, std::vector<std::string> channels) {
        LayerComparison layer;
        layer.label = label;
        layer.role = as;
        layer.channels = std::move(channels);
        layer.window = {0, 0, a.width() - 1, a.height() - 1};
        compare_layer({a, b}, rules, layer);
        comparison.verdict = std::max(comparison.verdict, Verdict(int(layer.verdict)));
        comparison.labels.push_back(label);
        comparison.layers.push_back(figures_of(layer, options.maps));
        std::ranges::copy(layer.not_judged, std::back_inserter(comparison.not_judged));
    };
    const std::vector<std::string> names = {"R", "G", "B", "A"};
    const int channels = reference.channels();
    if (is_perceptual(*layer_role) && channels == 4) {  // as files have them: alpha is a layer of its own
        add(channels_of(reference, 0, 3), channels_of(test, 0, 3), *layer_role, role, {"R", "G", "B"});
        add(channels_of(reference, 3, 1), channels_of(test, 3, 1), LayerRole::alpha, "A", {"A"});
    } else {
        add(reference, test, *layer_role, role, {names.begin(), names.begin() + channels});
    }
    return comparison;
}

const aftershade::Image& pixels_of(const Image& image) {
    if (image.empty()) fail_at(ErrorKind::usage, "image", "the image has no pixels");
    return Access::pixels(image);
}

}  // namespace

const char* verdict_name(Verdict verdict) noexcept {
    return aftershade::verdict_name(aftershade::Verdict(int(verdict))).data();  // of literals
}

Comparison compare(const std::filesystem::path& reference, const std::filesystem::path& test,
                   const CompareOptions& options) {
    return with_public_errors([&] {
        const CompareRules rules = rules_of(options);
        Comparison comparison;
        const auto visit = [&](const LayerComparison& layer, LayerImages&) {
            comparison.layers.push_back(figures_of(layer, options.maps));
        };
        const aftershade::Comparison made = compare_files(reference, test, rules, visit);
        if (!made.unknown_roles.empty())
            fail_at(ErrorKind::usage, "CompareOptions::roles",
                    "no layer '" + made.unknown_roles.front() + "'" +
                        did_you_mean(made.unknown_roles.front(), made.labels) + "; the files have " +
                        list_of_names(made.labels, "and"));
        comparison.verdict = Verdict(int(made.verdict));
        comparison.faults = made.faults;
        comparison.warnings = made.warnings;
        comparison.notes = made.notes;
        comparison.labels = made.labels;
        comparison.not_judged = made.not_judged();
        return comparison;
    });
}

Comparison compare(const Image& reference, const Image& test, const std::string& role,
                   const CompareOptions& options) {
    return with_public_errors(
        [&] { return compare_arrays(pixels_of(reference), pixels_of(test), role, options); });
}

Comparison compare(const ArrayView& reference, const ArrayView& test, const std::string& role,
                   const CompareOptions& options) {
    return with_public_errors([&] {
        return compare_arrays(copy_of(reference, "reference"), copy_of(test, "test"), role, options);
    });
}

namespace {

static_assert(int(VelocityVerdict::untestable) == int(aftershade::VelocityVerdict::untestable));

VelocitySettings public_settings(const aftershade::VelocitySettings& settings) {
    return {settings.delta, settings.y_axis, settings.unit, settings.scale, settings.exchange_channels};
}

std::vector<VelocityCheck> checks_of(const aftershade::Capture& frame, const aftershade::Capture& next_frame,
                                     const std::map<std::string, RoleDecoding>& decodings) {
    std::vector<VelocityCheck> checks;
    for (const auto& [role, check] : check_velocity_of_frames(frame, next_frame, decodings))
        checks.push_back({role, VelocityVerdict(int(check.verdict)), check.sentence, check.identity.score,
                          check.rival.score, public_settings(check.settings),
                          public_settings(check.suggested), check.untold, check.longest_px});
    return checks;
}

const aftershade::Capture& in_memory(const Capture& capture) {
    const Capture::Data& data = Access::data(capture);
    for (const std::string& role : velocity_check_roles())
        if (data.has_texture(role))
            fail_at(ErrorKind::usage, role, "this image is a texture, whose pixels are on the GPU");
    return data.capture;
}

}  // namespace

const char* velocity_verdict_name(VelocityVerdict verdict) noexcept {
    return aftershade::velocity_verdict_name(aftershade::VelocityVerdict(int(verdict)));
}

std::vector<VelocityCheck> check_velocity(const Host& host, const std::filesystem::path& frame,
                                          const std::filesystem::path& next_frame,
                                          const CaptureOptions& options) {
    Host::Data& data = Access::host(host);
    return called(data, [&] {
        const auto read = [&](const Sequence::Data& from) {
            return Access::data(
                       read_capture(from, from.sequence.frames.front(), 0, role_ids(velocity_check_roles())))
                .capture;
        };
        const auto first = open_sequence_data(data, frame, options);
        const auto second = open_sequence_data(data, next_frame, options);
        second->reader->hold_to_first_of(*first->reader);
        return checks_of(
            read(*first), read(*second),
            second->reader->decodings(second->sequence.file_number(second->sequence.frames.front())));
    });
}

std::vector<VelocityCheck> check_velocity(const Capture& frame, const Capture& next_frame) {
    return with_public_errors([&] { return checks_of(in_memory(frame), in_memory(next_frame), {}); });
}

}  // namespace aftershade::host
