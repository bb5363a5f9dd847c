#include "framework/batch/golden_case.h"

#include <algorithm>

#include "framework/core/text.h"
#include "framework/core/units.h"
#include "framework/image/frame_range.h"
#include "framework/image/role.h"
#include "framework/pipeline/look.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

using Presence = ObjectReader::Presence;

/// The numbers of `fail` or of `warn`; whether any was there.
bool read_level(ObjectReader& reader, const std::string& word, const std::string& many, Tolerance& level,
                std::optional<double>& flip, std::optional<double>& ssim) {
    bool any = false;
    const auto read = [&](const std::string& key, auto& target) {
        if (const auto value = reader.number(key)) target = *value, any = true;
    };
    read(word, level.limit);
    read(word + "_percent", level.percent);
    read("hard_" + word, level.hard);
    if (const auto allowed = reader.integer("allow_" + many))
        level.allowed = std::uint64_t(*allowed < 0 ? 0 : *allowed), any = true;
    if (const auto value = reader.number(word + "_flip")) flip = *value;
    if (const auto value = reader.number(word + "_ssim")) ssim = *value;
    return any;
}

void check_range(const Node& node, const std::string& key, double max, Diagnostics& diagnostics) {
    const Node* value = node.find(key);
    if (!value || !value->is_number() || (value->number >= 0 && value->number <= max)) return;
    diagnostics.error(value->place,
                      "'" + key + "' must be " +
                          (max < 1e300 ? "from 0 to " + format_number(max) : std::string("at least 0")) +
                          ", not " + format_number(value->number));
}

void check_tolerance(const Node& node, const CompareRules& rules, Diagnostics& diagnostics) {
    for (const char* key : {"fail", "hard_fail", "allow_failures", "warn", "hard_warn", "allow_warnings"})
        check_range(node, key, 1e300, diagnostics);
    for (const char* key : {"fail_percent", "warn_percent"}) check_range(node, key, 100, diagnostics);
    for (const char* key : {"fail_flip", "fail_ssim", "warn_flip", "warn_ssim"})
        check_range(node, key, 1, diagnostics);
    if (const Node* hard = node.find("hard_fail"); hard && rules.fail.hard < rules.fail.limit)
        diagnostics.error(hard->place, "'hard_fail' must be at least 'fail'");
    if (const Node* hard = node.find("hard_warn"); hard && rules.warn && rules.warn->hard < rules.warn->limit)
        diagnostics.error(hard->place, "'hard_warn' must be at least 'warn'");
}

/// The steps, as a look of their own whose faults are told with the document's lines.
void read_steps(const Node& steps, GoldenCase& result, Diagnostics& diagnostics) {
    Node version;
    version.kind = Node::Kind::integer;
    version.integer = 1, version.number = 1;
    Node look;
    look.kind = Node::Kind::object;
    look.place = steps.place;
    look.members = {{"aftershade", steps.place, version}, {"steps", steps.place, steps}};
    result.steps = json_of_node(look);
    look.place.file = (result.folder / result.file.filename()).string();
    parse_look(look, diagnostics);
}

void read_frames(const Node& node, const std::string& range, Diagnostics& diagnostics) {
    if (!parse_frame_range(range).value_or(std::vector<int>{}).empty()) return;
    diagnostics.error(node.find("frames")->place, "'" + range + "' is no range of frames");
}

void check_outputs(const Node& node, const GoldenCase& result, Diagnostics& diagnostics) {
    const Node* outputs = node.find("outputs");
    if (result.outputs.empty() && result.taps.empty())
        diagnostics.error(outputs ? outputs->place : node.place,
                          "'outputs' must name a role, or 'taps' a texture");
    if (!outputs || !outputs->is_array()) return;
    for (const Node& output : outputs->items) {
        if (!output.is_string() || find_role(output.string)) continue;
        const auto roles = role_names();
        diagnostics.error(output.place, "there is no role '" + output.string + "'" +
                                            did_you_mean(output.string, {roles.begin(), roles.end()}));
    }
}

void check_taps(const Node& node, Diagnostics& diagnostics) {
    const Node* taps = node.find("taps");
    if (!taps || !taps->is_array()) return;
    for (const Node& tap : taps->items)
        if (tap.is_string() &&
            (std::ranges::count(tap.string, '.') != 1 || tap.string.find_first_of("=/") != std::string::npos))
            diagnostics.error(tap.place, "'" + tap.string + "' is not 'step.texture'");
}

}  // namespace

std::string golden_image_name(const std::string& image_stem, int frame) {
    return FramePattern(image_stem + ".####").path(frame);
}

std::vector<std::string> GoldenCase::image_stems() const {
    std::vector<std::string> stems;
    for (std::string output : outputs) {
        std::ranges::replace(output, ':', '-');
        stems.push_back(stem + "." + output);
    }
    for (const std::string& tap : taps) stems.push_back(stem + "." + tap);
    return stems;
}

CompareRules parse_golden_tolerance(const Node& node, Diagnostics& diagnostics) {
    ObjectReader reader(node, "the tolerance", diagnostics);
    CompareRules rules;
    read_level(reader, "fail", "failures", rules.fail, rules.fail_flip, rules.fail_ssim);
    Tolerance warn = rules.fail;
    warn.percent = 0, warn.hard = std::numeric_limits<double>::infinity();
    const bool warns = read_level(reader, "warn", "warnings", warn, rules.warn_flip, rules.warn_ssim);
    rules.warn = warns ? warn : rules.fail;
    rules.nan_equal = reader.boolean("nan_equal").value_or(false);
    rules.threads = 1;  // cases run beside each other
    reader.finish();
    check_tolerance(node, rules, diagnostics);
    return rules;
}

void parse_golden_case(const Node& node, ObjectReader& reader, const fs::path& folder, GoldenCase& result,
                       Diagnostics& diagnostics) {
    if (const auto capture = reader.text("capture", Presence::required))
        result.capture = (folder / *capture).lexically_normal();
    if (const auto range = reader.text("frames")) {
        result.frames = *range;
        read_frames(node, *range, diagnostics);
    }
    if (const Node* steps = reader.array("steps")) read_steps(*steps, result, diagnostics);
    result.sets = reader.texts("set");
    result.taps = reader.texts("taps");
    check_taps(node, diagnostics);
    if (node.find("outputs")) result.outputs = reader.texts("outputs");
    else reader.any("outputs");
    check_outputs(node, result, diagnostics);
    result.rules.threads = 1;
    result.rules.warn = result.rules.fail;
    if (const Node* tolerance = reader.object("tolerance"))
        result.rules = parse_golden_tolerance(*tolerance, diagnostics);
    result.tags = reader.texts("tags");
    if (const auto why = reader.text("skip")) {
        result.skip = *why;
        if (why->empty()) diagnostics.error(node.find("skip")->place, "'skip' says why");
    }
}

std::optional<GoldenCase> parse_effect_case(const Node& node, const fs::path& file, const fs::path& root,
                                            Diagnostics& diagnostics) {
    const int errors_before = diagnostics.error_count();
    ObjectReader reader(node, "the case", diagnostics);
    check_document_version(reader, node, diagnostics);
    reader.text("$schema");
    GoldenCase result;
    result.file = file;
    result.stem = file.stem().string();
    result.name = file.parent_path().parent_path().filename().string() + "/" + result.stem;
    result.goldens = file.parent_path();
    result.folder = file.parent_path();
    for (const char* key : {"frames", "steps", "outputs", "tolerance"}) reader.any(key, Presence::required);
    parse_golden_case(node, reader, root, result, diagnostics);
    reader.finish();
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return result;
}

std::vector<GoldenCase> read_effect_cases(const fs::path& effect_folder, const fs::path& root,
                                          Diagnostics& diagnostics) {
    std::vector<fs::path> files;
    if (fs::is_directory(effect_folder / "cases"))
        for (const auto& entry : fs::directory_iterator(effect_folder / "cases")) {
            // <case>.<output>.<frame>.json is a golden's sidecar.
            const std::string stem = entry.path().stem().string();
            if (entry.path().extension() == ".json" && stem.find('.') == std::string::npos)
                files.push_back(entry.path());
        }
    std::sort(files.begin(), files.end());
    std::vector<GoldenCase> cases;
    for (const fs::path& file : files)
        if (const auto node = read_document(file, diagnostics))
            if (auto parsed = parse_effect_case(*node, file, root, diagnostics))
                cases.push_back(std::move(*parsed));
    return cases;
}

std::string json_of_node(const Node& node) {
    std::string text;
    switch (node.kind) {
        case Node::Kind::null: return "null";
        case Node::Kind::boolean: return node.boolean ? "true" : "false";
        case Node::Kind::integer: return std::to_string(node.integer);
        case Node::Kind::number: return format_number(node.number);
        case Node::Kind::string: return json_string(node.string);
        case Node::Kind::array:
            for (const Node& item : node.items) text += (text.empty() ? "" : ", ") + json_of_node(item);
            return "[" + text + "]";
        case Node::Kind::object:
            for (const Member& member : node.members)
                text +=
                    (text.empty() ? "" : ", ") + json_string(member.key) + ": " + json_of_node(member.value);
            return "{" + text + "}";
    }
    return text;
}

}  // namespace aftershade
