#include <algorithm>
#include <limits>
#include <string>

#include "framework/batch/object_area.h"
#include "framework/document/grammar_reader.h"
#include "framework/golden/golden_case.h"
#include "framework/golden/golden_grammar.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// The numbers of `fail` or of `warn` that stand there; whether any of a pixel's does.
bool read_level(const grammar::Reader& reader, const std::string& word, const std::string& many,
                bool of_layers, Tolerance& level, std::optional<double>& flip, std::optional<double>& ssim) {
    bool any = false;
    const auto read = [&](const std::string& key, auto& target) {
        if (reader.has(key)) target = reader.number(key), any = true;
    };
    read(word, level.limit);
    read(word + "_relative", level.relative);
    read(word + "_ulp", level.ulp);
    read(word + "_percent", level.percent);
    read("hard_" + word, level.hard);
    if (reader.has("allow_" + many))
        level.allowed = std::uint64_t(reader.integer("allow_" + many)), any = true;
    if (!of_layers) return any;
    if (reader.has(word + "_flip")) flip = reader.number(word + "_flip");
    if (reader.has(word + "_ssim")) ssim = reader.number(word + "_ssim");
    return any;
}

/// Levels that a document changes: those of a layer begin as the case's.
struct ReadLevels {
    Levels levels;
    bool warns = false;  ///< has a `warn` key of a pixel
};

ReadLevels read_levels(const grammar::Reader& reader, const ReadLevels& base, bool of_layers,
                       Diagnostics& diagnostics) {
    ReadLevels result = base;
    Levels& levels = result.levels;
    read_level(reader, "fail", "failures", of_layers, levels.fail, levels.fail_flip, levels.fail_ssim);
    Tolerance warn = levels.fail;
    warn.percent = 0, warn.hard = std::numeric_limits<double>::infinity();
    if (base.warns) warn = *base.levels.warn;
    result.warns |=
        read_level(reader, "warn", "warnings", of_layers, warn, levels.warn_flip, levels.warn_ssim);
    levels.warn = result.warns ? warn : levels.fail;
    if (levels.fail.hard < levels.fail.limit)
        diagnostics.error(reader.place("hard_fail"), "'hard_fail' must be at least 'fail'");
    if (result.warns && levels.warn->hard < levels.warn->limit)
        diagnostics.error(reader.place("hard_warn"), "'hard_warn' must be at least 'warn'");
    return result;
}

void read_rectangle(const grammar::Reader& reader, GoldenArea& area, Diagnostics& diagnostics) {
    const std::vector<double> numbers = reader.numbers("rectangle");
    if (numbers.size() != 4) return;  // already reported
    if (numbers[2] < 1 || numbers[3] < 1)
        diagnostics.error(reader.place("rectangle"), "'rectangle' has a width and a height of at least 1 px");
    else area.rectangle = rectangle_area(int(numbers[0]), int(numbers[1]), int(numbers[2]), int(numbers[3]));
}

GoldenArea read_area(const grammar::Reader& reader, const fs::path& folder, Diagnostics& diagnostics) {
    GoldenArea area;
    if (reader.has("rectangle")) read_rectangle(reader, area, diagnostics);
    if (reader.has("mask")) area.mask = (folder / reader.text("mask")).lexically_normal();
    area.channel = reader.text("channel");
    if (const Node* object = reader.find("object")) {
        const auto add = [&](const Node& entry) {
            for (TableKey& key : parse_object_keys(entry, "the area", diagnostics))
                area.objects.push_back(std::move(key));
        };
        if (object->is_array()) std::ranges::for_each(object->items, add);
        else add(*object);
    }
    return area;
}

std::string name_of(const GoldenArea& area) {
    if (!area.objects.empty()) return object_area_name(area.objects);
    if (!area.mask.empty())
        return "mask " + area.mask.string() + (area.channel.empty() ? "" : "," + area.channel);
    const Window& window = area.rectangle->window;
    return std::to_string(window.min_x) + "," + std::to_string(window.min_y) + "," +
           std::to_string(window.width()) + "," + std::to_string(window.height());
}

}  // namespace

CompareRules read_golden_tolerance(const grammar::Reader& reader, Diagnostics& diagnostics) {
    CompareRules rules;
    const ReadLevels levels = read_levels(reader, {}, true, diagnostics);
    static_cast<Levels&>(rules) = levels.levels;
    for (const auto& [member, layer] : reader.named("layers"))
        rules.layers[member->key] = read_levels(layer, levels, true, diagnostics).levels;
    rules.nan_equal = reader.boolean("nan_equal");
    rules.forgive = {int(reader.integer("forgive_shift")), reader.number("forgive_blur")};
    rules.threads = 1;  // cases run beside each other
    return rules;
}

std::vector<GoldenArea> read_golden_areas(const grammar::Reader& tolerance, const fs::path& folder,
                                          Diagnostics& diagnostics) {
    std::vector<GoldenArea> areas;
    for (const grammar::Reader& reader : tolerance.objects("ignore"))
        areas.push_back(read_area(reader, folder, diagnostics));
    for (const grammar::Reader& reader : tolerance.objects("areas")) {
        GoldenArea& area = areas.emplace_back(read_area(reader, folder, diagnostics));
        area.levels = read_levels(reader, {}, false, diagnostics).levels;
    }
    if (areas.size() > PixelAreas::kMost)
        diagnostics.error(tolerance.node().place, "'ignore' and 'areas' have more than " +
                                                      std::to_string(PixelAreas::kMost) +
                                                      " items; draw them into a mask");
    return areas;
}

CompareRules parse_golden_tolerance(const Node& node, Diagnostics& diagnostics) {
    grammar::check(node, golden_tolerance_block(), diagnostics);
    return read_golden_tolerance({node, golden_tolerance_block()}, diagnostics);
}

CompareRules GoldenCase::rules_of(int frame) const {
    CompareRules whole = rules;
    for (const GoldenArea& area : areas) {
        AreaShape shape;
        if (area.rectangle) shape = *area.rectangle;
        else if (!area.mask.empty()) shape = mask_area(area.mask, area.channel, whole.limits);
        else shape = object_area(capture.string(), frame, area.objects, whole.limits);
        whole.areas.push_back({name_of(area), std::move(shape), area.levels});
    }
    return whole;
}

}  // namespace aftershade
