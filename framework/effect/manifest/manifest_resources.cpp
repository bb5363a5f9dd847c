// Inputs, outputs, textures, buffers and what native code fills.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "framework/core/units.h"
#include "framework/effect/manifest/manifest_parser.h"
#include "framework/image/role.h"

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

constexpr int kMaxTile = 4096;
constexpr double kMaxScale = 4;
constexpr int kMaxTableSide = 1024;
/// GL_MAX_SHADER_STORAGE_BLOCK_SIZE of llvmpipe, and the least of OpenGL 4.5.
constexpr std::int64_t kMaxBufferBytes = std::int64_t(128) << 20;
constexpr int kMaxPerTexel = 256;
constexpr int kMaxMips = 15;  // of 16384 texels a side
constexpr int kIndirectWords = 4;

const std::vector<std::string> kElements{"float", "int",   "uint",  "vec2", "vec4",
                                         "ivec2", "ivec4", "uvec2", "uvec4"};
const std::vector<std::string> kNativeTypes{"float", "int", "uint", "vec2", "vec3", "vec4"};
const std::vector<std::string> kTableElements{"float", "vec2", "vec4", "uint", "uvec2", "uvec4"};

int components_of(const std::string& element) {
    return std::isdigit(static_cast<unsigned char>(element.back())) ? element.back() - '0' : 1;
}

}  // namespace

std::int64_t ManifestParser::integer_in(const Node& node, const std::string& key, std::int64_t least,
                                        std::int64_t most) {
    if (node.kind != Node::Kind::integer) {
        fault(node.place, "'" + key + "' must be an integer, not " + std::string(kind_name(node.kind)));
        return least;
    }
    if (node.integer >= least && node.integer <= most) return node.integer;
    fault(node.place, "'" + key + "' must be from " + std::to_string(least) + " to " + std::to_string(most) +
                          ", not " + std::to_string(node.integer));
    return least;
}

std::vector<int> ManifestParser::integers_in(const Node& node, const std::string& key, std::size_t size,
                                             int least, int most) {
    std::vector<int> values(size, least);
    if (!node.is_array() || node.items.size() != size) {
        fault(node.place, "'" + key + "' holds " + std::to_string(size) + " integers");
        return values;
    }
    for (std::size_t i = 0; i < size; ++i) values[i] = int(integer_in(node.items[i], key, least, most));
    return values;
}

CountSpec ManifestParser::count(const Node& node, const std::string& key, const CountLimits& limits) {
    CountSpec count;
    if (node.is_string()) {
        count.param = node.string;
        count_by_param(node, key, limits);
    } else if (node.kind == Node::Kind::integer) {
        count.number = int(integer_in(node, key, limits.least, limits.most));
    } else {
        fault(node.place, "'" + key + "' must be an integer or the name of an int parameter, not " +
                              std::string(kind_name(node.kind)));
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
    else if (!spec->min || *spec->min < limits.least_of_param || !spec->max || *spec->max > limits.most)
        fault(node.place, names + "which must have a 'min' of at least " +
                              std::to_string(limits.least_of_param) + " and a 'max' of at most " +
                              std::to_string(limits.most));
}

GridSpec ManifestParser::grid(ObjectReader& reader, bool may_be_fixed) {
    GridSpec grid;
    const Node* scale = reader.any("scale");
    const Node* tile = reader.any("tile");
    const Node* size = may_be_fixed ? reader.any("size") : nullptr;
    if (int(scale != nullptr) + int(tile != nullptr) + int(size != nullptr) > 1)
        fault((size ? size : tile)->place, may_be_fixed
                                               ? "only one of 'scale', 'tile' and 'size' may be given"
                                               : "only one of 'scale' and 'tile' may be given");
    if (scale) {
        grid.scale = scale->is_number() ? scale->number : 0;
        if (grid.scale <= 0 || grid.scale > kMaxScale)
            fault(scale->place, "'scale' must be a number above 0 and at most 4");
    }
    if (tile) {
        grid.kind = GridSpec::Kind::tile;
        grid.tile = count(*tile, "tile", {2, kMaxTile, 1});
    }
    if (size) {
        grid.kind = GridSpec::Kind::size;
        const std::vector<int> sides = integers_in(*size, "size", 2, 1, kMaxSide);
        std::copy(sides.begin(), sides.end(), grid.size);
    }
    return grid;
}

/// "per": "pixel" or {"tile": n} or {"scale": x}.
std::optional<GridSpec> ManifestParser::per(ObjectReader& reader) {
    const Node* node = reader.any("per");
    if (!node) return std::nullopt;
    if (node->is_string() && node->string == "pixel") return GridSpec{};
    if (!node->is_object() || node->members.size() != 1) {
        fault(node->place, "'per' is \"pixel\", {\"tile\": 16} or {\"scale\": 0.5}");
        return GridSpec{};
    }
    ObjectReader options(*node, "'per'", diagnostics_);
    const GridSpec counted = grid(options, false);
    options.finish();
    return counted;
}

std::vector<double> ManifestParser::numbers(const Node& node, const std::string& key) {
    std::vector<double> values;
    if (node.is_number()) values.push_back(node.number);
    else if (node.is_array() && !node.items.empty() &&
             std::all_of(node.items.begin(), node.items.end(), [](const Node& n) { return n.is_number(); }))
        for (const Node& item : node.items) values.push_back(item.number);
    else fault(node.place, "'" + key + "' must be a number or an array of numbers");
    return values;
}

/// A value of every channel, or four of them.
std::vector<double> ManifestParser::texel(const Node& node, const std::string& key) {
    std::vector<double> values = numbers(node, key);
    if (!values.empty() && values.size() != 1 && values.size() != 4) {
        fault(node.place, "'" + key + "' is one number or four, not " + std::to_string(values.size()));
        values.resize(1);
    }
    return values;
}

std::string ManifestParser::role(ObjectReader& reader, const Node& node) {
    const auto name = reader.text("role", Presence::required);
    if (name && !find_role(*name))
        fault(node.find("role")->place, "'" + *name + "' is not a role" + did_you_mean(*name, role_names()));
    return name.value_or("");
}

void ManifestParser::inputs(const Node& section) {
    for (const Member& member : section.members) {
        identifier(member.key, member.key_place, "input");
        ObjectReader reader(member.value, "input '" + member.key + "'", diagnostics_);
        InputSpec input;
        input.name = member.key;
        input.place = member.key_place;
        input.role = role(reader, member.value);
        input.optional = reader.boolean("optional").value_or(false);
        input.history = reader.boolean("history").value_or(false);
        input.doc = reader.text("doc").value_or("");
        if (const auto frame = reader.integer("frame")) {
            const Place& place = member.value.find("frame")->place;
            input.frame = int(*frame == -1 || *frame == 1 ? *frame : 0);
            if (input.frame == 0) fault(place, "'frame' is -1 or 1: the capture before or after");
            if (!input.optional)
                fault(place, "an input of another frame must be 'optional': shots begin and end");
            if (input.history) fault(place, "an input has 'frame' or 'history', not both");
        }
        static const std::vector<std::string> sources{"capture"};
        input.from_capture = reader.choice("from", sources).has_value();
        if (input.from_capture && input.frame != 0)
            fault(member.value.find("from")->place,
                  "an input has 'frame' or 'from', not both: other frames are the capture's anyway");
        if (const Node* conditions = reader.object("when")) {
            if (!input.optional)
                fault(member.value.find("when")->place, "an input with 'when' must be 'optional'");
            add_conditions(*conditions, input.when);
        }
        reader.finish();
        manifest_.inputs.push_back(std::move(input));
    }
}

void ManifestParser::outputs(const Node& section) {
    for (const Member& member : section.members) {
        identifier(member.key, member.key_place, "output");
        ObjectReader reader(member.value, "output '" + member.key + "'", diagnostics_);
        OutputSpec output;
        output.name = member.key;
        output.place = member.key_place;
        output.role = role(reader, member.value);
        output.doc = reader.text("doc").value_or("");
        reader.finish();
        manifest_.outputs.push_back(std::move(output));
    }
}

void ManifestParser::textures(const Node& section) {
    for (const Member& member : section.members)
        if (is_new("texture", member)) texture(member);
}

void ManifestParser::texture(const Member& member) {
    identifier(member.key, member.key_place, "texture");
    ObjectReader reader(member.value, "texture '" + member.key + "'", diagnostics_);
    TextureSpec texture;
    texture.name = member.key;
    texture.place = member.key_place;
    texture.doc = reader.text("doc", Presence::required).value_or("");
    std::vector<std::string> formats;
    for (const auto name : gpu::texture_format_names()) formats.emplace_back(name);
    const auto format = reader.choice("format", formats, Presence::required);
    if (format) texture.format = *gpu::parse_texture_format(*format);
    texture.grid = grid(reader, true);
    if (const Node* layers = reader.any("layers"))
        texture.layers = int(integer_in(*layers, "layers", 1, kMaxLayers));
    mips(reader, texture);
    if (const Node* clear = reader.any("clear")) {
        texture.clear = texel(*clear, "clear");
        if (const std::string why = why_not_in_format(*texture.clear, texture.format); format && !why.empty())
            fault(clear->place, "'clear' " + why);
    }
    texture.history = reader.boolean("history").value_or(false);
    if (const Node* section = reader.object("when")) add_conditions(*section, texture.when);
    reader.finish();
    manifest_.textures.push_back(std::move(texture));
}

void ManifestParser::mips(ObjectReader& reader, TextureSpec& texture) {
    const Node* mips = reader.any("mips");
    if (!mips) return;
    if (mips->is_string() && mips->string == "auto") {
        texture.auto_mips = true;
        texture.mips = 0;
        if (gpu::is_integer(texture.format))
            fault(mips->place, "an integer texture has no automatic 'mips': integers have no mean");
    } else if (mips->kind == Node::Kind::integer) {
        texture.mips = int(integer_in(*mips, "mips", 1, kMaxMips));
        const int side = std::max(texture.grid.size[0], texture.grid.size[1]);
        if (texture.grid.kind == GridSpec::Kind::size && (side >> (texture.mips - 1)) == 0)
            fault(mips->place, "'mips' is " + std::to_string(texture.mips) + ", but " + std::to_string(side) +
                                   " texels a side have fewer levels");
    } else {
        fault(mips->place, "'mips' is \"auto\" or a number of levels");
    }
}

void ManifestParser::buffers(const Node& section) {
    for (const Member& member : section.members)
        if (is_new("buffer", member)) buffer(member);
}

void ManifestParser::buffer(const Member& member) {
    identifier(member.key, member.key_place, "buffer");
    ObjectReader reader(member.value, "buffer '" + member.key + "'", diagnostics_);
    BufferSpec buffer;
    buffer.name = member.key;
    buffer.place = member.key_place;
    buffer.doc = reader.text("doc", Presence::required).value_or("");
    buffer.element = reader.choice("element", kElements, Presence::required).value_or("float");
    buffer.grid = per(reader);
    const int most = buffer.grid ? kMaxPerTexel : int(kMaxBufferBytes / 4 / components_of(buffer.element));
    if (const Node* number = reader.any("count", buffer.grid ? Presence::optional : Presence::required))
        buffer.count = count(*number, "count", {1, most, 1});
    buffer.history = reader.boolean("history").value_or(false);
    buffer.indirect = reader.boolean("indirect").value_or(false);
    if (const Node* clear = reader.any("clear")) {
        buffer.clear = numbers(*clear, "clear");
        check_words(buffer, *clear);
    }
    reader.finish();
    const bool fixed = !buffer.grid && buffer.count.param.empty();
    if (buffer.indirect && (buffer.element != "uint" || !fixed || buffer.count.number < kIndirectWords))
        fault(buffer.place, "the indirect buffer '" + buffer.name +
                                "' must have 'element' uint and a fixed 'count' of at least 4");
    if (buffer.indirect && buffer.history)
        fault(buffer.place, "the indirect buffer '" + buffer.name + "' cannot have 'history'");
    manifest_.buffers.push_back(std::move(buffer));
}

void ManifestParser::check_words(const BufferSpec& buffer, const Node& node) {
    const bool fixed = !buffer.grid && buffer.count.param.empty();
    const std::size_t words = std::size_t(buffer.count.number) * std::size_t(components_of(buffer.element));
    if (fixed && buffer.clear.size() > words)
        fault(node.place, "'clear' has " + std::to_string(buffer.clear.size()) + " words, more than the " +
                              std::to_string(words) + " of the buffer");
    const char kind = buffer.element.front();
    if (kind != 'u' && kind != 'i') return;
    const auto format = kind == 'u' ? gpu::TextureFormat::r32ui : gpu::TextureFormat::r32i;
    if (const std::string why = why_not_in_format(buffer.clear, format); !why.empty())
        fault(node.place, "'clear' " + why);
}

void ManifestParser::native(const Node& section) {
    ObjectReader reader(section, "'native'", diagnostics_);
    manifest_.native.emplace();
    manifest_.native->place = section.place;
    if (const Node* uniforms = reader.object("uniforms"))
        for (const Member& member : uniforms->members) native_uniform(member);
    if (const Node* tables = reader.object("tables"))
        for (const Member& member : tables->members) native_table(member);
    reader.finish();
}

void ManifestParser::native_uniform(const Member& member) {
    identifier(member.key, member.key_place, "native uniform");
    ObjectReader reader(member.value, "native uniform '" + member.key + "'", diagnostics_);
    NativeUniformSpec uniform;
    uniform.name = member.key;
    uniform.place = member.key_place;
    uniform.type = reader.choice("type", kNativeTypes, Presence::required).value_or("float");
    uniform.doc = reader.text("doc", Presence::required).value_or("");
    reader.finish();
    manifest_.native->uniforms.push_back(std::move(uniform));
}

void ManifestParser::native_table(const Member& member) {
    identifier(member.key, member.key_place, "native table");
    ObjectReader reader(member.value, "native table '" + member.key + "'", diagnostics_);
    NativeTableSpec table;
    table.name = member.key;
    table.place = member.key_place;
    table.element = reader.choice("element", kTableElements, Presence::required).value_or("float");
    table.doc = reader.text("doc", Presence::required).value_or("");
    if (const Node* sides = reader.any("count", Presence::required)) {
        if (sides->is_array()) {
            const std::vector<int> both = integers_in(*sides, "count", 2, 1, kMaxTableSide);
            table.width = both[0];
            table.height = both[1];
        } else {
            table.width = int(integer_in(*sides, "count", 1, kMaxTableSide));
        }
    }
    reader.finish();
    manifest_.native->tables.push_back(std::move(table));
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
