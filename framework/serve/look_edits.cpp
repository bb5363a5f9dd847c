#include "framework/serve/look_edits.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/look/look.h"
#include "framework/serve/json_spans.h"

namespace aftershade::serve {

namespace {

using Json = nlohmann::ordered_json;

/// Keys of a step whose value an edit of that name sets.
constexpr std::array<std::string_view, 5> kStepKeys = {"name", "mix", "preset", "mask", "in"};

[[noreturn]] void refuse(const std::string& message) {
    throw Error(ErrorKind::usage, "the edit cannot be made: " + message);
}

/// One line, with a space behind each comma and colon, as people write looks.
std::string line_of(const Json& value) {
    if (value.is_array()) {
        std::string text;
        for (const Json& item : value) text += (text.empty() ? "" : ", ") + line_of(item);
        return "[" + text + "]";
    }
    if (!value.is_object()) return value.dump();
    std::string text;
    for (const auto& [key, item] : value.items())
        text += (text.empty() ? "" : ", ") + Json(key).dump() + ": " + line_of(item);
    return text.empty() ? "{}" : "{ " + text + " }";
}

/// What the lines of a text around a new value are like.
struct Lines {
    std::string indent;
    std::string end;
};

/// Objects, and lists of them, that are too long for a line have one for each part.
std::string text_of(const Json& value, const Lines& lines) {
    constexpr std::size_t kMostColumns = 110;
    std::string line = line_of(value);
    const bool is_list = value.is_array() && !value.empty() && value.front().is_object();
    if (line.size() <= kMostColumns || (!value.is_object() && !is_list)) return line;
    const Lines inner{lines.indent + "  ", lines.end};
    std::string text;
    for (const auto& [key, item] : value.items())
        text += (text.empty() ? "" : ",") + inner.end + inner.indent +
                (is_list ? "" : Json(key).dump() + ": ") + text_of(item, inner);
    return (is_list ? "[" : "{") + text + lines.end + lines.indent + (is_list ? "]" : "}");
}

/// The white space at the beginning of the line that `at` is in; and whether nothing else stands before it.
struct LineStart {
    std::string indent;
    bool is_alone = false;
};
LineStart line_start(std::string_view text, std::size_t at) {
    const std::size_t newline = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
    const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
    const std::size_t end = std::min(text.find_first_not_of(" \t", begin), text.size());
    return {std::string(text.substr(begin, std::min(end, at) - begin)), end >= at};
}

/// How a text ends its lines.
std::string line_end(std::string_view text) {
    return text.find("\r\n") == std::string_view::npos ? "\n" : "\r\n";
}

/// Those of the line that `at` is in.
Lines lines_at(std::string_view text, std::size_t at) {
    return {line_start(text, at).indent, line_end(text)};
}

/// Behind a comment that follows `at` on its line, where nothing but blanks stands between; else `at`.
std::size_t behind_comment(std::string_view text, std::size_t at) {
    const std::size_t next = std::min(text.find_first_not_of(" \t", at), text.size());
    if (text.substr(next, 2) != "//") return at;
    const std::size_t end = std::min(text.find_first_of("\r\n", next), text.size());
    return end;
}

/// One object or array of the text: its parts, from their first byte to their last.
struct List {
    Span whole;
    std::vector<Span> parts;
};

List list_of(const SpanNode& node) {
    List list{node.span, {}};
    for (const SpanNode& item : node.items) list.parts.push_back(item.span);
    for (const SpanMember& member : node.members)
        list.parts.push_back({member.key_span.begin, member.value.span.end});
    return list;
}

/// Behind the comma that follows a part, where one does.
std::size_t comma_behind(std::string_view text, std::size_t end) {
    const std::size_t comma = skip_blank(text, end);
    return comma < text.size() && text[comma] == ',' ? comma : std::string_view::npos;
}

/// Puts a part before the one at `index`, or behind the last one.
void insert_part(std::string& text, const List& list, std::size_t index, const std::string& part) {
    if (list.parts.empty()) {
        text.insert(list.whole.begin + 1, part);
        return;
    }
    if (index < list.parts.size()) {
        const std::size_t at = list.parts[index].begin;
        const LineStart line = line_start(text, at);
        text.insert(at, part + "," + (line.is_alone ? line_end(text) + line.indent : " "));
        return;
    }
    const Span last = list.parts.back();
    const LineStart line = line_start(text, last.begin);
    if (!line.is_alone) {
        text.insert(last.end, ", " + part);
        return;
    }
    // Behind a comma that follows already only where JSON would not be JSON; the comment stays with its
    // value.
    const std::string added = line_end(text) + line.indent + part;
    text.insert(behind_comment(text, last.end), added);
    text.insert(last.end, ",");
}

/// Takes a part out with one comma, and with its line where that holds nothing else.
void remove_part(std::string& text, const List& list, std::size_t index) {
    const Span part = list.parts[index];
    std::size_t begin = part.begin, end = part.end;
    const LineStart line = line_start(text, begin);
    const std::size_t after = comma_behind(text, end);
    std::size_t lone_comma = std::string::npos;
    if (after != std::string::npos) {
        // A comment between the value and its comma goes with the value.
        end = after + 1;
    } else if (index > 0) {
        lone_comma = comma_behind(text, list.parts[index - 1].end);
    }
    if (line.is_alone) {
        const std::size_t rest = behind_comment(text, end);
        const std::size_t newline = text.find_first_not_of(" \t\r", rest);
        if (newline != std::string::npos && text[newline] == '\n') {
            begin -= line.indent.size();
            end = newline + 1;
        }
    } else if (after != std::string::npos) {
        end = std::min(text.find_first_not_of(" \t", end), text.size());
    } else if (lone_comma != std::string::npos && skip_blank(text, lone_comma + 1) == begin &&
               text.find_first_not_of(" \t", lone_comma + 1) == begin) {
        begin = lone_comma + 1;
    }
    text.erase(begin, end - begin);
    if (lone_comma != std::string::npos) text.erase(lone_comma, 1);
}

void set_member(std::string& text, const SpanNode& object, const std::string& key, const Json& value);

/// The text of an object of several lines with other members. Each stays where it is, and so do the comments
/// beside it; new ones come before the member that follows them in `value`.
std::string with_members(std::string text, const Json& value) {
    std::vector<std::string> gone;
    for (const SpanMember& member : spans_of(text).members)
        if (!value.contains(member.key)) gone.push_back(member.key);
    // The last one is not taken out before another one is there: an empty object would lose its lines.
    for (auto item = value.rbegin(); item != value.rend(); ++item) {
        const SpanNode object = spans_of(text);
        if (object.find(item.key())) {
            set_member(text, object, item.key(), *item);
            continue;
        }
        const auto next = item.base();
        const SpanMember* follower = next == value.end() ? nullptr : object.find(next.key());
        const std::size_t at =
            follower ? std::size_t(follower - object.members.data()) : object.members.size();
        const Lines lines = lines_at(text, object.members.front().key_span.begin);
        insert_part(text, list_of(object), at, Json(item.key()).dump() + ": " + text_of(*item, lines));
    }
    for (const std::string& key : gone) set_member(text, spans_of(text), key, nullptr);
    return text;
}

/// `value` null: the key goes.
void set_member(std::string& text, const SpanNode& object, const std::string& key, const Json& value) {
    if (object.kind != SpanNode::Kind::object) refuse("'" + key + "' has its place in an object");
    const SpanMember* member = object.find(key);
    if (value.is_null()) {
        if (member) remove_part(text, list_of(object), std::size_t(member - object.members.data()));
        return;
    }
    if (member) {
        const Span span = member->value.span;
        // The same value in the author's own spelling stays as it was written.
        const Json before = Json::parse(span.of(text), nullptr, false, true);
        if (before == value) return;
        const bool has_lines = span.of(text).find('\n') != std::string_view::npos;
        const bool is_inside =
            has_lines && value.is_object() && !value.empty() && before.is_object() && !before.empty();
        text.replace(span.begin, span.end - span.begin,
                     is_inside ? with_members(std::string(span.of(text)), value)
                               : text_of(value, lines_at(text, member->key_span.begin)));
        return;
    }
    const Lines lines =
        lines_at(text, object.members.empty() ? object.span.begin : object.members.back().key_span.begin);
    insert_part(text, list_of(object), object.members.size(),
                Json(key).dump() + ": " + text_of(value, lines));
}

const SpanNode& steps_of(const SpanNode& root) {
    const SpanMember* steps = root.find("steps");
    if (!steps || steps->value.kind != SpanNode::Kind::array) refuse("the look has no list 'steps'");
    return steps->value;
}

std::size_t index_of(const Json& edit, const char* key, std::size_t count) {
    const auto found = edit.find(key);
    if (found == edit.end() || !found->is_number_integer())
        refuse(fmt::format("'{}' is the number of a step", key));
    const auto index = found->get<std::int64_t>();
    if (index < 0 || std::uint64_t(index) >= count)
        refuse(fmt::format("'{}' is {}; the steps are 0 to {}", key, index, std::int64_t(count) - 1));
    return std::size_t(index);
}

const Json& value_of(const Json& edit) {
    const auto found = edit.find("value");
    if (found == edit.end()) refuse("it has no 'value'");
    return *found;
}

std::string word_of(const Json& edit, const char* key) {
    const auto found = edit.find(key);
    if (found == edit.end() || !found->is_string()) refuse(fmt::format("'{}' is a word", key));
    return found->get<std::string>();
}

void set_param(std::string& text, const SpanNode& step, const Json& edit) {
    const std::string name = word_of(edit, "param");
    const Json& value = value_of(edit);
    const SpanMember* params = step.find("params");
    if (params) {
        const bool was_last = params->value.members.size() == 1 && params->value.find(name);
        // A list that the page itself made goes when it is empty again; comments in it keep it.
        const std::string_view inside = params->value.span.of(text);
        if (value.is_null() && was_last && inside.find("//") == std::string_view::npos &&
            inside.find("/*") == std::string_view::npos)
            return set_member(text, step, "params", nullptr);
        return set_member(text, params->value, name, value);
    }
    if (!value.is_null()) set_member(text, step, "params", Json{{name, value}});
}

/// A variable of the look; null: it goes, and the list with it where it was the last.
void set_variable(std::string& text, const SpanNode& root, const Json& edit) {
    const std::string name = word_of(edit, "name");
    const Json& value = value_of(edit);
    const SpanMember* variables = root.find("vars");
    if (variables) {
        const bool is_last = variables->value.members.size() == 1 && variables->value.find(name);
        if (value.is_null() && is_last) set_member(text, root, "vars", nullptr);
        else set_member(text, variables->value, name, value);
        return;
    }
    if (value.is_null()) return;
    const auto steps = std::size_t(root.find("steps") - root.members.data());
    insert_part(text, list_of(root), steps, "\"vars\": " + line_of(Json{{name, value}}));
}

/// Steps change places; what stands between them stays where it is.
void move_step(std::string& text, const SpanNode& steps, std::size_t from, std::size_t to) {
    std::vector<std::string> parts;
    for (const SpanNode& item : steps.items) parts.emplace_back(item.span.of(text));
    std::string part = std::move(parts[from]);
    parts.erase(parts.begin() + std::ptrdiff_t(from));
    parts.insert(parts.begin() + std::ptrdiff_t(to), std::move(part));
    for (std::size_t i = parts.size(); i-- > 0;)
        text.replace(steps.items[i].span.begin, steps.items[i].span.end - steps.items[i].span.begin,
                     parts[i]);
}

/// Adds the step with a name of its own where the effect is there already: no two steps may have one name.
void add_step(std::string& text, const SpanNode& steps, const Json& edit) {
    const std::string effect = word_of(edit, "effect");
    const std::size_t at = index_of(edit, "at", steps.items.size() + 1);
    std::vector<std::string> names;
    for (const SpanNode& item : steps.items) {
        const Json step = Json::parse(item.span.of(text), nullptr, false, true);
        if (!step.is_object()) continue;
        const Json& name = step.contains("name") ? step["name"] : step.value("effect", Json());
        if (!name.is_string()) continue;
        names.push_back(name.get<std::string>());
        if (!step.contains("name")) names.back() = default_step_name(names.back());
    }
    const std::string first = default_step_name(effect);
    std::string name = first;
    for (int n = 2; std::ranges::find(names, name) != names.end(); ++n)
        name = first + "_" + std::to_string(n);
    Json step = {{"effect", effect}};
    if (name != first) step["name"] = name;
    const Span whole = steps.span;
    if (const std::string_view list = whole.of(text); list == "[]" && text.find('\n') < whole.begin) {
        const std::string end = line_end(text), indent = line_start(text, whole.begin).indent;
        text.replace(whole.begin, list.size(),
                     "[" + end + indent + "  " + line_of(step) + end + indent + "]");
        return;
    }
    insert_part(text, list_of(steps), at, line_of(step));
}

}  // namespace

std::string edited(const std::string& text, const Json& edit) {
    if (!edit.is_object()) refuse("an edit is an object");
    const std::string op = word_of(edit, "op");
    if (op == "text") return word_of(edit, "value");
    const SpanNode root = spans_of(text);
    const SpanNode& steps = steps_of(root);
    std::string result = text;
    if (op == "add") {
        add_step(result, steps, edit);
        return result;
    }
    if (op == "var") {
        set_variable(result, root, edit);
        return result;
    }
    const std::size_t index = index_of(edit, "step", steps.items.size());
    const SpanNode& step = steps.items[index];
    if (step.kind != SpanNode::Kind::object) refuse(fmt::format("step {} is not an object", index));
    if (op == "remove") remove_part(result, list_of(steps), index);
    else if (op == "move") move_step(result, steps, index, index_of(edit, "to", steps.items.size()));
    else if (op == "set") set_param(result, step, edit);
    else if (op == "enable") {
        if (!value_of(edit).is_boolean()) refuse("'value' is true or false");
        const bool is_on = value_of(edit).get<bool>();
        // "enabled": true says nothing that its absence does not.
        if (!is_on || step.find("enabled")) set_member(result, step, "enabled", is_on);
    } else if (std::ranges::find(kStepKeys, op) != kStepKeys.end())
        set_member(result, step, op, value_of(edit));
    else refuse("'" + op + "' is not an edit");
    return result;
}

}  // namespace aftershade::serve
