#include "framework/golden/golden_case.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <ctime>

#include "framework/base/path_bounds.h"
#include "framework/base/text.h"
#include "framework/capture/frame_range.h"
#include "framework/document/grammar_reader.h"
#include "framework/document/units.h"
#include "framework/golden/golden_grammar.h"
#include "framework/look/look.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

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

}  // namespace

std::string day_of_today() {
    return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)));
}

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

void read_golden_case(const grammar::Reader& reader, const fs::path& folder, GoldenCase& result,
                      Diagnostics& diagnostics) {
    result.capture = (folder / reader.text("capture")).lexically_normal();
    result.frames = reader.text("frames");
    if (const Node* steps = reader.find("steps")) read_steps(*steps, result, diagnostics);
    result.sets = reader.texts("set");
    result.taps = reader.texts("taps");
    result.outputs = reader.texts("outputs");
    if (result.outputs.empty() && result.taps.empty())
        diagnostics.error(reader.place("outputs"), "'outputs' must name a role, or 'taps' a texture");
    result.rules.threads = 1;
    result.rules.warn = result.rules.fail;
    if (const auto tolerance = reader.object("tolerance")) {
        result.rules = read_golden_tolerance(*tolerance, diagnostics);
        result.areas = read_golden_areas(*tolerance, result.folder, diagnostics);
    }
    result.tags = reader.texts("tags");
    result.skip = reader.text("skip");
    if (const auto quarantine = reader.object("quarantine"))
        result.quarantine = {quarantine->text("until"), quarantine->text("reason")};
    result.optional = reader.boolean("optional");
}

std::optional<GoldenCase> parse_effect_case(const Node& node, const fs::path& file, const fs::path& root,
                                            Diagnostics& diagnostics) {
    const int errors_before = diagnostics.error_count();
    grammar::check(node, effect_case_block(), diagnostics);
    GoldenCase result;
    result.file = file;
    result.stem = file.stem().string();
    const std::string effect = file.parent_path().parent_path().filename().string();
    result.name = effect + "/" + result.stem;
    for (const std::string& part : {effect, result.stem})
        if (!is_case_name(part))
            diagnostics.error({file.string()},
                              fmt::format("'{}' has other characters than letters, digits, '_' and '-', or "
                                          "begins with '-': rename the {}",
                                          part, part == effect ? "effect's folder" : "file"));
    result.goldens = file.parent_path();
    result.folder = file.parent_path();
    read_golden_case({node, effect_case_block()}, root, result, diagnostics);
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
        if (const std::string why = out_of_bounds(file, effect_folder); !why.empty())
            diagnostics.error({file.string()}, why);
        else if (const auto node = read_document(file, diagnostics))
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
