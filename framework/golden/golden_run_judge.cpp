#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/lfs_pointer.h"
#include "framework/compare/difference_picture.h"
#include "framework/file/png_file.h"
#include "framework/golden/golden_run.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// Size and place of a layer's largest difference, for those who have the log alone.
std::string largest_of(const LayerComparison& layer) {
    const LargestDifference& most = layer.differences.largest;
    if (layer.differences.pixels == 0 || layer.differences.bits_equal) return "";
    return fmt::format("; largest difference {:.6g} at ({}, {}) {}, {:.6g} instead of {:.6g}", most.value,
                       most.x + layer.window.min_x, most.y + layer.window.min_y,
                       layer.channels.at(std::size_t(most.channel)), most.test, most.reference);
}

std::vector<std::string> reasons_of(const Comparison& comparison) {
    std::vector<std::string> reasons = comparison.faults;
    reasons.insert(reasons.end(), comparison.warnings.begin(), comparison.warnings.end());
    for (const LayerComparison& layer : comparison.layers)
        for (const std::string& reason : layer.reasons)
            reasons.push_back(layer.label + ": " + reason +
                              (&reason == &layer.reasons.front() ? largest_of(layer) : ""));
    return reasons;
}

/// Whether both are known, and differ.
bool differ(const std::string& now, const std::string& before) {
    return !now.empty() && !before.empty() && now != before;
}

/// Why bits differ, as far as the sidecar tells.
void find_changes(const GoldenSidecar& approved, const GoldenSources& sources,
                  const GoldenEnvironment& environment, GoldenImage& result) {
    const bool look = differ(sources.look, approved.sources.look);
    const bool capture = differ(sources.capture, approved.sources.capture);
    const bool program = differ(sources.program, approved.sources.program);
    const std::string machine = environment.difference(approved.environment);
    if (look) result.changes.push_back("the look or an effect has changed since it was approved");
    if (capture) result.changes.push_back("the capture has changed since it was approved");
    if (program)
        result.changes.push_back("the program is Aftershade " + sources.program + " instead of " +
                                 approved.sources.program);
    if (machine.empty()) return;
    // Of older sidecars capture and program are not known.
    const auto is_known = [](const GoldenSources& of) {
        return !of.look.empty() && !of.capture.empty() && !of.program.empty();
    };
    result.only_machine_changed = result.changes.empty() && is_known(sources) && is_known(approved.sources);
    result.changes.push_back(
        (result.only_machine_changed ? "only the machine differs: " : "the machine differs: ") + machine);
}

/// The image against one approved image.
void compare_with(const ApprovedImage& approved, const CompareRules& rules, const RenderedImage& rendered,
                  const GoldenSources& sources, const GoldenEnvironment& environment, GoldenImage& result) {
    result.approved = approved;
    result.comparison = compare_files(approved.file, rendered.file, rules);
    result.bits_equal = has_equal_bits(*result.comparison);
    result.verdict = result.comparison->verdict;
    result.reasons = reasons_of(*result.comparison);
    // Of a pointer neither sidecar nor approval says anything.
    if (approved.sidecar_fault && lfs_fault(approved.file).empty()) {
        result.verdict = std::max(result.verdict, approved.sidecar_fault->verdict);
        result.reasons.push_back(approved.sidecar_fault->text);
    }
    result.exact_tier = approved.sidecar && !sources.look.empty() &&
                        approved.sidecar->sources.look == sources.look &&
                        approved.sidecar->environment.equals(environment);
    if (result.bits_equal) return;
    if (approved.sidecar) find_changes(*approved.sidecar, sources, environment, result);
    if (result.exact_tier) {
        result.verdict = std::max(result.verdict, Verdict::warning);
        if (result.changes.empty())
            result.reasons.push_back(
                "bits differ although renderer, driver, CPU, look and effects are those of " +
                approved.file.filename().string());
    }
    if (result.verdict != Verdict::same)
        result.reasons.insert(result.reasons.end(), result.changes.begin(), result.changes.end());
}

/// The layer to look at: that of the worst verdict, of equal ones the first with colours.
class PictureTaker {
public:
    void add(const LayerComparison& layer, const LayerImages& images) {
        const int rank = 2 * int(layer.verdict) + is_perceptual(layer.role);
        if (rank <= best_ || images.reference.empty()) return;
        best_ = rank;
        row_ = side_by_side_row(layer, images);
    }
    const std::optional<SideBySideRow>& row() const { return row_; }

private:
    int best_ = -1;
    std::optional<SideBySideRow> row_;
};

/// Eight times what `fail` lets pass is white: of light a few pixels would leave all others black. With a
/// limit near 0 that would make every difference white, so a sixteenth of the largest one is white at least,
/// and the largest at most.
double difference_scale(const GoldenImage& result, const CompareRules& rules) {
    double largest = 0;
    if (result.comparison)
        for (const LayerComparison& layer : result.comparison->layers)
            if (largest == 0 || is_perceptual(layer.role))
                largest = std::max(largest, layer.differences.largest.value);
    const double white = std::min(largest, std::max(8 * rules.fail.limit, largest / 16));
    return white > 0 && std::isfinite(white) ? 1 / white : 1;
}

void copy_into(const fs::path& from, const fs::path& to) {
    AtomicFile file(to);
    file.copy_from(from);
    file.commit();
}

/// nullopt where there is no area, or where a mask is so speckled that its map would fill the report.
std::optional<AreaMap> area_map(const Window& window, const PixelAreas& areas) {
    constexpr std::size_t kMostRuns = 100'000;
    if (areas.of_pixel.empty()) return std::nullopt;
    AreaMap map{window, {}};
    for (const std::uint8_t area : areas.of_pixel) {
        const int mark = area == PixelAreas::kLeftOut ? -1 : int(area);
        if (map.runs.empty() || map.runs.back().mark != mark) map.runs.push_back({mark, 0});
        if (map.runs.size() > kMostRuns) return std::nullopt;
        ++map.runs.back().pixels;
    }
    return map;
}

/// The names in the result begin with that of the report's folder of pictures.
void write_pictures(const GoldenCase& test, const CompareRules& rules, const RenderedImage& rendered,
                    ReportPictures& report, GoldenImage& result) {
    std::string stem = test.name + "." + rendered.name.substr(test.stem.size() + 1);
    std::ranges::replace(stem, '/', '.');
    const auto path = [&](const std::string& kind, const char* extension = ".png") {
        return report.add(stem + "." + kind + extension);
    };
    const auto told = [&](const fs::path& file) {
        return (report.folder().filename() / file.filename()).string();
    };
    GoldenPictures& pictures = result.pictures;
    copy_into(rendered.file, path("test", ".exr"));
    pictures.test_exr = told(path("test", ".exr"));
    pictures.test_hash = file_hash(rendered.file);
    // Without an approved image the new one stands for both; there is no difference to be seen.
    const fs::path reference = result.approved ? result.approved->file : rendered.file;
    PictureTaker taker;
    pictures.difference_scale = difference_scale(result, rules);
    ComparisonPictures all({true, pictures.difference_scale}, true, true, true);
    const Comparison comparison = compare_files(reference, rendered.file, rules,
                                                [&](const LayerComparison& layer, LayerImages& images) {
                                                    if (auto map = area_map(layer.window, images.areas))
                                                        result.areas[layer.label] = std::move(*map);
                                                    taker.add(layer, images);
                                                    all.add(layer, images);
                                                });
    if (result.approved) {
        copy_into(reference, path("reference", ".exr"));
        pictures.reference_exr = told(path("reference", ".exr"));
        pictures.reference_hash = file_hash(reference);
    }
    if (!taker.row()) return;  // nothing could be compared
    const SideBySideRow& row = *taker.row();
    write_png(path("test"), row.pictures[1]);
    pictures.test = told(path("test"));
    if (!result.approved) return;
    write_png(path("reference"), row.pictures[0]);
    pictures.reference = told(path("reference"));
    if (result.bits_equal) return;
    all.write_difference(path("difference"));
    pictures.difference = told(path("difference"));
    all.write_side_by_side(path("side_by_side"), result.name);
    pictures.side_by_side = told(path("side_by_side"));
    if (std::ranges::none_of(comparison.layers,
                             [](const LayerComparison& layer) { return layer.hdr_flip || layer.ldr_flip; }))
        return;
    all.write_heat_map(path("flip"));
    pictures.heat_map = told(path("flip"));
}

struct RulesOrFault {
    CompareRules rules;  ///< without areas where they cannot be read
    std::string fault;
};

RulesOrFault rules_or_fault(const GoldenCase& test, int frame) {
    try {
        return {test.rules_of(frame), ""};
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::capture) throw;
        return {test.rules, error.what()};
    }
}

}  // namespace

bool has_equal_bits(const Comparison& comparison) {
    return comparison.verdict <= Verdict::failure && comparison.faults.empty() &&
           comparison.warnings.empty() &&
           std::ranges::all_of(comparison.layers,
                               [](const LayerComparison& layer) { return layer.differences.bits_equal; });
}

GoldenImage judge_image(const GoldenCase& test, const RenderedImage& rendered, const GoldenSources& sources,
                        const GoldenEnvironment& environment, ReportPictures* pictures) {
    const std::vector<ApprovedImage> approved = approved_images(test.goldens, rendered.name, environment);
    GoldenImage best;
    bool own_bits_differ = false;
    const auto [rules, fault] = rules_or_fault(test, rendered.frame);
    for (const ApprovedImage& candidate : approved) {
        GoldenImage result;
        compare_with(candidate, rules, rendered, sources, environment, result);
        own_bits_differ |= result.exact_tier && !result.bits_equal;
        if (!best.approved || result.verdict < best.verdict) best = std::move(result);
        if (best.verdict == Verdict::same || (own_bits_differ && best.verdict == Verdict::warning)) break;
    }
    best.name = rendered.name, best.output = rendered.output, best.frame = rendered.frame;
    best.approved_count = approved.size();
    // Another renderer's image may let the picture pass, but not the bits.
    if (own_bits_differ && best.verdict == Verdict::same) {
        best.verdict = Verdict::warning;
        best.reasons.push_back(
            "bits differ from this renderer's own approved image, although renderer, "
            "driver, CPU, look and effects are the same");
    }
    if (approved.empty()) {
        best.verdict = Verdict::failure;
        best.reasons = {"no golden " + (test.goldens / (rendered.name + ".exr")).string()};
    }
    if (!fault.empty()) {
        best.verdict = Verdict::file_error;
        best.reasons.push_back(fault);
    }
    if (pictures) write_pictures(test, rules, rendered, *pictures, best);
    best.rules = rules;
    for (CompareArea& area : best.rules.areas) area.shape = {};
    return best;
}

}  // namespace aftershade
