#include "cli/compare_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/exit_code.h"
#include "framework/base/diagnostics.h"
#include "framework/base/input_files.h"
#include "framework/batch/object_area.h"
#include "framework/compare/compare_files.h"
#include "framework/document/object_keys.h"
#include "framework/document/units.h"

namespace aftershade::cli {

namespace {

constexpr const char* kWhere =
    "X,Y,WIDTH,HEIGHT in px of the display window, mask:FILE, mask:FILE,CHANNEL or object:NAME";

std::optional<AreaShape> rectangle_of(const std::string& text) {
    std::array<double, 4> numbers{};
    std::size_t begin = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::size_t comma = text.find(',', begin);
        if ((comma == std::string::npos) != (i + 1 == numbers.size())) return std::nullopt;
        const auto number = parse_number(text.substr(begin, comma - begin));
        const double least = i < 2 ? -kMaxAreaSide_px : 1;
        if (!number || *number != std::floor(*number) || *number < least || *number > kMaxAreaSide_px)
            return std::nullopt;
        numbers[i] = *number;
        begin = comma + 1;
    }
    return rectangle_area(int(numbers[0]), int(numbers[1]), int(numbers[2]), int(numbers[3]));
}

constexpr std::string_view kMaskPrefix = "mask:", kObjectPrefix = "object:";

class AreaReader {
public:
    AreaReader(const CompareAreaOptions& options, const std::string& reference, const ReadLimits& limits,
               Diagnostics& diagnostics)
        : objects_from_(options.objects_from.empty() ? reference : options.objects_from),
          limits_(limits),
          diagnostics_(diagnostics) {}

    std::optional<CompareArea> read(const std::string& word, const std::string& where) {
        if (where.starts_with(kMaskPrefix)) return mask(where.substr(kMaskPrefix.size()));
        if (where.starts_with(kObjectPrefix)) return objects(word, where.substr(kObjectPrefix.size()));
        if (const auto shape = rectangle_of(where)) return CompareArea{where, *shape, std::nullopt};
        diagnostics_.error({word + " " + where},
                           fmt::format("'{}' is not an area; expected {}", where, kWhere));
        return std::nullopt;
    }

private:
    CompareArea mask(const std::string& text) const {
        const std::size_t comma = text.rfind(',');
        const std::string file = text.substr(0, comma);
        const std::string channel = comma == std::string::npos ? "" : text.substr(comma + 1);
        return {"mask " + text, mask_area(file, channel, limits_), std::nullopt};
    }

    std::optional<CompareArea> objects(const std::string& word, const std::string& text) {
        Node node;
        node.kind = Node::Kind::string;
        node.string = text;
        node.place = {word + " object:" + text};
        const int faults = diagnostics_.error_count();
        const std::vector<TableKey> keys = parse_object_keys(node, "the area", diagnostics_);
        if (diagnostics_.error_count() > faults) return std::nullopt;
        return CompareArea{object_area_name(keys), object_area(objects_from_, std::nullopt, keys, limits_),
                           std::nullopt};
    }

    std::string objects_from_;
    ReadLimits limits_;
    Diagnostics& diagnostics_;
};

/// "NAME=LIMIT" as its parts; levels that differ from the layer's by the limit alone.
struct Limited {
    std::string name;
    Levels levels;
};
std::optional<Limited> limited(const std::string& word, const std::string& text, const char* expected,
                               Diagnostics& diagnostics) {
    const std::size_t equals = text.rfind('=');
    const std::string number = equals == std::string::npos || equals == 0 ? "" : text.substr(equals + 1);
    const auto limit =
        number == "inf" ? std::optional(std::numeric_limits<double>::infinity()) : parse_number(number);
    if (!limit || !(*limit >= 0)) {
        diagnostics.error({word + " " + text},
                          fmt::format("expected {}, with a limit of at least 0", expected));
        return std::nullopt;
    }
    Limited result;
    result.name = text.substr(0, equals);
    result.levels.fail.limit = *limit;
    return result;
}

void add_compare_area_options(CLI::App& app, CompareAreaOptions& options) {
    const std::string group = "Areas and layers";
    const auto add = [&](const char* name, auto& target, const std::string& help) {
        return app.add_option(name, target, help)->group(group);
    };
    add("--ignore", options.ignored, std::string("Ignore these pixels; WHERE is ") + kWhere + "; repeatable")
        ->type_name("WHERE")
        ->allow_extra_args(false);
    add("--area", options.areas, "WHERE=LIMIT: use this --fail for these pixels; repeatable")
        ->type_name("WHERE=LIMIT")
        ->allow_extra_args(false);
    add("--layer", options.layers, "LAYER=LIMIT: use this --fail for this layer; repeatable")
        ->type_name("LAYER=LIMIT")
        ->allow_extra_args(false);
    add("--objects-from", options.objects_from,
        "Capture whose Cryptomatte or object_id resolves object:NAME (default: the reference)");
}

/// The files that these words name: masks and the capture of the objects.
std::vector<std::filesystem::path> compare_area_inputs(const CompareAreaOptions& options) {
    std::vector<std::filesystem::path> files = {options.objects_from};
    const auto add = [&](const std::string& where) {
        if (!where.starts_with(kMaskPrefix)) return;
        files.emplace_back(where.substr(kMaskPrefix.size()));
        files.emplace_back(
            files.back().string().substr(0, files.back().string().rfind(',')));  // before a channel
    };
    for (const std::string& where : options.ignored) add(where);
    for (const std::string& text : options.areas) add(text.substr(0, text.rfind('=')));
    return files;
}

/// Reads masks and objects. Faults of words go to `diagnostics`; a file that cannot be read is
/// Error(ErrorKind::capture).
void read_compare_areas(const CompareAreaOptions& options, const std::string& reference, CompareRules& rules,
                        Diagnostics& diagnostics) {
    AreaReader reader(options, reference, rules.limits, diagnostics);
    for (const std::string& where : options.ignored)
        if (auto area = reader.read("--ignore", where)) rules.areas.push_back(std::move(*area));
    for (const std::string& text : options.areas) {
        const auto own = limited("--area", text, "WHERE=LIMIT, such as 10,20,64,32=0.1", diagnostics);
        if (!own) continue;
        if (auto area = reader.read("--area", own->name)) {
            area->levels = own->levels;
            rules.areas.push_back(std::move(*area));
        }
    }
    if (rules.areas.size() > PixelAreas::kMost)
        diagnostics.error({"--ignore, --area"},
                          fmt::format("there are {} areas, more than {}; draw them into a mask",
                                      rules.areas.size(), PixelAreas::kMost));
    for (const std::string& text : options.layers)
        if (const auto own = limited("--layer", text, "LAYER=LIMIT, such as Z=0.001", diagnostics)) {
            Levels& levels = rules.layers.try_emplace(own->name, rules).first->second;
            levels.fail.limit = own->levels.fail.limit;
            if (levels.warn) levels.warn->limit = own->levels.fail.limit;
        }
}

void add_tolerance(CLI::App& app, const std::string& word, const char* verdict, ToleranceOptions& options) {
    const std::string group = std::string("Tolerance: ") + verdict;
    const auto add = [&](const std::string& name, auto& target, const std::string& help) {
        return app.add_option("--" + name, target, help)->group(group);
    };
    const bool fails = word == "fail";
    add(word, options.limit,
        fails ? "Largest difference of a pixel that passes (default: 1e-6)"
              : "Largest difference of a pixel without a warning (default: as --fail)");
    add(word + "relative", options.relative,
        fails ? "Let a difference pass that is at most this part of its value (default: 0)"
              : "Cause no warning for a difference that is at most this part of its value (default: as "
                "--failrelative)");
    add(word + "-ulp", options.ulp,
        fails ? "Let a difference pass, also by --hardfail, that is at most this many units in the last "
                "place of "
                "the coarser stored type (default: 0)"
              : "Cause no warning for a difference of at most this many units in the last place (default: as "
                "--fail-ulp)");
    add(word + "percent", options.percent, "Percentage of a layer's pixels that may exceed it (default: 0)");
    add("hard" + word, options.hard, "Largest difference of any pixel (default: inf)");
    add(std::string("allow") + (fails ? "failures" : "warnings"), options.allowed,
        fails ? "Number of pixels that may differ by any amount (default: 0)"
              : "Number of pixels that may differ without a warning (default: as --allowfailures)")
        ->check(CLI::NonNegativeNumber);
    add(word + "-flip", options.flip, "Largest mean FLIP error of a layer");
    add(word + "-ssim", options.ssim, "Smallest SSIM of a layer");
}

void check_number(const std::string& word, const std::optional<double>& value, double max,
                  Diagnostics& diagnostics) {
    if (!value || (*value >= 0 && *value <= max)) return;
    const std::string limit = std::isinf(max) ? "at least 0" : fmt::format("from 0 to {:g}", max);
    diagnostics.error({"--" + word}, fmt::format("{:g} is not a number {}", *value, limit));
}

Tolerance tolerance_of(const ToleranceOptions& options, const std::string& word, const Tolerance& defaults,
                       Diagnostics& diagnostics) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    check_number(word, options.limit, kInfinity, diagnostics);
    check_number(word + "relative", options.relative, kInfinity, diagnostics);
    check_number(word + "-ulp", options.ulp, kInfinity, diagnostics);
    check_number(word + "percent", options.percent, 100, diagnostics);
    check_number("hard" + word, options.hard, kInfinity, diagnostics);
    check_number(word + "-flip", options.flip, 1, diagnostics);
    check_number(word + "-ssim", options.ssim, 1, diagnostics);
    return {options.limit.value_or(defaults.limit),       options.percent.value_or(defaults.percent),
            options.hard.value_or(defaults.hard),         options.allowed.value_or(defaults.allowed),
            options.relative.value_or(defaults.relative), options.ulp.value_or(defaults.ulp)};
}

void read_roles(const CompareOptions& options, CompareRules& rules, Diagnostics& diagnostics) {
    std::vector<std::string> names = layer_role_names();
    names.push_back("ignore");
    for (const std::string& text : options.roles) {
        const std::size_t equals = text.rfind('=');
        const std::string role = equals == std::string::npos ? "" : text.substr(equals + 1);
        if (equals == std::string::npos || equals == 0)
            diagnostics.error({"--role " + text}, "expected LAYER=ROLE, such as Z=data");
        else if (role != "ignore" && !find_layer_role(role))
            diagnostics.error({"--role " + text}, "'" + role + "' is not a role; choose from " +
                                                      list_of_names(names, "and") +
                                                      did_you_mean(role, names));
        else rules.roles[text.substr(0, equals)] = find_layer_role(role);
    }
}

void read_flip(const CompareOptions& options, CompareRules& rules, Diagnostics& diagnostics) {
    const std::vector<std::string> choices = {"auto", "ldr", "hdr", "both", "none"};
    const auto choice = std::ranges::find(choices, options.flip);
    if (choice == choices.end())
        diagnostics.error({"--flip " + options.flip},
                          "expected " + list_of_names(choices) + did_you_mean(options.flip, choices));
    else rules.flip_choice = FlipChoice(choice - choices.begin());
    const std::vector<std::string> mappers = tone_mapper_names();
    if (const auto mapper = find_tone_mapper(options.tone_mapper)) rules.flip.tone_mapper = *mapper;
    else
        diagnostics.error({"--tone-mapper " + options.tone_mapper},
                          "expected " + list_of_names(mappers) + did_you_mean(options.tone_mapper, mappers));
    if (!options.viewing.empty())
        rules.flip.pixels_per_degree =
            pixels_per_degree(options.viewing[0], options.viewing[1], options.viewing[2]);
    if (options.pixels_per_degree) rules.flip.pixels_per_degree = *options.pixels_per_degree;
    // Filters grow with it; beyond, they are wider than any picture.
    if (!(rules.flip.pixels_per_degree >= 1 && rules.flip.pixels_per_degree <= 1000))
        diagnostics.error({"--ppd"}, fmt::format("{:g} pixels per degree are not from 1 to 1000",
                                                 rules.flip.pixels_per_degree));
    rules.flip.start_exposure = options.start_exposure;
    rules.flip.stop_exposure = options.stop_exposure;
    rules.flip.exposures = options.exposures;
    for (const auto& [word, value] : {std::pair{"--start-exposure", options.start_exposure},
                                      std::pair{"--stop-exposure", options.stop_exposure}})
        if (value && !(std::abs(*value) <= 100))
            diagnostics.error({word}, fmt::format("{:g} is not from -100 to 100 stops", *value));
    if (options.start_exposure && options.stop_exposure && *options.start_exposure > *options.stop_exposure)
        diagnostics.error({"--start-exposure"}, fmt::format("{:g} is above --stop-exposure {:g}",
                                                            *options.start_exposure, *options.stop_exposure));
    if (options.exposures && (*options.exposures < 1 || *options.exposures > 1000))
        diagnostics.error({"--exposures"}, fmt::format("{} is not from 1 to 1000", *options.exposures));
}

void check_outputs(const CompareOptions& options, Diagnostics& diagnostics) {
    std::vector<std::pair<std::string, std::string>> outputs = {{"-o", options.output},
                                                                {"--heat-map", options.heat_map},
                                                                {"--side-by-side", options.side_by_side},
                                                                {"--csv", options.csv}};
    std::erase_if(outputs, [](const auto& output) { return output.second.empty(); });
    InputFiles inputs;
    for (const std::string& input : {options.reference, options.test})
        inputs.add(std::filesystem::path(input));
    inputs.add(compare_area_inputs(options.areas));
    for (const auto& [word, path] : outputs) {
        const bool png = path.ends_with(".png"), exr = path.ends_with(".exr");
        if (word == "--side-by-side" && !png)
            diagnostics.error({word + " " + path}, "the picture is a .png file");
        if ((word == "-o" || word == "--heat-map") && !png && !exr)
            diagnostics.error({word + " " + path}, "expected a .exr or .png file");
        inputs.check_output({word + " " + path}, path, diagnostics);
    }
    if (options.scale == 0 || !std::isfinite(options.scale))
        diagnostics.error({"--scale"},
                          fmt::format("{:g} is not a factor; write a finite number", options.scale));
}

}  // namespace

void add_compare_options(CLI::App& app, CompareOptions& options) {
    app.footer(
        "Exit codes: 0 same, 1 warning, 2 failure, 3 different size, channels or parts, 4 a file cannot be "
        "read or written, 64 wrong usage.");
    app.add_option("reference", options.reference, "The expected picture: .exr, .png or .hdr")->required();
    app.add_option("test", options.test, "The picture to judge")->required();
    add_tolerance(app, "fail", "failure, exit 2", options.fail);
    add_tolerance(app, "warn", "warning, exit 1", options.warn);
    app.add_flag("--nan-equal", options.nan_equal,
                 "Treat NaN as equal to NaN (by default a pixel with NaN fails)");
    app.add_flag("--fill-outside", options.fill_outside,
                 "Let data windows differ: outside one, depth is infinite and all else is 0");
    app.add_option("--role", options.roles,
                   "LAYER=ROLE: color, display, alpha, depth, velocity, id, data or ignore; repeatable")
        ->allow_extra_args(false);
    auto* shift =
        app.add_option("--forgive-shift", options.forgive_shift_px,
                       "Pass a pixel that matches a neighbour within PX, in both directions (default: 0)")
            ->type_name("PX")
            ->check(CLI::Range(0, Forgive::kMaxShift_px));
    app.add_option(
           "--forgive-blur", options.forgive_blur_px,
           "Pass a pixel that matches after a Gaussian blur of this sigma over both files (default: 0)")
        ->type_name("PX")
        ->check(CLI::Range(0.0, Forgive::kMaxBlur_px))
        ->excludes(shift);
    add_compare_area_options(app, options.areas);
    app.add_option("--flip", options.flip,
                   "FLIP metric: auto (LDR for encoded colours, HDR for light), ldr, hdr, both or none");
    app.add_flag("--no-ssim", options.no_ssim, "Skip SSIM and MS-SSIM");
    auto* ppd = app.add_option("--ppd", options.pixels_per_degree,
                               "FLIP: pixels per degree of visual angle (default: 67.0206)");
    app.add_option("--viewing", options.viewing,
                   "FLIP: the display's distance in m, width in px and width in m")
        ->expected(3)
        ->excludes(ppd);
    app.add_option("--tone-mapper", options.tone_mapper, "HDR-FLIP: aces, reinhard or hable");
    app.add_option("--start-exposure", options.start_exposure,
                   "HDR-FLIP: stops (default: from the reference)");
    app.add_option("--stop-exposure", options.stop_exposure, "HDR-FLIP: stops (default: from the reference)");
    app.add_option("--exposures", options.exposures, "HDR-FLIP: number of exposures (default: one per stop)");
    app.add_option("-o,--output", options.output,
                   "Write reference minus test: all layers to .exr, |difference| of the first to .png");
    app.add_flag("--abs", options.absolute, "-o: write absolute values");
    app.add_option("--scale", options.scale, "-o: multiply by this factor (default: 1)");
    app.add_option("--heat-map", options.heat_map,
                   "Write the FLIP error map: .png in magma colours, .exr as values");
    app.add_option("--side-by-side", options.side_by_side,
                   "Write every layer's reference, test and difference, labelled, to this .png");
    app.add_flag("--only-different", options.only_different,
                 "Write pictures only if the verdict is not `same` (idiff's -od)");
    app.add_flag("--json", options.json, "Print the report as JSON on stdout; text goes to stderr");
    app.add_option("--csv", options.csv, "Write one line per layer to this file");
    app.add_flag("-q,--quiet", options.quiet, "Print errors only");
    app.add_option("--threads", options.threads,
                   "Largest number of threads (default: all cores); does not change results")
        ->check(CLI::Range(0, 1024));
}

CompareRules rules_of(const CompareOptions& options) {
    Diagnostics diagnostics;
    CompareRules rules;
    rules.fail = tolerance_of(options.fail, "fail", {}, diagnostics);
    Tolerance as_fail;
    as_fail.limit = rules.fail.limit;
    as_fail.allowed = rules.fail.allowed;
    as_fail.relative = rules.fail.relative;
    as_fail.ulp = rules.fail.ulp;
    const Tolerance warn = tolerance_of(options.warn, "warn", as_fail, diagnostics);
    if (options.warn.any()) rules.warn = warn;
    rules.nan_equal = options.nan_equal;
    rules.fill_outside = options.fill_outside;
    rules.fail_flip = options.fail.flip, rules.fail_ssim = options.fail.ssim;
    rules.warn_flip = options.warn.flip, rules.warn_ssim = options.warn.ssim;
    rules.ssim = !options.no_ssim;
    rules.threads = options.threads;
    rules.forgive = {options.forgive_shift_px, options.forgive_blur_px};
    read_roles(options, rules, diagnostics);
    read_compare_areas(options.areas, options.reference, rules, diagnostics);
    read_flip(options, rules, diagnostics);
    check_outputs(options, diagnostics);
    if ((rules.fail_flip || rules.warn_flip) && rules.flip_choice == FlipChoice::none)
        diagnostics.error({"--flip none"}, "--fail-flip and --warn-flip need FLIP");
    if ((rules.fail_ssim || rules.warn_ssim) && !rules.ssim)
        diagnostics.error({"--no-ssim"}, "--fail-ssim and --warn-ssim need SSIM");
    if (!diagnostics.has_errors()) return rules;
    throw CodedError(kCompareUsage, diagnostics);
}

}  // namespace aftershade::cli
