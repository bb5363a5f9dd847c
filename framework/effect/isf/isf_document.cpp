// The JSON of an ISF file.
#include "framework/effect/isf/isf_document.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "framework/base/text.h"
#include "framework/document/units.h"
#include "framework/effect/isf/isf_formula.h"
#include "framework/effect/isf/isf_vocabulary.h"

namespace aftershade {

namespace {

using Type = IsfInput::Type;

const std::map<std::string, Type>& input_types() {
    static const std::map<std::string, Type> types = {
        {"image", Type::image}, {"float", Type::number}, {"bool", Type::boolean},
        {"long", Type::choice}, {"color", Type::color},  {"point2D", Type::point},
        {"event", Type::event}, {"audio", Type::audio},  {"audioFFT", Type::audio}};
    return types;
}

/// One line of a text.
std::string in_a_line(std::string_view text) {
    std::string line;
    for (const char c : printable_lines(text))
        if (!std::isspace(static_cast<unsigned char>(c))) line += c;
        else if (!line.empty() && line.back() != ' ') line += ' ';
    return std::string(trimmed(line));
}

class IsfReader {
public:
    IsfReader(IsfFile& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

    void read(const Node& document) {
        file_.place = document.place;
        file_.summary = words(document, "DESCRIPTION");
        file_.credit = words(document, "CREDIT");
        each(document, "INPUTS", kMaxIsfInputs, [&](const Node& node) { input(node); });
        imports(document);
        each(document, "PASSES", kMaxIsfPasses, [&](const Node& node) { pass(node); });
        persistent_buffers(document);
        if (file_.passes.empty()) {
            file_.passes.emplace_back();
            file_.passes.back().place = document.place;
        }
        check_passes();
    }

private:
    void fault(const Place& place, std::string text) { diagnostics_.error(place, std::move(text)); }

    /// "" where there is none.
    std::string text(const Node& object, const char* key) {
        const Node* node = object.find(key);
        if (!node || node->kind == Node::Kind::null) return "";
        if (!node->is_string())
            fault(node->place,
                  std::string(key) + " is " + std::string(kind_name(node->kind)) + ", but a text is needed");
        return node->string;
    }

    /// "" for other kinds than texts and numbers.
    static std::string word_of(const Node& node) {
        return node.is_number() ? format_number(node.number) : node.string;
    }
    /// A text for people, of any kind of value: no picture depends on it.
    static std::string words(const Node& object, const char* key) {
        const Node* node = object.find(key);
        if (!node) return "";
        std::string all = word_of(*node);
        for (const Node& item : node->items) all += (all.empty() ? "" : ", ") + word_of(item);
        return in_a_line(all);
    }

    /// Hosts write true, 1, 1.0 and "YES".
    static std::optional<bool> truth(const Node& node) {
        if (node.kind == Node::Kind::boolean) return node.boolean;
        if (node.is_number()) return node.number != 0;
        const std::string word = lower_case(node.string);
        if (word == "yes" || word == "true" || word == "1") return true;
        if (word == "no" || word == "false" || word == "0" || word.empty()) return false;
        return std::nullopt;
    }
    bool flag(const Node& object, const char* key) {
        const Node* node = object.find(key);
        if (!node) return false;
        const auto value = truth(*node);
        if (!value || node->is_array() || node->is_object())
            fault(node->place, std::string(key) + " is neither true nor false");
        return value.value_or(false);
    }

    template <typename Read>
    void each(const Node& document, const char* key, std::size_t most, const Read& read) {
        const Node* list = document.find(key);
        if (!list || list->kind == Node::Kind::null) return;
        if (!list->is_array())
            return fault(list->place, std::string(key) + " is " + std::string(kind_name(list->kind)) +
                                          ", but a list of objects is needed");
        if (list->items.size() > most)
            return fault(list->place, std::string(key) + " has " + std::to_string(list->items.size()) +
                                          " entries; the limit is " + std::to_string(most));
        for (const Node& item : list->items)
            if (item.is_object()) read(item);
            else
                fault(item.place, "an entry of " + std::string(key) + " is " +
                                      std::string(kind_name(item.kind)) + ", but an object is needed");
    }

    /// A name that stands for one thing in the shader.
    bool claim(const std::string& name, const std::string& thing, const Place& place) {
        if (!isf_words::is_name(name)) {
            fault(place,
                  thing + " is called '" + name +
                      "', which is not a name of GLSL: letters, 0-9 and _, not beginning with a digit");
            return false;
        }
        if (isf_words::is_old_word(name)) {
            fault(place, thing + " is called '" + name + "', which is a word of GLSL itself; choose another");
            return false;
        }
        if (isf_words::kOfIsf.contains(name) || isf_words::kAliases.contains(name) ||
            name == "isf_vertShaderInit" || name.starts_with("IMG_")) {
            fault(place, thing + " is called '" + name + "', which is a name of ISF itself; choose another");
            return false;
        }
        const auto [known, is_new] = names_.emplace(name, thing);
        if (!is_new)
            fault(place, thing + " has the name '" + name + "', which " + known->second + " has already");
        return is_new;
    }

    void input(const Node& node) {
        IsfInput input;
        input.place = node.place;
        const std::string type = text(node, "TYPE");
        if (const Node* written = node.find("TYPE"); written && !written->is_string()) return;
        if (!node.find("NAME") || !node.find("TYPE"))
            return fault(node.place, "an input needs a NAME and a TYPE");
        input.name = text(node, "NAME");
        input.label = words(node, "LABEL");
        const auto known = std::ranges::find_if(
            input_types(), [&](const auto& entry) { return lower_case(entry.first) == lower_case(type); });
        if (known == input_types().end()) {
            std::vector<std::string> names;
            for (const auto& [name, value] : input_types()) names.push_back(name);
            return fault(node.find("TYPE")->place, "the input '" + input.name + "' has the type '" + type +
                                                       "', which ISF does not have" +
                                                       did_you_mean(type, names) +
                                                       " (types: " + list_of_names(names) + ")");
        }
        input.type = known->second;
        if (!claim(input.name, "an input", node.find("NAME")->place)) return;
        if (input.type == Type::choice) choices(node, input);
        input.default_value = value(node, "DEFAULT", input);
        // Hosts give the shader a DEFAULT that none of the VALUES is.
        if (input.default_value && !input.values.empty() &&
            std::ranges::find(input.values, int(input.default_value->number)) == input.values.end()) {
            input.values.clear();
            input.labels.clear();
        }
        input.identity = value(node, "IDENTITY", input);
        if (input.type != Type::choice || input.values.empty()) {
            input.min = value(node, "MIN", input);
            input.max = value(node, "MAX", input);
        }
        file_.inputs.push_back(std::move(input));
    }

    void choices(const Node& node, IsfInput& input) {
        const Node* values = node.find("VALUES");
        const Node* labels = node.find("LABELS");
        for (const Node** list : {&values, &labels}) {
            if (*list && (*list)->kind == Node::Kind::null) *list = nullptr;
            if (*list && !(*list)->is_array())
                return fault((*list)->place, "VALUES and LABELS of '" + input.name + "' are lists");
        }
        if (!values) {
            // Labels alone are numbered.
            for (std::size_t i = 0; labels && i < labels->items.size(); ++i) {
                input.values.push_back(int(i));
                input.labels.push_back(word_of(labels->items[i]));
            }
            return;
        }
        for (std::size_t i = 0; i < values->items.size(); ++i) {
            const Node item = as_number(values->items[i]);
            if (!item.is_number() || std::abs(item.number) > 1e9 || item.number != std::floor(item.number))
                return fault(
                    item.place,
                    "VALUES of '" + input.name + "' are whole numbers" +
                        (item.is_number() ? ", which " + format_number(item.number) + " is not" : ""));
            const Node* label = labels && i < labels->items.size() ? &labels->items[i] : nullptr;
            input.values.push_back(int(item.number));
            input.labels.push_back(
                word_of(label && (label->is_string() || label->is_number()) ? *label : item));
        }
    }

    /// Hosts read "0.5" as a number, too.
    static Node as_number(const Node& node) {
        const auto number = node.is_string() ? parse_number(std::string(trimmed(node.string))) : std::nullopt;
        Node value = node;
        if (number) value.kind = Node::Kind::number, value.number = *number;
        return value;
    }

    static std::size_t components_of(Type type) {
        return type == Type::color ? 4 : type == Type::point ? 2 : 1;
    }

    /// As the type takes it: a number, true or false, or a list of numbers of its length.
    std::optional<Node> value(const Node& object, const char* key, const IsfInput& input) {
        const Node* node = object.find(key);
        if (!node || node->kind == Node::Kind::null || input.type == Type::image || input.type == Type::audio)
            return std::nullopt;
        const std::string label = std::string(key) + " of '" + input.name + "' is ";
        // Hosts leave out limits and identities that they cannot read.
        const auto wrong = [&](const std::string& what) -> std::optional<Node> {
            if (std::string_view(key) == "DEFAULT") fault(node->place, label + what);
            else diagnostics_.warning(node->place, label + what + ", and is left out");
            return std::nullopt;
        };
        Node value = as_number(*node);
        if (input.type == Type::boolean || input.type == Type::event) {
            const auto is_true = truth(*node);
            if (!is_true || node->is_array() || node->is_object()) return wrong("neither true nor false");
            value.kind = Node::Kind::boolean;
            value.boolean = *is_true;
            return value;
        }
        const std::size_t size = components_of(input.type);
        if (size == 1) {
            const auto named = std::ranges::find(input.labels, node->string);
            if (node->kind == Node::Kind::boolean) value.number = node->boolean;
            else if (!value.is_number() && node->is_string() && named != input.labels.end())
                value.number = input.values[std::size_t(named - input.labels.begin())];
            else if (!value.is_number())
                return wrong(std::string(kind_name(node->kind)) + ", but a number is needed");
            value.kind = Node::Kind::number;
            if (input.type == Type::choice && !(value.number >= INT32_MIN && value.number <= INT32_MAX))
                return wrong(format_number(value.number) + ", which does not fit 32 bits");
            if (input.type == Type::choice && value.number != std::trunc(value.number))
                diagnostics_.warning(node->place,
                                     label + format_number(value.number) + ", of which a long takes " +
                                         format_number(std::trunc(value.number)) + " (write a whole number)");
            return value;
        }
        const auto is_number = [](const Node& item) { return item.is_number(); };
        // A colour may leave out its alpha, and hosts write one number for the limit of all.
        if (node->is_number()) value.items.assign(size, *node);
        value.kind = Node::Kind::array;
        for (Node& item : value.items) item = as_number(item);
        if (value.items.size() > size) {
            diagnostics_.warning(node->place, label + "a list of " + std::to_string(value.items.size()) +
                                                  ", of which the first " + std::to_string(size) +
                                                  " numbers count (remove the others)");
            value.items.resize(size);
        }
        if (size == 4 && value.items.size() == 3) {
            value.items.push_back(value.items.back());
            value.items.back().kind = Node::Kind::number;
            value.items.back().number = 1;
        }
        if (value.items.size() != size || !std::ranges::all_of(value.items, is_number))
            return wrong("not a list of " + std::to_string(size) + " numbers");
        return value;
    }

    /// {"name": {"PATH": "x.png"}}, with six paths a cube map; in ISF 1 [{"NAME": "name", "PATH": "x.png"}].
    void imports(const Node& document) {
        const Node* node = document.find("IMPORTED");
        if (!node || node->kind == Node::Kind::null) return;
        const auto add = [&](const std::string& name, const Place& place, const Node& import) {
            const Node* path = import.is_object() ? import.find("PATH") : nullptr;
            if (path && path->is_array()) return cube(name, place, *path);
            if (!path || !path->is_string() || path->string.empty())
                return fault(place, "the import '" + name + "' has no PATH");
            if (claim(name, "an import", place))
                file_.imports.push_back({name, path->string, name, path->place});
        };
        if (node->is_object())
            for (const Member& member : node->members) add(member.key, member.key_place, member.value);
        else if (node->is_array())
            for (const Node& item : node->items)
                add(item.is_object() ? text(item, "NAME") : "", item.place, item);
        else fault(node->place, "IMPORTED is an object of pictures by name");
    }

    void cube(const std::string& name, const Place& place, const Node& paths) {
        const bool are_paths = std::ranges::all_of(
            paths.items, [](const Node& path) { return path.is_string() && !path.string.empty(); });
        if (paths.items.size() != std::size_t(kCubeFaces) || !are_paths)
            return fault(paths.place, "PATH of the import '" + name +
                                          "' is a list, but a cube map has 6 paths: +x, -x, +y, -y, +z, -z");
        if (!claim(name, "an import", place)) return;
        file_.cubes.push_back(name);
        for (int face = 0; face < kCubeFaces; ++face) {
            const Node& path = paths.items[std::size_t(face)];
            file_.imports.push_back(
                {name_of_face(name, face), path.string, name + "_" + std::to_string(face), path.place});
        }
    }

    void pass(const Node& node) {
        IsfPass pass;
        pass.place = node.place;
        pass.target = text(node, "TARGET");
        pass.is_persistent = flag(node, "PERSISTENT");
        pass.is_float = flag(node, "FLOAT");
        pass.doc = words(node, "DESCRIPTION");
        sides(node, pass);
        const auto first = std::ranges::find(file_.passes, pass.target, &IsfPass::target);
        if (pass.target.empty()) {
        } else if (first == file_.passes.end()) {
            claim(pass.target, "a TARGET", node.find("TARGET")->place);
        } else if (pass.side[0].empty() && pass.side[1].empty()) {
            std::ranges::copy(first->side, pass.side);
            std::ranges::copy(first->side_place, pass.side_place);
        }
        file_.passes.push_back(std::move(pass));
    }

    void sides(const Node& node, IsfPass& pass) {
        for (const int axis : {0, 1}) {
            const char* const key = axis == 0 ? "WIDTH" : "HEIGHT";
            const Node* side = node.find(key);
            if (!side || side->kind == Node::Kind::null) continue;
            if (!side->is_string() && !side->is_number()) {
                fault(side->place, std::string(key) + " is " + std::string(kind_name(side->kind)) +
                                       ", but a number or a formula is needed");
                continue;
            }
            pass.side[axis] =
                side->is_number() ? format_number(side->number) : std::string(trimmed(side->string));
            pass.side_place[axis] = side->place;
        }
    }

    /// ISF 1: names, or {"name": {"WIDTH": ..., "HEIGHT": ..., "FLOAT": ...}}.
    void persistent_buffers(const Node& document) {
        const Node* node = document.find("PERSISTENT_BUFFERS");
        if (!node || node->kind == Node::Kind::null) return;
        const auto keep = [&](const std::string& name, const Place& place, const Node* buffer) {
            bool is_target = false;
            for (IsfPass& pass : file_.passes) {
                if (pass.target != name || name.empty()) continue;
                is_target = pass.is_persistent = true;
                if (!buffer || !buffer->is_object()) continue;
                pass.is_float |= flag(*buffer, "FLOAT");
                sides(*buffer, pass);
            }
            if (!is_target)
                fault(place, "PERSISTENT_BUFFERS names '" + name + "', which is the TARGET of no pass");
        };
        if (node->is_object())
            for (const Member& member : node->members) keep(member.key, member.key_place, &member.value);
        else if (node->is_array())
            for (const Node& item : node->items) keep(item.string, item.place, nullptr);
        else fault(node->place, "PERSISTENT_BUFFERS is a list of names");
    }

    void check_passes() {
        for (const IsfPass& pass : file_.passes) {
            if (pass.target.empty() && pass.is_persistent && file_.passes.size() > 1)
                fault(pass.place, "the pass is PERSISTENT but has no TARGET, so that nothing can read it");
            for (const int axis : {0, 1})
                if (!pass.side[axis].empty()) check_isf_side(file_, pass, axis, diagnostics_);
            for (const IsfPass& other : file_.passes)
                if (&other < &pass && other.target == pass.target && !pass.target.empty() &&
                    (other.side[0] != pass.side[0] || other.side[1] != pass.side[1]))
                    fault(pass.place, "two passes have the TARGET '" + pass.target +
                                          "' with different sizes (give one another TARGET)");
        }
    }

    IsfFile& file_;
    Diagnostics& diagnostics_;
    std::map<std::string, std::string> names_;  // things by name
};

}  // namespace

void read_isf_document(const Node& document, IsfFile& file, Diagnostics& diagnostics) {
    IsfReader(file, diagnostics).read(document);
}

}  // namespace aftershade
