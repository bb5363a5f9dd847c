#include "framework/effect/manifest/manifest_groups.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "framework/base/text.h"
#include "framework/document/units.h"

namespace aftershade {

namespace {

Node scalar(const Place& place, double number, std::string text = "") {
    Node node;
    const bool is_whole = number == std::floor(number) && std::abs(number) < 1e15;
    node.kind = !text.empty() ? Node::Kind::string : is_whole ? Node::Kind::integer : Node::Kind::number;
    node.place = place;
    node.string = std::move(text);
    node.number = number;
    if (is_whole) node.integer = std::int64_t(number);
    return node;
}

std::string text_of(const Node& value) {
    return value.is_string() ? value.string : format_number(value.number);
}

std::size_t bytes_of(const Node& node) {
    std::size_t bytes = sizeof(Node) + node.string.size();
    for (const Node& item : node.items) bytes += bytes_of(item);
    for (const Member& member : node.members) bytes += member.key.size() + bytes_of(member.value);
    return bytes;
}

/// A variable of a `for`, in one of its turns.
struct Variable {
    const Member* declared;
    std::size_t turn;
};

/// "7..1"
std::optional<std::pair<double, double>> range_of(const Node& written) {
    const std::string_view text = written.string;
    const std::size_t dots = std::min(text.find(".."), text.size());
    const auto end = [](std::string_view part) -> std::optional<double> {
        part = trimmed(part);
        const auto value = parse_number(part);
        const bool is_sound =
            part.find_first_not_of("-0123456789") == std::string_view::npos && part.size() <= 6;
        return is_sound ? value : std::nullopt;
    };
    const auto from = end(text.substr(0, dots)), to = end(text.substr(std::min(dots + 2, text.size())));
    return from && to ? std::optional(std::pair(*from, *to)) : std::nullopt;
}

Node value_of(const Variable& variable) {
    const Node& written = variable.declared->value;
    if (written.is_array()) return written.items[variable.turn];
    const auto [from, to] = *range_of(written);
    return scalar(written.place, from + (from < to ? 1.0 : -1.0) * double(variable.turn));
}

/// What the entries of a group have of it, and of the groups around it.
struct Around {
    std::vector<Member> keys;
    std::vector<Variable> variables;
    std::string turn;  ///< "level = 3"

    const Variable* find(std::string_view name) const {
        const auto is_it = [&](const Variable& one) { return one.declared->key == name; };
        const auto found = std::ranges::find_if(variables, is_it);
        return found == variables.end() ? nullptr : &*found;
    }
    /// An entry's own values come before the group's; conditions add up.
    std::vector<Member> with(const std::vector<Member>& own) const {
        std::vector<Member> all = keys;
        for (const Member& member : own) {
            const auto other = std::ranges::find(all, member.key, &Member::key);
            if (other == all.end()) all.push_back(member);
            else if (member.key == "when" && member.value.is_object() && other->value.is_object())
                std::ranges::copy(member.value.members, std::back_inserter(other->value.members));
            else *other = member;
        }
        return all;
    }
};

class GroupWriter {
public:
    explicit GroupWriter(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    void write(Node& section, const GroupedSection& declared) {
        section_ = &declared;
        if (section.kind != kind()) return;
        entries_.clear();
        names_.clear();
        add_all(section, {});
        section.items.clear();
        section.members.clear();
        for (Member& entry : entries_) {
            if (is_list()) section.items.push_back(std::move(entry.value));
            else section.members.push_back(std::move(entry));
        }
    }

private:
    bool is_list() const { return section_->name == "passes"; }
    Node::Kind kind() const { return is_list() ? Node::Kind::array : Node::Kind::object; }
    void fault(const Place& place, std::string text) { diagnostics_.error(place, std::move(text)); }

    void add_all(const Node& node, const Around& around) {
        for (const Member& member : node.members) add(member, around);
        for (const Node& item : node.items) add({"", item.place, item}, around);
    }

    void add(const Member& entry, const Around& around) {
        const Node* const turns = entry.value.find("for");
        if (!turns) return add_turn(entry, around);
        const std::size_t count = count_of_turns(*turns, around);
        const int faults = diagnostics_.error_count();
        for (std::size_t turn = 0; turn < count && !is_full_ && diagnostics_.error_count() == faults;
             ++turn) {
            Around here = around;
            for (const Member& variable : turns->members) here.variables.push_back({&variable, turn});
            constexpr std::size_t kShown = 40;
            const Member& first = turns->members.front();
            here.turn += (here.turn.empty() ? "" : ", ") + first.key.substr(0, kShown) + " = " +
                         text_of(value_of({&first, turn})).substr(0, kShown);
            add_turn(entry, here);
        }
    }

    void add_turn(Member entry, Around around) {
        Node& value = entry.value;
        std::erase_if(value.members, [](const Member& member) { return member.key == "for"; });
        if (is_list() && value.is_string()) {
            Node pass;
            pass.kind = Node::Kind::object;
            pass.place = value.place;
            pass.members = {{"name", value.place, value}};
            value = std::move(pass);
        }
        const bool is_alone = around.keys.empty() && around.variables.empty();
        if (value.is_object()) value.members = around.with(value.members);
        if (!is_alone && !has_room_for(1, bytes_of(value), value.place, around)) return;
        if (const Node* const found = value.find(section_->name)) {
            const Node inside = *found;
            std::erase_if(value.members, [&](const Member& member) { return member.key == section_->name; });
            if (const Node* const name = is_list() ? value.find("name") : nullptr)
                fault(name->place, "a group has no 'name': its passes have");
            around.keys = std::move(value.members);
            if (inside.kind != kind())
                fault(inside.place, "'" + section_->name + "' must be " + std::string(kind_name(kind())) +
                                        ", not " + std::string(kind_name(inside.kind)));
            else if (inside.items.empty() && inside.members.empty())
                fault(inside.place, "the group has no " + section_->name);
            else add_all(inside, around);
            return;
        }
        if (!is_alone) {
            mark(entry.key_place, around);
            entry.key = filled(entry.key, entry.key_place, around);
            fill(value, around);
        }
        const auto [other, is_new] = names_.emplace(entry.key, entry.key_place.line);
        if (!is_new && !is_list())
            fault(entry.key_place, section_->thing + " '" + entry.key + "' occurs twice; first at line " +
                                       std::to_string(other->second));
        else entries_.push_back(std::move(entry));
    }

    bool has_room_for(int entries, std::size_t bytes, Place place, const Around& around) {
        written_ += entries;
        bytes_ += bytes;
        if (written_ <= kMaxGroupedEntries && bytes_ <= kMaxGroupedBytes) return true;
        mark(place, around);
        if (!std::exchange(is_full_, true))
            fault(place, "groups write out at most " + std::to_string(kMaxGroupedEntries) + " entries and " +
                             std::to_string(kMaxGroupedBytes >> 20) +
                             " MiB, and this is more (shorten a 'for')");
        return false;
    }

    /// 0 after a fault.
    std::size_t count_of_turns(const Node& turns, const Around& around) {
        if (!turns.is_object() || turns.members.empty())
            fault(turns.place, R"('for' is an object of variables: {"level": "1..8"})");
        std::optional<std::size_t> first;
        for (const Member& variable : turns.members) {
            const auto is_value = [](const Node& v) { return v.is_string() || v.is_number(); };
            const std::string name = "the variable '" + variable.key + "' ";
            const Node& values = variable.value;
            const auto range = range_of(values);
            const double count =
                range ? std::abs(range->second - range->first) + 1 : double(values.items.size());
            std::string why;
            if (!is_snake_case(variable.key)) why = kMustBeSnakeCase;
            else if (const Variable* outer = around.find(variable.key))
                why =
                    "is one of a group around it, at line " + std::to_string(outer->declared->key_place.line);
            else if (count == 0 || !std::ranges::all_of(values.items, is_value))
                why = R"(has a range, such as "1..8" or "7..1", or a list of words and numbers)";
            else if (count > kMaxTurns)
                why = "has " + format_number(count) + " values, more than the limit of " +
                      std::to_string(kMaxTurns) + " (shorten it, or use 'repeat')";
            else if (count != double(first.value_or(std::size_t(count))))
                why = "has " + format_number(count) + " values, but '" + turns.members[0].key + "' has " +
                      std::to_string(*first) + ": variables of one 'for' change together";
            if (!why.empty()) fault(variable.key_place, name + why);
            first = why.empty() ? first.value_or(std::size_t(count)) : 0;
            if (first == 0U) break;
        }
        return first.value_or(0);
    }

    void mark(Place& place, const Around& around) const {
        place.copy = written_;
        place.turn = around.turn;
    }

    void fill(Node& node, const Around& around) {
        mark(node.place, around);
        const std::string_view text = node.string;
        if (!around.variables.empty() && text.starts_with('{') && text.find('}') + 1 == text.size())
            node = evaluated(std::string(text.substr(1, text.size() - 2)), node.place, around);
        else node.string = filled(node.string, node.place, around);
        for (Node& item : node.items) fill(item, around);
        for (Member& member : node.members) {
            mark(member.key_place, around);
            std::string key = filled(member.key, member.key_place, around);
            if (key != member.key && node.find(key))
                fault(member.key_place, "the key '" + key + "' occurs twice in one object");
            member.key = std::move(key);
            fill(member.value, around);
        }
    }

    std::string filled(const std::string& text, const Place& place, const Around& around) {
        std::string result;
        std::size_t at = 0;
        for (std::size_t open; (open = text.find('{', at)) != std::string::npos;) {
            const std::size_t close = text.find('}', open);
            if (close == std::string::npos || around.variables.empty()) break;
            const std::string value =
                text_of(evaluated(text.substr(open + 1, close - open - 1), place, around));
            if (!has_room_for(0, value.size(), place, around)) return "";
            result += text.substr(at, open - at) + value;
            at = close + 1;
        }
        return result + text.substr(at);
    }

    /// The value of "level", "level + 1", "level - 1", "2 * level" or "0.5 ^ level".
    Node evaluated(const std::string& expression, const Place& place, const Around& around) {
        const std::size_t at = std::min(expression.find_first_of("+-*^"), expression.size());
        const char sign = at < expression.size() ? expression[at] : ' ';
        std::string_view left = trimmed(std::string_view(expression).substr(0, at)), right;
        if (sign != ' ') right = trimmed(std::string_view(expression).substr(at + 1));
        if (sign == '*' || sign == '^') std::swap(left, right);
        const Variable* const variable = around.find(left);
        std::vector<std::string> names;
        for (const Variable& one : around.variables) names.push_back(one.declared->key);
        if (!variable)
            fault(place, "'{" + expression + "}' names no variable of a 'for' around it (" +
                             joined(names, ", ") + ")" + did_you_mean(left, names));
        Node value = variable ? value_of(*variable) : scalar(place, 0);
        value.place = place;
        if (!variable || sign == ' ') return value;
        const double n = value.number, number = parse_number(right).value_or(NAN);
        const double result = sign == '+'   ? n + number
                              : sign == '-' ? n - number
                              : sign == '*' ? n * number
                                            : std::pow(number, n);
        if (value.is_string() || !std::isfinite(result) || std::isnan(number))
            fault(place,
                  "'{" + expression +
                      R"(}' is not "level + 1", "level - 1", "2 * level" or "0.5 ^ level" of a number)");
        return scalar(place, result);
    }

    Diagnostics& diagnostics_;
    const GroupedSection* section_ = nullptr;
    std::vector<Member> entries_;
    std::map<std::string, int> names_;  // and their lines
    int written_ = 0;                   // entries and groups of the document
    std::size_t bytes_ = 0;
    bool is_full_ = false;
};

}  // namespace

Node without_groups(Node document, Diagnostics& diagnostics) {
    GroupWriter writer(diagnostics);
    for (Member& member : document.members)
        for (const GroupedSection& section : grouped_sections())
            if (member.key == section.name) writer.write(member.value, section);
    return document;
}

}  // namespace aftershade
