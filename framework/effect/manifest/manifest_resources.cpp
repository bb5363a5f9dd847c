// Inputs, outputs, textures, buffers and what native code fills.
#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/document/formula.h"
#include "framework/document/units.h"
#include "framework/effect/manifest/manifest_parser.h"
#include "framework/effect/manifest/manifest_when.h"

namespace aftershade {

namespace {

/// Whether the number of elements does not depend on the frame.
bool has_fixed_count(const BufferSpec& buffer) {
    return !buffer.grid && buffer.count.param.empty();
}

}  // namespace

CountSpec ManifestParser::count(const Reader& reader, const std::string& key, const CountLimits& limits) {
    CountSpec count;
    const Node* node = reader.find(key);
    if (!node) return count;
    if (node->is_string()) {
        count.param = node->string;
        count_by_param(*node, key, limits);
    } else {
        count.number = int(node->integer);
    }
    return count;
}

void ManifestParser::count_by_param(const Node& node, const std::string& key, const CountLimits& limits) {
    if (faulty_params_.contains(node.string)) return;
    const ParamSpec* spec = manifest_.find_param(node.string);
    const std::string names = "'" + key + "' names '" + node.string + "', ";
    if (!spec)
        fault(node.place,
              names + "which is not a parameter" + did_you_mean(node.string, manifest_.param_names()));
    else if (spec->type != ParamType::int_)
        fault(node.place, names + "whose type is " + std::string(param_type_name(spec->type)) + ", not int");
    else if (!spec->min || *spec->min < limits.least_of_param || !spec->max ||
             *spec->max > double(limits.most))
        fault(node.place, names + "which must have a 'min' of at least " +
                              std::to_string(limits.least_of_param) + " and a 'max' of at most " +
                              std::to_string(limits.most));
}

void ManifestParser::check_formula(const Node& node) {
    const auto value_of = [&](std::string_view name) -> std::optional<double> {
        const ParamSpec* spec = manifest_.find_param(std::string(name));
        if (is_grid_side(name) || faulty_params_.contains(std::string(name)) ||
            (spec && is_scalar_type(spec->type)))
            return 1;
        return std::nullopt;
    };
    const FormulaResult result = evaluate_formula(node.string, value_of);
    if (result.fault.empty()) return;
    fault(node.place, "'size': in \"" + node.string + "\", at character " + std::to_string(result.at + 1) +
                          ": " + result.fault +
                          " (a formula has numbers, + - * /, brackets, functions, 'width' and "
                          "'height' of the working grid and parameters that are one number)");
}

GridSpec ManifestParser::grid(const Reader& reader, bool may_be_fixed) {
    GridSpec grid;
    if (reader.has("scale")) grid.scale = reader.number("scale");
    if (may_be_fixed && reader.has("room")) {
        const std::vector<double> room = reader.numbers("room");
        std::copy(room.begin(), room.end(), grid.room);
    }
    if (reader.has("tile")) {
        grid.kind = GridSpec::Kind::tile;
        grid.tile = count(reader, "tile", kTileCount);
    }
    if (may_be_fixed && reader.has("size")) {
        grid.kind = GridSpec::Kind::size;
        const std::vector<int> sides = integers_of(reader, "size", 2);
        std::copy(sides.begin(), sides.end(), grid.size);
        const std::vector<Node>& items = reader.find("size")->items;
        for (std::size_t axis = 0; axis < 2 && axis < items.size(); ++axis)
            if (items[axis].is_string()) {
                grid.formula[axis] = items[axis].string;
                check_formula(items[axis]);
            }
    }
    return grid;
}

std::optional<GridSpec> ManifestParser::per(const Reader& reader) {
    if (!reader.node().find("per")) return std::nullopt;
    const auto counted = reader.object("per");
    return counted ? grid(*counted, false) : GridSpec{};
}

void ManifestParser::inputs(const Reader& document) {
    for (const auto& [member, reader] : document.named("inputs")) {
        InputSpec input;
        input.name = member->key;
        input.place = member->key_place;
        input.role = reader.text("role");
        input.optional = reader.boolean("optional");
        input.history = reader.boolean("history");
        input.frame = int(reader.number("frame"));
        if (reader.has("layer")) input.layer = int(reader.integer("layer"));
        input.from_capture = reader.has("from");
        input.instead = reader.text("instead");
        input.doc = reader.text("doc");
        add_conditions(reader, input.when);
        // The grammar reports conditions on other inputs.
        std::erase_if(input.when,
                      [](const WhenSpec& c) { return name_in_condition(c.subject) != c.subject; });
        manifest_.inputs.push_back(std::move(input));
    }
}

void ManifestParser::outputs(const Reader& document) {
    for (const auto& [member, reader] : document.named("outputs"))
        manifest_.outputs.push_back(
            {member->key, reader.text("role"), reader.text("doc"), member->key_place});
}

void ManifestParser::textures(const Reader& document) {
    for (const Reader::Named& declared : document.named("textures"))
        if (is_new("texture", *declared.member)) texture(declared);
}

void ManifestParser::texture(const Reader::Named& declared) {
    const Reader& reader = declared.reader;
    TextureSpec texture;
    texture.name = declared.member->key;
    texture.place = declared.member->key_place;
    texture.doc = reader.text("doc");
    const auto format = gpu::parse_texture_format(reader.text("format"));
    if (format) texture.format = *format;
    texture.grid = grid(reader, true);
    texture.layers = int(reader.integer("layers"));
    mips(reader, texture);
    if (reader.has("clear")) {
        texture.clear = reader.numbers("clear");
        if (const std::string why = why_not_in_format(*texture.clear, texture.format); format && !why.empty())
            fault(reader.place("clear"), "'clear' " + why);
    }
    texture.history = reader.boolean("history");
    texture.partial = reader.boolean("partial");
    if (texture.partial && (texture.clear || texture.history))
        fault(reader.place("partial"),
              "a 'partial' texture has no 'clear' and no 'history': leave out one or the other");
    if (texture.partial && format && !gpu::is_integer(*format))
        fault(reader.place("partial"), "a 'partial' texture has an integer format, such as rgba32ui; " +
                                           reader.text("format") + " needs 'clear'");
    add_conditions(reader, texture.when);
    manifest_.textures.push_back(std::move(texture));
}

void ManifestParser::mips(const Reader& reader, TextureSpec& texture) {
    const Node* mips = reader.find("mips");
    if (mips->is_string()) {
        texture.auto_mips = true;
        texture.mips = 0;
        if (gpu::is_integer(texture.format))
            fault(mips->place, "an integer texture has no automatic 'mips': integers have no mean");
        return;
    }
    texture.mips = int(mips->integer);
    const int side = std::max(texture.grid.size[0], texture.grid.size[1]);
    if (texture.grid.kind == GridSpec::Kind::size && (side >> (texture.mips - 1)) == 0)
        fault(mips->place, "'mips' is " + std::to_string(texture.mips) + ", but " + std::to_string(side) +
                               " texels a side have fewer levels");
}

void ManifestParser::buffers(const Reader& document) {
    for (const Reader::Named& declared : document.named("buffers"))
        if (is_new("buffer", *declared.member)) buffer(declared);
}

void ManifestParser::buffer(const Reader::Named& declared) {
    const Reader& reader = declared.reader;
    BufferSpec buffer;
    buffer.name = declared.member->key;
    buffer.place = declared.member->key_place;
    buffer.doc = reader.text("doc");
    buffer.element = reader.has("element") ? reader.text("element") : "float";
    buffer.grid = per(reader);
    buffer.count = count(reader, "count", buffer.grid ? kPerTexelCount : element_count(buffer.element));
    buffer.history = reader.boolean("history");
    buffer.indirect = reader.boolean("indirect");
    if (reader.has("clear")) {
        buffer.clear = reader.numbers("clear");
        check_words(buffer, reader.place("clear"));
    }
    manifest_.buffers.push_back(std::move(buffer));
}

void ManifestParser::check_words(const BufferSpec& buffer, const Place& place) {
    const std::size_t words = std::size_t(buffer.count.number) * std::size_t(components_of(buffer.element));
    if (has_fixed_count(buffer) && buffer.clear.size() > words)
        fault(place, "'clear' has " + std::to_string(buffer.clear.size()) + " words, more than the " +
                         std::to_string(words) + " of the buffer");
    const char kind = buffer.element.front();
    if (kind != 'u' && kind != 'i') return;
    const auto format = kind == 'u' ? gpu::TextureFormat::r32ui : gpu::TextureFormat::r32i;
    if (const std::string why = why_not_in_format(buffer.clear, format); !why.empty())
        fault(place, "'clear' " + why);
}

void ManifestParser::native(const Reader& document) {
    const auto section = document.object("native");
    if (!section) return;
    NativeSpec native;
    native.place = section->node().place;
    for (const auto& [member, reader] : section->named("uniforms"))
        native.uniforms.push_back({member->key, reader.text("type"), reader.text("doc"), member->key_place});
    for (const auto& [member, reader] : section->named("tables")) {
        NativeTableSpec table;
        table.name = member->key;
        table.place = member->key_place;
        table.element = reader.text("element");
        table.doc = reader.text("doc");
        const std::vector<double> sides = reader.numbers("count");
        if (!sides.empty()) table.width = int(sides[0]);
        if (sides.size() > 1) table.height = int(sides[1]);
        native.tables.push_back(std::move(table));
    }
    manifest_.native = std::move(native);
}

std::string why_not_in_format(const std::vector<double>& texel, gpu::TextureFormat format) {
    double low = 0, high = 1;
    const std::string name(gpu::texture_format_name(format));
    if (gpu::is_integer(format)) {
        low = gpu::is_signed_integer(format) ? -2147483648.0 : 0.0;
        high = gpu::is_signed_integer(format) ? 2147483647.0 : 4294967295.0;
    } else if (name.ends_with("16f")) {
        high = 65504;
        low = -high;
    } else if (name.ends_with("32f")) {
        high = 3.4028234663852886e38;
        low = -high;
    }
    for (const double value : texel) {
        if (gpu::is_integer(format) && value != std::floor(value))
            return "has " + format_number(value) + ", but integers need a whole number";
        if (value < low || value > high)
            return "has " + format_number(value) + ", but " + name + " holds " + format_number(low) + " to " +
                   format_number(high);
    }
    return {};
}

}  // namespace aftershade
