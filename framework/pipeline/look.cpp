#include "framework/pipeline/look.h"

#include "framework/core/text.h"

#include <algorithm>
#include <set>
#include <utility>

namespace aftershade {

namespace fs = std::filesystem;
using Presence = ObjectReader::Presence;

namespace {

std::vector<WiringSpec> parse_wiring(const Node& node, Diagnostics& diagnostics) {
    std::vector<WiringSpec> wiring;
    for (const Member& member : node.members) {
        const std::size_t dot = member.value.is_string() ? member.value.string.find('.') : std::string::npos;
        if (dot == std::string::npos) {
            diagnostics.error(
                member.value.place,
                "'" + member.key +
                    "' comes from \"capture.<role>\", \"<step>.<output>\" or \"<step>.<texture>\"");
            continue;
        }
        const std::string& text = member.value.string;
        wiring.push_back({member.key, text.substr(0, dot), text.substr(dot + 1), member.value.place});
    }
    return wiring;
}

/// One entry, or a list of them.
void add_objects(const Node& node, std::vector<TableKey>& objects, Diagnostics& diagnostics) {
    const std::string label = "the mask";
    const auto add = [&](const Node& entry) {
        for (TableKey& key : parse_object_keys(entry, label, diagnostics)) objects.push_back(std::move(key));
    };
    if (node.is_array()) std::for_each(node.items.begin(), node.items.end(), add);
    else add(node);
    if (node.is_array() && node.items.empty())
        diagnostics.error(node.place, label + "'s 'object' names no object");
    if (objects.size() > kMaxMaskObjects)
        diagnostics.error(node.place,
                          label + " names " + std::to_string(objects.size()) +
                              " ids, ranges and names; the limit is " + std::to_string(kMaxMaskObjects) +
                              " (write ids that follow one another as a range, \"3-7\", or give the mask as "
                              "a picture: 'role' or 'file')");
}

MaskSpec parse_mask(const Node& node, const fs::path& folder, Diagnostics& diagnostics) {
    ObjectReader reader(node, "the mask", diagnostics);
    MaskSpec mask;
    mask.place = node.place;
    mask.role = reader.text("role").value_or("");
    if (const Node* object = reader.any("object")) add_objects(*object, mask.objects, diagnostics);
    if (const auto file = reader.text("file")) mask.file = folder / *file;
    mask.invert = reader.boolean("invert").value_or(false);
    reader.finish();
    const int kinds = int(node.find("role") != nullptr) + int(node.find("object") != nullptr) +
                      int(node.find("file") != nullptr);
    if (node.is_object() && kinds != 1)
        diagnostics.error(node.place, "a mask has one of 'role', 'object' and 'file'");
    for (const char* key : {"role", "file"})
        if (const Node* value = node.find(key); value && value->is_string() && value->string.empty())
            diagnostics.error(value->place, "the mask's '" + std::string(key) + "' is empty");
    return mask;
}

/// Reads one look, and through itself the looks that it uses.
class LookReader {
public:
    LookReader(Look& look, Diagnostics& diagnostics) : look_(look), diagnostics_(diagnostics) {}

    /// `prefix` stands before the name of each step; `overrides` were given by who uses the look.
    void read(const Node& node, const std::string& prefix, bool enabled, const LookVariables& overrides,
              const Place& user) {
        ObjectReader reader(node, "the look", diagnostics_);
        if (!reader.is_object()) return;
        open_.push_back(canonical(node.place.file));
        look_.files.emplace_back(node.place.file);
        check_document_version(reader, node, diagnostics_);
        reader.text("$schema");
        reader.text("summary");
        Scope scope{fs::path(node.place.file).parent_path(), prefix, enabled, {}, {}};
        read_variables(reader, overrides, user, scope);
        if (const Node* steps = reader.array("steps", Presence::required)) {
            for (const Node& step : steps->items) {
                if (step.find("use")) use(step, scope);
                else look_.steps.push_back(parse_step(step, scope));
            }
            if (steps->items.empty())
                diagnostics_.warning(steps->place, "the look has no steps: frames pass through");
        }
        reader.finish();
        for (const auto& [name, value] : scope.variables)
            if (!scope.used.contains(name))
                diagnostics_.warning(value.place, "the variable '" + name + "' is never used");
        open_.pop_back();
    }

private:
    struct Scope {
        fs::path folder;
        std::string prefix;
        bool enabled = true;
        LookVariables variables;
        std::set<std::string> used;
    };

    static fs::path canonical(const fs::path& path) {
        std::error_code failure;
        const fs::path result = fs::weakly_canonical(path, failure);
        return failure ? path : result;
    }

    void read_variables(ObjectReader& reader, const LookVariables& overrides, const Place& user,
                        Scope& scope) {
        if (const Node* vars = reader.object("vars"))
            for (const Member& member : vars->members) {
                if (!is_snake_case(member.key))
                    diagnostics_.error(member.key_place,
                                       "the variable '" + member.key + "' " + kMustBeSnakeCase);
                scope.variables[member.key] = member.value;
            }
        std::vector<std::string> known;
        for (const auto& [name, value] : scope.variables) known.push_back(name);
        for (const auto& [name, value] : overrides) {
            const Place& place = value.place.file.empty() ? user : value.place;
            if (!scope.variables.contains(name))
                diagnostics_.error(place,
                                   "the look has no variable '" + name + "'" + did_you_mean(name, known));
            scope.variables[name] = value;
        }
    }

    /// Puts values in the place of {"var": "name"}, at any depth.
    Node with_variables(const Node& node, Scope& scope) {
        if (node.is_object() && node.members.size() == 1 && node.members[0].key == "var") {
            const Node& name = node.members[0].value;
            const auto found = name.is_string() ? scope.variables.find(name.string) : scope.variables.end();
            if (found != scope.variables.end()) {
                scope.used.insert(found->first);
                return found->second;
            }
            std::vector<std::string> known;
            for (const auto& [variable, value] : scope.variables) known.push_back(variable);
            diagnostics_.error(name.place, !name.is_string() ? std::string("'var' is the name of a variable")
                                                             : "the look has no variable '" + name.string +
                                                                   "'" + did_you_mean(name.string, known));
        }
        Node copy = node;
        for (Node& item : copy.items) item = with_variables(item, scope);
        for (Member& member : copy.members) member.value = with_variables(member.value, scope);
        return copy;
    }

    LookStep parse_step(const Node& node, Scope& scope) {
        LookStep step;
        step.place = step.effect_place = step.preset_place = node.place;
        step.folder = scope.folder;
        ObjectReader reader(node, "the step", diagnostics_);
        step.effect = reader.text("effect", Presence::required).value_or("");
        if (const Node* effect = node.find("effect")) {
            step.effect_place = effect->place;
            if (effect->is_string() && step.effect.empty())
                diagnostics_.error(effect->place, "'effect' is empty: it is the id of an effect");
        }
        const auto name = reader.text("name");
        // Wiring, --set and --tap part a name from what follows at the first dot, and taps are files of that
        // name.
        if (name && !is_snake_case(*name))
            diagnostics_.error(node.place, "the name '" + *name + "' " + kMustBeSnakeCase);
        step.name = scope.prefix + name.value_or(step.effect);
        step.enabled = reader.boolean("enabled").value_or(true) && scope.enabled;
        step.preset = reader.text("preset");
        if (const Node* preset = node.find("preset")) step.preset_place = preset->place;
        if (const Node* params = reader.object("params"))
            for (const Member& member : params->members)
                step.params.push_back({member.key, member.key_place, with_variables(member.value, scope)});
        if (const Node* in = reader.object("in")) {
            step.wiring = parse_wiring(*in, diagnostics_);
            for (WiringSpec& wiring : step.wiring)
                if (wiring.source != "capture") wiring.source = scope.prefix + wiring.source;
        }
        if (const Node* mix = reader.any("mix")) step.mix = with_variables(*mix, scope);
        if (const Node* mask = reader.object("mask"))
            step.mask = parse_mask(with_variables(*mask, scope), scope.folder, diagnostics_);
        reader.finish();
        return step;
    }

    /// {"use": "lens.json", "name": "wide", "vars": {"focus": "2 m"}, "enabled": false}
    void use(const Node& node, Scope& scope) {
        ObjectReader reader(node, "the step", diagnostics_);
        const auto file = reader.text("use", Presence::required);
        const auto name = reader.text("name");
        const bool enabled = reader.boolean("enabled").value_or(true) && scope.enabled;
        LookVariables variables;
        if (const Node* vars = reader.object("vars"))
            for (const Member& member : vars->members)
                variables[member.key] = with_variables(member.value, scope);
        reader.finish();
        if (name && !is_snake_case(*name))
            diagnostics_.error(node.place, "the name '" + *name + "' " + kMustBeSnakeCase);
        if (!file) return;
        const Place& place = node.find("use")->place;
        const fs::path path = scope.folder / *file;
        if (std::find(open_.begin(), open_.end(), canonical(path)) != open_.end()) {
            diagnostics_.error(place, "'" + *file + "' uses itself: " + chain_to(canonical(path)));
            return;
        }
        const auto document = read_document(path, diagnostics_);
        if (!document) {
            diagnostics_.error(place, "'" + *file + "' cannot be used (see above)");
            return;
        }
        read(*document, scope.prefix + (name ? *name + "_" : ""), enabled, variables, node.place);
    }

    std::string chain_to(const fs::path& last) const {
        std::string text;
        for (auto file = std::find(open_.begin(), open_.end(), last); file != open_.end(); ++file)
            text += file->filename().string() + " uses ";
        return text + last.filename().string();
    }

    Look& look_;
    Diagnostics& diagnostics_;
    std::vector<fs::path> open_;  // looks being read, each used by the one before
};

void check_names(const Look& look, Diagnostics& diagnostics) {
    for (std::size_t i = 0; i < look.steps.size(); ++i) {
        const LookStep& step = look.steps[i];
        if (step.name.empty() && step.effect.empty()) continue;  // told of already
        if (step.name == "capture")
            diagnostics.error(step.place, "a step cannot be named 'capture': wiring means the input by it");
        const auto same = [&](const LookStep& other) { return other.name == step.name; };
        const auto first = std::find_if(look.steps.begin(), look.steps.begin() + std::ptrdiff_t(i), same);
        if (first != look.steps.begin() + std::ptrdiff_t(i))
            diagnostics.error(step.place, "a second step named '" + step.name +
                                              "'; give it a 'name' of its own (the first is at " +
                                              to_string(first->place) + ")");
    }
}

void set_place(Node& node, const Place& place) {
    node.place = place;
    for (Node& item : node.items) set_place(item, place);
    for (Member& member : node.members) set_place(member.value, place);
}

}  // namespace

Node parse_command_value(const std::string& text, const Place& place) {
    Diagnostics not_json;
    auto node = parse_document(text, place.file, not_json);
    if (!node) {
        node.emplace();
        node->kind = Node::Kind::string;
        node->string = text;
    }
    set_place(*node, place);
    return std::move(*node);
}

std::optional<Look> parse_look(const Node& node, Diagnostics& diagnostics, const LookVariables& variables) {
    if (!node.is_object()) {
        ObjectReader(node, "the look", diagnostics);
        return std::nullopt;
    }
    Look look;
    look.file = node.place.file;
    LookReader(look, diagnostics).read(node, "", true, variables, node.place);
    check_names(look, diagnostics);
    // A look whose form is wrong may still be checked against its effects, so that all faults come at once.
    return look;
}

std::optional<Look> read_look(const fs::path& path, Diagnostics& diagnostics,
                              const LookVariables& variables) {
    const auto node = read_document(path, diagnostics);
    return node ? parse_look(*node, diagnostics, variables) : std::nullopt;
}

}  // namespace aftershade
