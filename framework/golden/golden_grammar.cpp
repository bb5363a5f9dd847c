#include "framework/golden/golden_grammar.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "framework/capture/document_forms.h"
#include "framework/compare/compare_area.h"
#include "framework/compare/compare_files.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"
#include "framework/golden/golden_store.h"
#include "framework/image/image_forms.h"

namespace aftershade {

using grammar::Block;
using grammar::Form;
using grammar::Key;
using grammar::optional;
using grammar::required;
using grammar::text;

namespace {

Form texts() {
    return grammar::list(text());
}

/// What a verdict of `word` allows. Only `fail` has defaults: without a `warn` key nothing warns. Measures of
/// how a picture looks are of whole layers.
void add_level(const std::string& word, const std::string& many, const Tolerance* usual, bool of_layers,
               std::vector<Key>& keys) {
    const Form share = grammar::number({.min = 0, .max = 1});
    const auto number = [&](double Tolerance::*member) { return usual ? format_number(usual->*member) : ""; };
    const auto add = [&](const std::string& name, const Form& form, const std::string& doc,
                         const std::string& default_text = "") {
        keys.push_back(optional(name, form, doc, default_text));
    };
    add(word, grammar::number({.min = 0}), "Largest difference of a channel at which a pixel passes.",
        number(&Tolerance::limit));
    add(word + "_relative", grammar::number({.min = 0}),
        "A difference counts where it also exceeds this part of its value; 0.001 is a half's last digit.",
        number(&Tolerance::relative));
    add(word + "_ulp", grammar::number({.min = 0}),
        "A difference counts, also for `hard_" + word +
            "`, where it exceeds this many units in the last place of the stored type at its value.",
        number(&Tolerance::ulp));
    add(word + "_percent", grammar::number({.min = 0, .max = 100}),
        "Percentage of pixels that may exceed it.", number(&Tolerance::percent));
    add("hard_" + word, grammar::number({.min = 0}), "Largest difference of any pixel; default: no limit.");
    add("allow_" + many, grammar::integer(0), "Number of pixels that may exceed it, for any percentage.",
        usual ? std::to_string(usual->allowed) : "");
    if (!of_layers) return;
    add(word + "_flip", share, "Largest mean FLIP.");
    add(word + "_ssim", share, "Smallest SSIM.");
}

Block layer_block() {
    Block block{.name = "layer", .thing = "the tolerance of the layer '{}'", .doc = "Limits of one layer."};
    add_level("fail", "failures", nullptr, true, block.keys);
    add_level("warn", "warnings", nullptr, true, block.keys);
    return block;
}

/// Objects are read, and refused, by whoever reads the area.
Form objects() {
    const Form one =
        grammar::custom({.type = "[entry](params.md#objects)",
                         .schema = schema::object_key().dump(),
                         .check = [](const Node& node, const grammar::Spot& spot, Diagnostics& diagnostics) {
                             if (node.kind == Node::Kind::array)
                                 diagnostics.error(node.place, "'" + spot.key + "' must name an object");
                         }});
    return grammar::any_of({one, grammar::list(one, {.min = 1})});
}

/// Where something else holds.
std::vector<Key> place_keys() {
    const Form corner = grammar::integer(-kMaxAreaSide_px, kMaxAreaSide_px);
    return {optional("rectangle", grammar::list(corner, {.min = 4, .max = 4}),
                     "x, y, width and height in px of the display window."),
            optional("mask", text({.min_length = 1, .type = "path from the document's folder"}),
                     "Picture over the display window: the pixels above a half."),
            optional("channel", text({.min_length = 1}), "Channel of the mask; default: its only one."),
            optional("object", objects(),
                     "Objects of the case's capture: the pixels that they cover, even in part.")};
}

std::vector<grammar::Rule> place_rules() {
    return {grammar::exactly_one_of({"rectangle", "mask", "object"},
                                    "an area has one of 'rectangle', 'mask' and 'object'"),
            grammar::needs("channel", "mask", "'channel' needs a 'mask'")};
}

Block ignore_block() {
    return {.name = "ignore",
            .thing = "the area",
            .doc = "Pixels that are left out.",
            .keys = place_keys(),
            .rules = place_rules()};
}

Block area_block() {
    Block block{.name = "area",
                .thing = "the area",
                .doc = "Pixels with limits of their own.",
                .keys = place_keys(),
                .rules = place_rules()};
    const Tolerance usual;
    add_level("fail", "failures", &usual, false, block.keys);
    add_level("warn", "warnings", nullptr, false, block.keys);
    return block;
}

Block tolerance_block() {
    const Tolerance usual;
    Block block{.name = "tolerance",
                .thing = "the tolerance",
                .doc = "Limits, as the options of `compare`.",
                .rules = {grammar::at_most_one_of({"forgive_shift", "forgive_blur"})}};
    add_level("fail", "failures", &usual, true, block.keys);
    add_level("warn", "warnings", nullptr, true, block.keys);
    for (Key key :
         {optional("nan_equal", grammar::boolean(), "Whether NaN in both images counts as equal.", "false"),
          optional("forgive_shift", grammar::integer(0, Forgive::kMaxShift_px), "Shift that is forgiven, px.",
                   "0"),
          optional("forgive_blur", grammar::number({.min = 0, .max = Forgive::kMaxBlur_px}),
                   "Blur that is forgiven: standard deviation, px.", "0"),
          optional("layers", grammar::map(grammar::object(layer_block()), {.by = "layer"}),
                   "Limits of layers, by names such as `RGB` and `Z`: keys that replace those above."),
          optional("ignore", grammar::list(grammar::object(ignore_block())), "Pixels to leave out."),
          optional("areas", grammar::list(grammar::object(area_block())),
                   "Pixels with limits of their own; where areas overlap, the first counts.")})
        block.keys.push_back(std::move(key));
    return block;
}

/// "step.texture": one dot, and neither the '/' nor the '=' that a tap's file has on the command line.
bool is_tap(const std::string& text) {
    return std::count(text.begin(), text.end(), '.') == 1 && text.find_first_of("/=") == std::string::npos;
}

bool is_day(const std::string& text) {
    using namespace std::chrono;
    int year = 0;
    unsigned month = 0, day = 0;
    return std::sscanf(text.c_str(), "%4d-%2u-%2u", &year, &month, &day) == 3 && year >= 0 &&
           fmt::format("{:04}-{:02}-{:02}", year, month, day) == text &&
           year_month_day(std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)).ok();
}

Block quarantine_block() {
    const Form date = text({.pattern = {"^[0-9]{4}-[0-9]{2}-[0-9]{2}$", is_day},
                            .fault = "'{}' is not a day such as 2027-01-31",
                            .type = "day such as \"2027-01-31\""});
    return {.name = "quarantine",
            .thing = "the quarantine",
            .doc = "A failure that is known.",
            .keys = {required("until", date, "Last day, UTC. From the next day on, the case fails."),
                     required("reason", text({.min_length = 1}), "Why, for the report.")}};
}

/// What each case has, wherever it stands.
std::vector<Key> common_keys() {
    const Form range = frame_range_form("'{}' is not a range of frames");
    const Form steps = grammar::list(grammar::custom({.type = "[steps of a look](looks.md)"}));
    const Form tap = text({.pattern = {R"(^[^./=]*\.[^./=]*$)", is_tap},
                           .fault = "'{}' is not 'step.texture'",
                           .type = "`step.texture`"});
    return {
        required("capture", text(), "Capture, as for `run`: capture.json, EXR file, pattern or folder."),
        optional("frames", range, "Default: the capture's. Effects with history need the preceding frames."),
        optional("steps", steps, "Steps, instead of a look's file."),
        optional("set", texts(), "Values, as for `run --set`: `step.param=value`."),
        optional("taps", grammar::list(tap), "Textures to compare, an image each."),
        optional("outputs", grammar::list(role_form()), "Roles to compare, an image each.", R"(["color"])"),
        optional("tolerance", grammar::object(golden_tolerance_block()), "How far the images may differ."),
        optional("tags", texts(), "Words for `--filter`; none may be another case's name."),
        optional("skip", text({.fault = "'skip' says why", .min_length = 1}),
                 "Reason for not running the case."),
        optional("quarantine", grammar::object(quarantine_block()),
                 "Until when a failure of the case's images is a warning only."),
        optional("optional", grammar::boolean(),
                 "Whether the case is skipped where its capture is absent; else it fails.", "false")};
}

Block case_block() {
    const Form name =
        text({.pattern = {"^[A-Za-z0-9_][A-Za-z0-9_-]*$", is_case_name},
              .fault = "a case's name begins its files' names: letters, digits, '_' and '-', not '{}'"});
    Block block{.name = "case",
                .thing = "the case",
                .doc = "A look over a capture.",
                .keys = {required("name", name, "Prefix of the images' names: letters, digits, `_`, `-`."),
                         optional("look", text(), "File of the look.")},
                .rules = {grammar::exactly_one_of({"look", "steps"},
                                                  "a case has a 'look' (a file) or 'steps', one of both")}};
    for (Key& key : common_keys()) block.keys.push_back(std::move(key));
    return block;
}

}  // namespace

bool is_case_name(const std::string& name) {
    const auto fits = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-'); };
    return !name.empty() && name.front() != '-' && std::all_of(name.begin(), name.end(), fits);
}

const Block& golden_tolerance_block() {
    static const Block block = tolerance_block();
    return block;
}

const Block& golden_suite_block() {
    static const Block block{
        .name = "suite",
        .thing = "the suite",
        .doc = "The document.",
        .keys = {optional("goldens", text(), "Folder of the approved images, used by this suite alone.",
                          R"("goldens")"),
                 optional("store",
                          text({.pattern = {kStorePattern, is_store},
                                .fault = "'store' is neither a folder, a URL of http or https without user, "
                                         "password and query, nor rclone:REMOTE:PATH with a remote of your "
                                         "rclone.conf (passwords belong into ~/.netrc or rclone.conf)",
                                .type = "folder, URL or `rclone:REMOTE:PATH`"}),
                          "[Where the approved images lie](#stores); default: in the tree alone."),
                 optional("effect_paths", texts(),
                          "Folders of effects, searched before the shipped effects."),
                 optional("cases", grammar::list(grammar::object(case_block())),
                          "Cases to render and compare."),
                 optional("cases_of_effects", grammar::boolean(),
                          "Whether to include `<id>/cases/*.json` of every effect in `effect_paths`, or of "
                          "the shipped effects.",
                          "false")},
        .is_document = true};
    return block;
}

const Block& effect_case_block() {
    static const Block block = [] {
        Block result{.name = "case",
                     .thing = "the case",
                     .doc = "A case of an effect.",
                     .keys = common_keys(),
                     .is_document = true};
        for (Key& key : result.keys)
            for (const char* name : {"frames", "steps", "outputs", "tolerance"})
                if (key.name == name) key.required = true;
        return result;
    }();
    return block;
}

}  // namespace aftershade
