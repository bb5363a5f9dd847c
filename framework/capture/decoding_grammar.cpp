// How the stored channels of a role become its image.
#include <algorithm>
#include <map>
#include <utility>

#include "framework/base/text.h"
#include "framework/capture/capture_grammar.h"
#include "framework/image/image_forms.h"

namespace aftershade {

using grammar::Block;
using grammar::boolean;
using grammar::choice;
using grammar::Form;
using grammar::Key;
using grammar::list;
using grammar::number;
using grammar::optional;
using grammar::text;

namespace {

constexpr const char* kChannelsDoc =
    "Channel names in the role's order. `{layer}.` is the layer's name, `a|b` are alternatives, `*` is any "
    "text, a final `?` marks an optional channel. Without an alpha channel, a colour's alpha is 1.";
constexpr const char* kSamplingDoc =
    "mean: the average of a pixel's samples, [repaired at edges](captures.md#averages-of-samples).";
constexpr const char* kSumDoc = "Lists of channels to add.";
constexpr const char* kElseDoc =
    "Other decodings for files without these channels, best first; each has the keys of this one but else.";
constexpr const char* kComponentDoc = "Channel of one component.";

Key length(const char* name, const char* doc) {
    ParamSpec spec;
    spec.name = name;
    spec.unit = "m";
    spec.min = 0;
    return optional(name, grammar::literal(spec), doc);
}

std::vector<Key> distance_keys() {
    return {
        optional("encoding", choice(depth_encoding_names()),
                 "inverse: 1 / distance; normalized: linear from near to far.", R"("linear")"),
        optional("reversed", boolean(), "1 is near, 0 is far; of z_buffer and normalized.", "false"),
        optional(
            "kind", choice({"planar", "radial"}),
            "Distance along the camera's axis, or from its position (needs focal_length and sensor_width).",
            R"("planar")"),
        length("near", "For z_buffer and normalized; default: the camera's."),
        length("far", "For z_buffer and normalized; default: the camera's."),
        length("offset", "Added to the planar depth: where a depth begins that counts from the near plane."),
        optional("scale", number(), "Metres per stored unit.", "1"),
        optional("no_hit", number(), "Stored values at or above this mean no hit."),
        optional("no_hit_stored", number(), "Value that the producer writes for no hit; default: no_hit."),
        optional("zero_is_no_hit", boolean(), "Whether a stored 0 means no hit.", "false")};
}

Key delta_key(const ChannelRole& role) {
    const auto& names = velocity_delta_names();
    const std::vector<std::string> previous(names.begin(), names.begin() + 2),
        next(names.begin() + 2, names.end());
    const std::string fault =
        "role '" + role.name +
        "' cannot be decoded from '{}': 'next' vectors fill velocity_next and no other role";
    const auto& words = role.to_next ? next : previous;
    return optional("delta", choice(words, {role.to_next ? previous : next, fault}),
                    "Which two frames are subtracted.", json_string(words.front()));
}

std::vector<Key> motion_keys(const ChannelRole& role) {
    const Form scale = grammar::any_of({number(), list(number(), {.min = 2, .max = 2})},
                                       "'scale' of a velocity is a number, or one for x and one for y");
    return {delta_key(role),
            optional("unit", choice(velocity_unit_names()),
                     "px; uv: 1 is the image's side; ndc: 2 is the image's side.", R"("px")"),
            optional("y_axis", choice({"up", "down"}), "Direction in which y grows.", R"("down")"),
            optional("bias", number(), "Stored value that means no motion.", "0"),
            optional("scale", scale, "Factor, or one each for x and y.", "1"),
            optional("premultiplied", boolean(), "Whether the vectors are multiplied by alpha.", "false"),
            optional("no_motion_above", number(), "A stored x above this means no motion data."),
            optional("no_motion_below", number(), "A stored x below this means no motion data."),
            optional("shutter_frames", number({.above = 0}), "Number of frames that a vector spans.", "1")};
}

std::vector<Key> irradiance_keys() {
    const Form aov = text({.pattern = aov_pattern(), .fault = "'{}' is not an aov:NAME"});
    return {optional("plus", list(aov),
                     "Images (aov:NAME) to add, of those that the capture has: light in files of its own."),
            optional("times_albedo", boolean(),
                     "Whether the sum is light that the surface reflects; it is then "
                     "[divided by the role albedo](captures.md#light-divided-by-the-albedo).",
                     "false"),
            optional("albedo_floor", number({.above = 0}),
                     "Least albedo to divide by; pixels with less are counted.", "0.01"),
            optional("scale", number(), "Factor of the light: 0.31831 where it is not over pi.", "1")};
}

/// What roles of its kind have beside the names of channels.
std::vector<Key> keys_of_kind(const ChannelRole& role) {
    if (role.has_optional_alpha())
        return {optional("luminance", text(), "Y channel of luminance-chroma files.")};
    std::vector<Key> keys;
    if (role.kind == RoleKind::distance) keys = distance_keys();
    if (role.kind == RoleKind::motion) keys = motion_keys(role);
    if (role.name == kIrradianceRole) keys = irradiance_keys();
    if (can_be_mean(role))
        keys.push_back(optional("sampling", choice({"point", "mean"}), kSamplingDoc, R"("point")"));
    return keys;
}

/// Else every value would be one and the same.
void check_scale(const Node& node, const std::string& thing, Diagnostics& diagnostics) {
    const Node* const scale = node.find("scale");
    const auto is_zero = [](const Node& at) { return at.is_number() && at.number == 0; };
    if (scale && (is_zero(*scale) || std::ranges::any_of(scale->items, is_zero)))
        diagnostics.error(scale->place, thing + " has a 'scale' of 0, which makes every value 0");
}

/// Only what is stored from 0 to 1 can count from the other end.
void check_reversed(const Node& node, const std::string& thing, Diagnostics& diagnostics) {
    const Node *const reversed = node.find("reversed"), *const encoding = node.find("encoding");
    if (!reversed || !reversed->boolean ||
        (encoding && (encoding->string == "z_buffer" || encoding->string == "normalized")))
        return;
    diagnostics.error(reversed->place,
                      thing + " is 'reversed', which needs the 'encoding' z_buffer or normalized");
}

grammar::Rule scale_rule() {
    return grammar::custom_rule(
        {.check = check_scale, .schema = R"({"properties": {"scale": {"not": {"anyOf": [{"const": 0},
             {"type": "array", "contains": {"const": 0}}]}}}})"});
}

std::vector<grammar::Rule> rules_of_kind(RoleKind kind) {
    std::vector<grammar::Rule> rules;
    if (kind == RoleKind::distance || kind == RoleKind::motion) rules.push_back(scale_rule());
    if (kind == RoleKind::distance)
        rules.push_back(grammar::custom_rule(
            {.check = check_reversed,
             .schema = R"({"if": {"required": ["reversed"], "properties": {"reversed": {"const": true}}},
                 "then": {"required": ["encoding"],
                          "properties": {"encoding": {"enum": ["z_buffer", "normalized"]}}}})"}));
    return rules;
}

/// Nothing is divided by a floor alone.
void check_floor(const Node& node, const std::string& thing, Diagnostics& diagnostics) {
    const Node *const floor = node.find("albedo_floor"), *const times = node.find("times_albedo");
    if (floor && (!times || !times->boolean))
        diagnostics.error(floor->place, thing + " has an 'albedo_floor', which needs 'times_albedo': true");
}

std::vector<grammar::Rule> rules_of_irradiance() {
    return {scale_rule(),
            grammar::custom_rule({.check = check_floor, .schema = R"({"if": {"required": ["albedo_floor"]},
             "then": {"required": ["times_albedo"], "properties": {"times_albedo": {"const": true}}}})"})};
}

void append(std::vector<Key>& keys, std::vector<Key> more) {
    keys.insert(keys.end(), more.begin(), more.end());
}

Block make_decoding(const ChannelRole& role) {
    const bool is_other = role.kind == RoleKind::other;
    const std::string who = is_other ? "an image that is passed through" : "role '" + role.name + "'";
    const std::string count = who + " has " + std::to_string(role.channels) + " channels, not {}";
    const int least = role.channels - (role.has_optional_alpha() ? 1 : 0);
    const Form names = list(text(), {.min = least, .max = role.channels, .fault = count});
    Block block{.name = "",
                .thing = "the decoding of '{}'",
                .doc = role.meaning,
                .keys = {optional("channels", names, kChannelsDoc),
                         optional("sum", list(names, {.min = 1}), kSumDoc)},
                .type = "object"};
    std::vector<std::string> components, ways = {"channels", "sum"};
    for (const std::string& native : role.native_channels) {
        components.push_back(component_key(native));
        block.keys.push_back(optional(components.back(), text(), kComponentDoc));
    }
    if (role.has_optional_alpha()) {
        block.rules.push_back(grammar::needs(components.back(), components.front()));
        components.pop_back();
    }
    ways.push_back(components.front());
    block.rules.push_back(grammar::together(components, count));
    block.rules.push_back(
        grammar::at_least_one_of(ways, who + " needs 'channels', or 'sum' with lists of channels"));
    append(block.keys, keys_of_kind(role));
    for (grammar::Rule& rule : rules_of_kind(role.kind)) block.rules.push_back(std::move(rule));
    if (role.name != kIrradianceRole) return block;
    for (grammar::Rule& rule : rules_of_irradiance()) block.rules.push_back(std::move(rule));
    Block other = block;
    other.thing = "a decoding in 'else'";
    block.keys.push_back(optional("else", list(grammar::object(std::move(other))), kElseDoc));
    return block;
}

Block make_table() {
    Block block{.name = "decoding",
                .keys = {optional("channels", list(text()), kChannelsDoc),
                         optional("x`, `y`, `r`, `z`, `...", text(), kComponentDoc),
                         optional("sum", list(list(text())), kSumDoc)}};
    for (Key& key : block.keys) key.of = "all";
    for (const ChannelRole& role : channel_roles())
        for (Key key : keys_of_kind(role)) {
            key.of = role.name;
            block.keys.push_back(std::move(key));
        }
    const Form others = list(grammar::object(Block{.name = "", .type = "decoding"}));
    block.keys.push_back(optional("else", others, kElseDoc));
    block.keys.back().of = kIrradianceRole;
    return block;
}

}  // namespace

bool can_be_mean(const ChannelRole& role) {
    return role.kind == RoleKind::distance || role.kind == RoleKind::motion ||
           role.kind == RoleKind::direction || role.kind == RoleKind::place;
}

std::string component_key(const std::string& native_channel) {
    return lower_case(native_channel.substr(native_channel.size() - 1));
}

const std::vector<std::string>& velocity_delta_names() {
    static const std::vector<std::string> names = {"cur-prev", "prev-cur", "next-cur", "cur-next"};
    return names;
}

const std::vector<std::string>& velocity_unit_names() {
    static const std::vector<std::string> names = {"px", "uv", "ndc"};
    return names;
}

const std::vector<std::string>& depth_encoding_names() {
    static const std::vector<std::string> names = {"linear", "inverse", "z_buffer", "normalized"};
    return names;
}

const Block& decoding_block(const std::string& role) {
    static const std::map<std::string, Block> blocks = [] {
        std::map<std::string, Block> made;
        for (const ChannelRole& one : channel_roles()) made.emplace(one.name, make_decoding(one));
        made.emplace("", make_decoding(*find_role("aov:name")));
        return made;
    }();
    const auto found = blocks.find(role);
    return found == blocks.end() ? blocks.at("") : found->second;
}

const Block& decoding_table() {
    static const Block block = make_table();
    return block;
}

Form decodings() {
    Block block{.name = "",
                .unknown_key = "'{}' is not a role",
                .type = "[decoding](captures.md#how-a-role-is-decoded) by role"};
    for (const ChannelRole& role : channel_roles())
        block.keys.push_back(optional(role.name, grammar::object(decoding_block(role.name)), role.meaning));
    block.others = {{aov_pattern(), grammar::object(decoding_block(""))}};
    return grammar::object(std::move(block));
}

}  // namespace aftershade
