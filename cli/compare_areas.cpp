#include "cli/compare_areas.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "framework/batch/object_area.h"
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

}  // namespace

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

}  // namespace aftershade::cli
