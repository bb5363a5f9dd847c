// The passes of a manifest, and groups of them.
#include <utility>

#include "framework/base/text.h"
#include "framework/effect/manifest/manifest_blocks.h"

namespace aftershade {

using grammar::Block;
using grammar::choice;
using grammar::Form;
using grammar::integer;
using grammar::Key;
using grammar::optional;
using grammar::required;
using grammar::text;
using grammar::when;

namespace {

constexpr int kMaxLevel = 14;      // of 16384 texels a side
constexpr int kMaxGroups = 65535;  // GL_MAX_COMPUTE_WORK_GROUP_COUNT is at least this

const std::vector<std::string> kFilters{"nearest", "linear", "pixel"};

Form file_form(const std::string& key) {
    return text(
        {.fault = "'" + key + "' is empty: it names a shader's file", .min_length = 1, .type = "file"});
}

/// Of a texture's levels, or layers.
Form level_form(const std::string& key, int most) {
    const std::string fault =
        "'" + key + R"(' is an integer, "pass.index", "pass.index + 1" or "pass.index - 1")";
    return grammar::by_kind(
        {integer(0, most),
         text({.pattern = {R"(^pass\.index( *[-+] *[0-9]{1,2})?$)",
                           [](const std::string& turn) { return pass_offset(turn).has_value(); }},
               .fault = fault,
               .type = "`\"pass.index + 1\"`"})},
        fault);
}

/// A name, or an object of one name with what is said of it.
Form named_use(const Form& options, const std::string& fault, const std::string& shown) {
    return grammar::shown_as(
        grammar::by_kind({text(), grammar::map(options, {.min = 1, .max = 1, .count_fault = fault})}, fault),
        shown);
}

Form writes_form() {
    return grammar::list(
        named_use(grammar::object(write_block),
                  R"(a write is a name, or an object of one name with its place: {"pyramid": {"level": 1}})",
                  R"(name or `{"name": `[write](#write)`}`)"),
        {.min = 1});
}

Form accesses_form() {
    return grammar::shown_as(grammar::map(choice({"read", "write", "atomic"})),
                             "`read`, `write` or `atomic` by name");
}

/// As GLSL names macros.
bool is_define(const std::string& name) {
    const auto is_letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (name.empty() || is_digit(name[0]) || name.starts_with("GL_")) return false;
    for (std::size_t i = 0; i < name.size(); ++i)
        if ((!is_letter(name[i]) && !is_digit(name[i])) || (i > 0 && name[i] == '_' && name[i - 1] == '_'))
            return false;
    return true;
}

Form defines_form() {
    return grammar::map(
        grammar::by_kind({text(), integer()}, "a define is a string or an integer"),
        {.pattern = {"^(?!GL_)(?!.*__)[A-Za-z_][A-Za-z0-9_]*$", is_define},
         .fault = "'{}' cannot name a define: letters, 0-9 and _ only; GLSL keeps GL_... and __ for itself"});
}

Block instances_block() {
    return {
        .name = "instances",
        .doc = "Vertices and number of instances of a draw with a vertex shader.",
        .keys = {required("of", choice({"quads", "points"}), "A strip of 4 vertices, or a single vertex."),
                 optional("count", count_form(kInstanceCount),
                          "Number of instances; with `per`, per texel of that grid."),
                 optional("per", per_form(), "Count instances per texel of this grid."),
                 optional(
                     "indirect", text({.min_length = 1, .type = "name of a buffer"}),
                     "Alternative to `count` and `per`: a buffer with `indirect` that holds the number."),
                 optional("covers", grammar::boolean(),
                          "The instances cover the whole target, which nothing has to fill before.",
                          "false")},
        .rules = {
            grammar::at_least_one_of({"count", "per", "indirect"},
                                     "'instances' have no 'count', 'per' or 'indirect' buffer"),
            when({.key = "indirect",
                  .absent = {"count", "per"},
                  .fault = "'instances' are counted by their 'indirect' buffer or by 'count' and 'per', "
                           "not both"})}};
}

Block dispatch_block() {
    const Form groups = grammar::shown_as(
        grammar::list(integer(1, kMaxGroups), {.min = 3, .max = 3, .fault = "'groups' holds 3 integers"}),
        "[x, y, z], up to " + std::to_string(kMaxGroups));
    return {
        .name = "dispatch",
        .doc = "Number of work groups of a compute pass.",
        .keys = {optional("tile", count_form(kGroupTileCount),
                          "One work group per tile; the tile's side in texels."),
                 optional("over", text({.type = "name of a texture"}),
                          "The texture to cover; default: the working grid."),
                 optional("groups", groups, "A fixed number of work groups."),
                 optional("indirect", text({.min_length = 1, .type = "name of a buffer"}),
                          "A buffer with `indirect` that holds the number.")},
        .rules = {grammar::exactly_one_of({"tile", "groups", "indirect"}), grammar::needs("over", "tile")}};
}

/// Of passes that run a shader.
std::vector<Key> shader_keys() {
    const std::string bound = "'max_iterations' must be from 1 to " + std::to_string(kMaxIterations) +
                              ": llvmpipe silently ends the loops of one invocation after 65535; split the "
                              "work over a repeated pass";
    return {
        optional("shader", file_form("shader"),
                 "A file in the effect's folder, or in the module's folder for a module's pass; default: the "
                 "pass's name with `.frag`, or `.comp` for compute."),
        optional("reads", reads_form(),
                 "Default, also for `\"*\"`: [what the shaders name](#what-shaders-name)."),
        optional("images", accesses_form(),
                 "Access to level 0 of a texture as an image; atomics need r32ui or r32i."),
        optional("buffers", accesses_form(),
                 "Access to buffers; `{\"name.prev\": \"read\"}` reads the previous frame's."),
        optional("defines", grammar::shown_as(defines_form(), "text or int by name"),
                 "Preprocessor symbols."),
        optional("repeat", count_form(kRepeatCount),
                 "Run the pass this many times in a row; the shader has `pass.index` and `pass.count`."),
        optional("max_iterations", grammar::with_fault(integer(1, kMaxIterations), bound),
                 "Upper bound on the loop iterations of one invocation.")};
}

Block draw_kind() {
    constexpr const char* kNoInstances = "a 'vertex' shader needs 'instances' to place";
    std::vector<Key> keys = {optional(
        "writes", writes_form(),
        "Up to 8 outputs and textures of one size; default, also for `\"*\"`: what the shader names.")};
    for (Key& key : shader_keys()) keys.push_back(std::move(key));
    keys.push_back(optional("vertex", file_form("vertex"), "Vertex shader that places instances or tiles."));
    keys.push_back(optional("instances", grammar::object(instances_block()),
                            "Draw instances instead of the full screen."));
    keys.push_back(optional(
        "over", text({.fault = "'over' names no tile list", .min_length = 1, .type = "name of a tile list"}),
        "Confine the draw to this tile list."));
    keys.push_back(
        optional("blend", choice({"add", "min", "max"}),
                 "`add` needs a float format; an earlier pass must have written or cleared the target."));
    const auto check_vertex = [](const Node& node, const std::string&, Diagnostics& diagnostics) {
        const Node* vertex = node.find("vertex");
        if (vertex && !node.find("instances") && !node.find("over"))
            diagnostics.error(vertex->place, kNoInstances);
    };
    return {
        .name = "draw",
        .keys = std::move(keys),
        .rules = {
            grammar::at_most_one_of({"instances", "over"},
                                    "a draw has 'instances' or is 'over' a list of tiles, not both"),
            grammar::needs("instances", "vertex", "'instances' need a 'vertex' shader, which places them"),
            grammar::custom_rule(
                {.check = check_vertex, .schema = R"({"dependentSchemas": {"vertex": {"anyOf": [
                                                {"required": ["instances"]}, {"required": ["over"]}]}}})"})}};
}

Block compute_kind() {
    std::vector<Key> keys = shader_keys();
    keys.push_back(required("dispatch", grammar::object(dispatch_block()), "Number of work groups."));
    return {.name = "compute", .thing = "the compute pass", .keys = std::move(keys)};
}

Block clear_kind() {
    return {.name = "clear",
            .thing = "the clear pass",
            .keys = {required("writes", writes_form(), "Textures and buffers to clear."),
                     required("value", texel_form(), "Value to set.")}};
}

Block copy_kind() {
    return {.name = "copy",
            .thing = "the copy pass",
            .keys = {
                required("from", text({.min_length = 1, .type = "name, `name.prev`"}),
                         "Input or texture to copy, bit for bit."),
                required("to", text({.min_length = 1, .type = "name"}),
                         "Output or texture of the same size, format and levels to copy to. On software GL a "
                         "copy takes a third of the time of a draw.")}};
}

Block make_pass_block() {
    return {.name = "pass",
            .thing = "the pass",
            .doc = "One draw, compute dispatch, clear or copy.",
            .keys = {required("name", identifier_form("pass"), "Name in messages, taps and times."),
                     when_key("If they do not hold, the pass does not run.")},
            .selector = "kind",
            .kinds = {draw_kind(), compute_kind(), clear_kind(), copy_kind()},
            .default_kind = "draw",
            .definition = "pass"};
}

}  // namespace

std::optional<int> pass_offset(std::string_view text) {
    constexpr std::string_view kIndex = "pass.index";
    if (!text.starts_with(kIndex)) return std::nullopt;
    text.remove_prefix(kIndex.size());
    if (text.empty()) return 0;
    const auto skip_spaces = [&] {
        while (text.starts_with(' ')) text.remove_prefix(1);
    };
    skip_spaces();
    if (!text.starts_with('+') && !text.starts_with('-')) return std::nullopt;
    const int sign = text[0] == '-' ? -1 : 1;
    text.remove_prefix(1);
    skip_spaces();
    if (text.empty() || text.size() > 2) return std::nullopt;
    int offset = 0;
    for (const char digit : text) {
        if (digit < '0' || digit > '9') return std::nullopt;
        offset = 10 * offset + (digit - '0');
    }
    return sign * offset;
}

Form reads_form() {
    const Form filter =
        grammar::with_fault(choice(kFilters), "the filter of a read is 'nearest', 'linear' or 'pixel'");
    const Form options = grammar::by_kind({filter, grammar::object(read_block)},
                                          "the filter of a read is 'nearest', 'linear' or 'pixel'");
    return grammar::list(named_use(
        options, "a read is a name, or an object of one name with its filter: {\"color\": \"linear\"}",
        R"(name, `name.prev`, `{"name": "linear"}` or `{"name": `[read](#read)`}`)"));
}

const Block& read_block() {
    static const Block block{
        .name = "read",
        .thing = "the read of '{}'",
        .doc = "How a pass samples an image.",
        .keys = {optional("filter", choice(kFilters),
                          "Filter between texels; `pixel`: no sampler, but the texel at the pixel itself "
                          "([fused passes](#fused-passes)).",
                          "\"nearest\""),
                 optional("outside", choice({"clamp", "weight_zero"}),
                          "Value beyond the edges: the edge texel, or 0, which darkens a filter there.",
                          "\"clamp\""),
                 optional("level", level_form("level", kMaxLevel), "Bind this level as level 0."),
                 when_key("If they do not hold, there is no sampler.")}};
    return block;
}

const Block& write_block() {
    static const Block block{
        .name = "write",
        .thing = "the write of '{}'",
        .doc = "Where in a texture a pass writes.",
        .keys = {optional("level", level_form("level", kMaxLevel), "Level to write.", "0"),
                 optional("layer", level_form("layer", kMaxLayers - 1), "Layer to write.", "0"),
                 when_key("If they do not hold, there is no target.")}};
    return block;
}

const Block& pass_block() {
    static const Block block = make_pass_block();
    return block;
}

}  // namespace aftershade
