// Textures, buffers and tile lists of a manifest.
#include "framework/effect/manifest/manifest_blocks.h"

namespace aftershade {

using grammar::Block;
using grammar::boolean;
using grammar::Form;
using grammar::integer;
using grammar::optional;
using grammar::required;
using grammar::Rule;
using grammar::text;
using grammar::when;

namespace {

constexpr int kMaxMips = 15;         // of 16384 texels a side
constexpr int kMaxListedTile = 256;  // 16 of them are a work group's, whose tile is at most 4096
constexpr int kIndirectWords = 4;

const std::vector<std::string>& buffer_elements() {
    static const std::vector<std::string> elements = {"float", "int",   "uint",  "vec2", "vec4",
                                                      "ivec2", "ivec4", "uvec2", "uvec4"};
    return elements;
}

Form texture_format_form() {
    std::vector<std::string> names;
    for (const auto name : gpu::texture_format_names()) names.emplace_back(name);
    return grammar::choice(std::move(names));
}

Form mips_form() {
    constexpr const char* kFault = "'mips' is \"auto\" or a number of levels";
    return grammar::by_kind(
        {grammar::with_fault(grammar::constant("\"auto\""), kFault), integer(1, kMaxMips)}, kFault);
}

constexpr const char* kSizeFault = "'size' holds 2 integers or formulas";

Form side_form() {
    return grammar::by_kind({integer(1, kMaxSide), text({.min_length = 1, .type = "formula"})}, kSizeFault);
}

Block make_texture_block() {
    return {
        .name = "texture",
        .thing = "texture '{}'",
        .doc = "An image between passes.",
        .keys =
            {required("format", texture_format_form(), "Format of a texel."),
             required("doc", text(), "One sentence, with the unit."),
             optional("scale", grid_scale_form(), "Size relative to the working grid, rounded up.", "1"),
             optional(
                 "room",
                 grammar::shown_as(grammar::list(grammar::number({.min = 0, .max = 1}),
                                                 {.min = 2, .max = 2, .fault = "'room' holds 2 numbers"}),
                                   "[x, y], each from 0 to 1"),
                 "Further texels to the right of those and below them, in their width and height: with "
                 "[0, 0.5], levels of a picture fit below it. They begin at the next multiple of " +
                     std::to_string(kRoomTexels) +
                     ", so that a tile whose side divides that does not lie on both sides."),
             optional("tile", count_form(kTileCount), "One texel per tile; the tile's side in px."),
             optional(
                 "size",
                 grammar::shown_as(grammar::list(side_form(), {.min = 2, .max = 2, .fault = kSizeFault}),
                                   "[width, height], up to " + std::to_string(kMaxSide)),
                 "Size in texels, independent of the working grid; or formulas of it: "
                 "`[\"floor(width / 4)\", \"max(height / 4, 1)\"]`, also of parameters' numbers. The shader "
                 "of a pass that writes such a texture has `out_<name>_size`."),
             optional("layers", integer(1, kMaxLayers),
                      "Number of layers; more than one make an array texture.", "1"),
             optional("mips", mips_form(),
                      "Number of levels, which passes write one by one; `\"auto\"`: the host fills "
                      "levels 1 and up after each pass that writes level 0.",
                      "1"),
             optional("clear", texel_form(),
                      "Value at the beginning of each frame; whole for integer formats, and within the "
                      "format's range."),
             optional("history", boolean(),
                      "Keeps the texture for the next frame, where `name.prev` reads it; zero if there "
                      "was none (`frame.history_valid`).",
                      "false"),
             optional("partial", boolean(),
                      "No pass reads a texel that none has drawn in this frame, so the host fills nothing; "
                      "for integer formats, without `clear` and `history`.",
                      "false"),
             when_key("If they do not hold, every read and write of it is absent.")},
        .rules = {grammar::at_most_one_of({"scale", "tile", "size"}),
                  grammar::at_most_one_of({"room", "tile"}), grammar::at_most_one_of({"room", "size"})}};
}

/// How many elements fit into a buffer, by the type that they have.
std::vector<Rule> element_count_rules() {
    std::vector<Rule> rules;
    for (const std::string& element : buffer_elements())
        if (components_of(element) > 1)
            rules.push_back(when({.key = "element",
                                  .value = "\"" + element + "\"",
                                  .narrowed = {{"count", count_form(element_count(element))}}}));
    return rules;
}

Block make_buffer_block() {
    Block block{
        .name = "buffer",
        .thing = "buffer '{}'",
        .doc = "An array in GPU memory.",
        .keys = {required("element", grammar::choice(buffer_elements()), "Type of an element."),
                 required("doc", text(), "One sentence."),
                 optional("count", count_form(element_count("float")),
                          "Number of elements, at most 128 MiB in all; with `per`, elements per texel of "
                          "that grid (default: 1)."),
                 optional("per", per_form(), "Count elements per texel of this grid."),
                 optional("clear",
                          grammar::any_of({grammar::number(), grammar::list(grammar::number(), {.min = 1})},
                                          "'clear' must be a number or an array of numbers"),
                          "The first words at the beginning of each frame; the rest is 0. Without it the "
                          "content is undefined until a pass writes it."),
                 optional("history", boolean(), "As for textures.", "false"),
                 optional("indirect", boolean(),
                          "Holds the arguments of a draw {vertices, instances, first, base} or a dispatch "
                          "{x, y, z}; needs `uint` and a fixed `count` of at least 4.",
                          "false")},
        .rules = {
            grammar::at_least_one_of({"count", "per"}),
            when({.key = "per", .narrowed = {{"count", count_form(kPerTexelCount)}}}),
            when(
                {.key = "indirect",
                 .value = "true",
                 .required = {"count"},
                 .absent = {"per"},
                 .narrowed = {{"element", grammar::constant("\"uint\"")}, {"count", integer(kIndirectWords)}},
                 .fault = "the indirect {} must have 'element' uint and a fixed 'count' of at least 4"}),
            when({.key = "indirect",
                  .value = "true",
                  .narrowed = {{"history", grammar::constant("false")}},
                  .fault = "the indirect {} cannot have 'history'"})}};
    for (Rule& rule : element_count_rules()) block.rules.push_back(std::move(rule));
    return block;
}

Block make_tile_list_block() {
    return {
        .name = "tiles",
        .thing = "tile list '{}'",
        .doc = "A list of tiles that confines draws.",
        .keys = {required("doc", text(), "One sentence."),
                 optional("of", channel_form(),
                          "Channel of a texture with a `tile`; lists the tiles whose texel is above 0. If "
                          "that texture is absent, so is the list."),
                 optional(
                     "predicate",
                     text(
                         {.fault = "'predicate' is empty: it names a file", .min_length = 1, .type = "file"}),
                     "Alternative to `of`: a file of the effect's folder, without `#version`, that defines "
                     "`bool NAME(ivec2 tile)` with the list's name. Several lists may share a file."),
                 optional("tile", integer(2, kMaxListedTile),
                          "With a predicate: a tile's side in texels of `on`."),
                 optional("on", text({.type = "name of a texture"}),
                          "With a predicate: the tiles divide this texture, which has a `scale`; default: "
                          "the working grid."),
                 optional("reads", reads_form(), "With a predicate: its reads, as in passes."),
                 when_key("If they do not hold, the list and the passes over it are absent.")},
        .rules = {grammar::exactly_one_of({"of", "predicate"},
                                          "{} is 'of' a texture's channel or has a 'predicate', one of the "
                                          "two"),
                  when({.key = "of", .absent = {"tile", "on", "reads"}}),
                  when({.key = "predicate", .required = {"tile"}})}};
}

}  // namespace

const Block& texture_block() {
    static const Block block = make_texture_block();
    return block;
}

const Block& buffer_block() {
    static const Block block = make_buffer_block();
    return block;
}

const Block& tile_list_block() {
    static const Block block = make_tile_list_block();
    return block;
}

}  // namespace aftershade
