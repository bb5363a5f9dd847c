#include "framework/pipeline/look.h"

#include <algorithm>

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

std::vector<WiringSpec> parse_wiring(const Node& node, Diagnostics& diagnostics) {
    std::vector<WiringSpec> wiring;
    for (const Member& member : node.members) {
        const std::size_t dot = member.value.is_string() ? member.value.string.find('.') : std::string::npos;
        if (dot == std::string::npos) {
            diagnostics.error(member.value.place,
                              "'" + member.key + "' comes from \"capture.<role>\" or \"<step>.<output>\"");
            continue;
        }
        const std::string& text = member.value.string;
        wiring.push_back({member.key, text.substr(0, dot), text.substr(dot + 1), member.value.place});
    }
    return wiring;
}

LookStep parse_step(const Node& node, Diagnostics& diagnostics) {
    LookStep step;
    step.place = step.effect_place = step.preset_place = node.place;
    ObjectReader reader(node, "the step", diagnostics);
    step.effect = reader.text("effect", Presence::required).value_or("");
    if (const Node* effect = node.find("effect")) step.effect_place = effect->place;
    step.name = reader.text("name").value_or(step.effect);
    step.enabled = reader.boolean("enabled").value_or(true);
    step.preset = reader.text("preset");
    if (const Node* preset = node.find("preset")) step.preset_place = preset->place;
    if (const Node* params = reader.object("params")) step.params = params->members;
    if (const Node* in = reader.object("in")) step.wiring = parse_wiring(*in, diagnostics);
    reader.finish();
    return step;
}

bool is_snake_case(const std::string& name) {
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    const auto fits = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
    return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), fits);
}

void check_names(const Look& look, Diagnostics& diagnostics) {
    for (std::size_t i = 0; i < look.steps.size(); ++i) {
        const LookStep& step = look.steps[i];
        if (step.name.empty() && step.effect.empty()) continue;  // told of already
        // Wiring, --set and --tap part a name from what follows at the first dot, and taps are files of that
        // name.
        if (step.name != step.effect && !is_snake_case(step.name))
            diagnostics.error(
                step.place,
                "the name '" + step.name + "' must be snake_case: a-z, 0-9 and _, beginning with a letter");
        if (step.name == "capture")
            diagnostics.error(step.place, "a step cannot be named 'capture': wiring means the input by it");
        const auto same = [&](const LookStep& other) { return other.name == step.name; };
        if (std::any_of(look.steps.begin(), look.steps.begin() + std::ptrdiff_t(i), same))
            diagnostics.error(step.place,
                              "a second step named '" + step.name + "'; give it a 'name' of its own");
    }
}

}  // namespace

std::optional<Look> parse_look(const Node& node, Diagnostics& diagnostics) {
    Look look;
    look.file = node.place.file;
    ObjectReader reader(node, "the look", diagnostics);
    if (!reader.is_object()) return std::nullopt;
    check_document_version(reader, node, diagnostics);
    reader.text("$schema");
    if (const Node* steps = reader.array("steps", Presence::required)) {
        for (const Node& step : steps->items) look.steps.push_back(parse_step(step, diagnostics));
        if (steps->items.empty())
            diagnostics.warning(steps->place, "the look has no steps: frames pass through");
    }
    reader.finish();
    check_names(look, diagnostics);
    // A look whose form is wrong may still be checked against its effects, so that all faults come at once.
    return look;
}

std::optional<Look> read_look(const std::filesystem::path& path, Diagnostics& diagnostics) {
    const auto node = read_document(path, diagnostics);
    return node ? parse_look(*node, diagnostics) : std::nullopt;
}

}  // namespace aftershade
