#include "framework/look/look.h"

#include <algorithm>
#include <set>
#include <utility>

#include "framework/base/path_bounds.h"
#include "framework/base/text.h"
#include "framework/document/grammar_reader.h"
#include "framework/look/look_grammar.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

std::vector<WiringSpec> read_wiring(const Node& node) {
    std::vector<WiringSpec> wiring;
    for (const Member& member : node.members) {
        const std::string& text = member.value.string;
        const std::size_t dot = text.find('.');
        if (dot != std::string::npos)
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

MaskSpec parse_mask(const grammar::Reader& reader, const fs::path& folder, Diagnostics& diagnostics) {
    MaskSpec mask;
    mask.place = reader.node().place;
    mask.role = reader.text("role");
    if (const Node* object = reader.find("object")) add_objects(*object, mask.objects, diagnostics);
    if (reader.has("file")) mask.file = folder / reader.text("file");
    mask.invert = reader.boolean("invert");
    return mask;
}

/// Reads one look, and through itself the looks that it uses.
class LookReader {
public:
    LookReader(Look& look, Diagnostics& diagnostics) : look_(look), diagnostics_(diagnostics) {}

    /// `prefix` stands before the name of each step; `overrides` were given by who uses the look.
    void read(const Node& node, const std::string& prefix, bool enabled, const LookVariables& overrides,
              const Place& user) {
        grammar::check(node, look_block(), diagnostics_);
        if (!node.is_object()) return;
        const grammar::Reader reader(node, look_block());
        open_.push_back(canonical(node.place.file));
        look_.files.emplace_back(node.place.file);
        Scope scope{fs::path(node.place.file).parent_path(), prefix, enabled, {}, {}};
        read_variables(reader, overrides, user, scope);
        if (const Node* steps = reader.find("steps")) {
            for (const Node& step : steps->items) {
                if (is_too_large_) break;
                if (step.find("use")) use(step, scope);
                else add_step(step, scope);
            }
            if (steps->items.empty())
                diagnostics_.warning(steps->place, "the look has no steps: frames pass through");
        }
        for (const auto& [name, value] : scope.variables)
            if (!scope.used.contains(name) && !is_too_large_)
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

    void read_variables(const grammar::Reader& reader, const LookVariables& overrides, const Place& user,
                        Scope& scope) {
        if (const Node* vars = reader.find("vars")) {
            if (vars->members.size() > kMaxLookVariables)
                return refuse_size(vars->place, "the look has " + std::to_string(vars->members.size()) +
                                                    " variables; the limit is " +
                                                    std::to_string(kMaxLookVariables));
            for (const Member& member : vars->members) scope.variables[member.key] = member.value;
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

    /// Said once; what follows is not read.
    void refuse_size(const Place& place, const std::string& fault) {
        if (!is_too_large_) diagnostics_.error(place, fault);
        is_too_large_ = true;
    }

    static std::size_t count_values(const Node& node) {
        std::size_t count = 1;
        for (const Node& item : node.items) count += count_values(item);
        for (const Member& member : node.members) count += count_values(member.value);
        return count;
    }

    /// Whether a variable's value may be put in once more.
    bool has_room_for(const Node& value, const Place& place) {
        values_put_in_ += count_values(value);
        if (values_put_in_ <= kMaxVariableValues) return true;
        refuse_size(place, "variables put more than " + std::to_string(kMaxVariableValues) +
                               " values into the look, which is the limit (write fewer {\"var\": ...} inside "
                               "values of variables)");
        return false;
    }

    std::string suggestion(const std::string& variable, const Scope& scope) const {
        constexpr int kMostSuggestions = 100;  // each looks at every variable
        if (diagnostics_.error_count() >= kMostSuggestions) return "";
        std::vector<std::string> known;
        for (const auto& [name, value] : scope.variables) known.push_back(name);
        return did_you_mean(variable, known);
    }

    /// Puts values in the place of {"var": "name"}, at any depth.
    Node with_variables(const Node& node, Scope& scope) {
        if (node.is_object() && node.members.size() == 1 && node.members[0].key == "var") {
            const Node& name = node.members[0].value;
            const auto found = name.is_string() ? scope.variables.find(name.string) : scope.variables.end();
            if (found != scope.variables.end()) {
                scope.used.insert(found->first);
                return has_room_for(found->second, name.place) ? found->second : Node();
            }
            diagnostics_.error(name.place, !name.is_string() ? std::string("'var' is the name of a variable")
                                                             : "the look has no variable '" + name.string +
                                                                   "'" + suggestion(name.string, scope));
        }
        Node copy = node;
        for (Node& item : copy.items) item = with_variables(item, scope);
        for (Member& member : copy.members) member.value = with_variables(member.value, scope);
        return copy;
    }

    /// The step with values in the place of its variables. A parameter itself may be named "var".
    Node filled(const Node& node, Scope& scope) {
        Node copy = node;
        for (Member& member : copy.members) {
            if (member.key == "params")
                for (Member& value : member.value.members) value.value = with_variables(value.value, scope);
            for (const char* key : {"mix", "mask"})
                if (member.key == key) member.value = with_variables(member.value, scope);
        }
        return copy;
    }

    void add_step(const Node& node, Scope& scope) {
        if (look_.steps.size() == kMaxLookSteps)
            return refuse_size(node.place, "the look has more than " + std::to_string(kMaxLookSteps) +
                                               " steps, which is the limit");
        LookStep step = parse_step(node, scope);
        if (!is_too_large_) look_.steps.push_back(std::move(step));
    }

    LookStep parse_step(const Node& written, Scope& scope) {
        const Node node = filled(written, scope);
        if (is_too_large_) return {};
        grammar::check(node, look_step_block(), diagnostics_);
        const grammar::Reader reader(node, look_step_block());
        LookStep step;
        step.place = node.place;
        step.effect_place = reader.place("effect");
        step.preset_place = reader.place("preset");
        step.folder = scope.folder;
        step.effect = reader.text("effect");
        // An ill-formed id too: two steps with it do not share a name.
        const Node* name = node.find("name");
        step.name =
            scope.prefix + (name && name->is_string() ? name->string : default_step_name(step.effect));
        if (reader.has("space")) step.space = reader.choice<IsfSpace>("space");
        step.space_place = reader.place("space");
        step.enabled = reader.boolean("enabled") && scope.enabled;
        if (reader.has("preset")) step.preset = reader.text("preset");
        if (const Node* params = reader.find("params")) step.params = params->members;
        if (const Node* in = reader.find("in")) step.wiring = read_wiring(*in);
        for (WiringSpec& wiring : step.wiring)
            if (wiring.source != "capture") wiring.source = scope.prefix + wiring.source;
        if (const Node* mix = reader.find("mix")) step.mix = *mix;
        if (const auto mask = reader.object("mask"))
            step.mask = parse_mask(*mask, scope.folder, diagnostics_);
        return step;
    }

    /// {"use": "lens.json", "name": "wide", "vars": {"focus": "2 m"}, "enabled": false}
    void use(const Node& node, Scope& scope) {
        grammar::check(node, look_use_block(), diagnostics_);
        const grammar::Reader reader(node, look_use_block());
        const bool enabled = reader.boolean("enabled") && scope.enabled;
        LookVariables variables;
        if (const Node* vars = reader.find("vars"))
            for (const Member& member : vars->members)
                variables[member.key] = with_variables(member.value, scope);
        if (!reader.has("use")) return;
        const std::string file = reader.text("use"), name = reader.text("name");
        const Place& place = reader.place("use");
        const fs::path path = scope.folder / file;
        if (std::find(open_.begin(), open_.end(), canonical(path)) != open_.end()) {
            diagnostics_.error(place, "'" + file + "' uses itself: " + chain_to(canonical(path)) +
                                          " (remove one of these 'use')");
            return;
        }
        if (is_too_large_ || !may_use_another(file, place)) return;
        if (const std::string reason = FileRule::why_not(path); !reason.empty()) {
            diagnostics_.error(place, "'" + file + "' " + reason);
            return;
        }
        const auto document = read_document(path, diagnostics_);
        if (!document) {
            diagnostics_.error(place, "'" + file + "' cannot be used (see above)");
            return;
        }
        read(*document, scope.prefix + (name.empty() ? "" : name + "_"), enabled, variables, node.place);
    }

    bool may_use_another(const std::string& file, const Place& place) {
        if (open_.size() == kMaxLookDepth)
            refuse_size(place, "'" + file + "' cannot be used: it would be the look " +
                                   std::to_string(kMaxLookDepth + 1) + " in a chain of 'use', the limit is " +
                                   std::to_string(kMaxLookDepth) + " (write its steps here)");
        else if (++uses_ > kMaxLookUses)
            refuse_size(place, "'" + file + "' cannot be used: the look uses other looks more than " +
                                   std::to_string(kMaxLookUses) +
                                   " times, which is the limit (write the steps where they are used)");
        return !is_too_large_;
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
    std::size_t uses_ = 0;
    std::size_t values_put_in_ = 0;
    bool is_too_large_ = false;
};

void check_names(const Look& look, Diagnostics& diagnostics) {
    for (std::size_t i = 0; i < look.steps.size(); ++i) {
        const LookStep& step = look.steps[i];
        if (step.name.empty() && step.effect.empty()) continue;  // told of already
        if (step.name == "capture")
            diagnostics.error(step.place,
                              "a step cannot be named 'capture': wiring uses this name for the capture");
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

/// JSON has no .5, 5. and +0.5, which people write: "[.5, +1]" becomes "[0.5, 1]".
std::string with_json_numbers(const std::string& text) {
    const auto is_digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
    std::string json;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto follows = [&](const std::string& any) {
            return i == 0 || any.find(text[i - 1]) != std::string::npos;
        };
        const bool is_before_number = is_digit(i + 1) || (i + 1 < text.size() && text[i + 1] == '.');
        if (text[i] == '+' && follows("[, ") && is_before_number) continue;
        const bool is_last =
            i + 1 == text.size() || std::string(",] ").find(text[i + 1]) != std::string::npos;
        if (text[i] == '.' && is_last && i > 0 && is_digit(i - 1)) continue;
        if (text[i] == '.' && follows("[, -+") && is_digit(i + 1)) json += '0';
        json += text[i];
    }
    return json;
}

}  // namespace

std::string default_step_name(const std::string& effect) {
    if (effect.empty() || is_snake_case(effect)) return effect;
    return snake_case(is_isf_path(effect) ? fs::path(effect).stem().string() : effect);
}

Node parse_command_value(const std::string& text, const Place& place) {
    Diagnostics not_json;
    auto node = parse_document(text, place.file, not_json);
    if (!node) node = parse_document(with_json_numbers(text), place.file, not_json);
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
        grammar::check(node, look_block(), diagnostics);
        return std::nullopt;
    }
    if (node.find("frames") && !node.find("steps")) {
        diagnostics.error(node.place,
                          "is a capture, and this place takes a look; the look comes before the capture");
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
