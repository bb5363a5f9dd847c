// Which objects a row, or a list, is for.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>

#include "framework/core/param_internal.h"
#include "framework/core/text.h"

namespace aftershade {

namespace {

constexpr const char* kKeys[] = {"object", "objects", "name"};

std::optional<std::uint32_t> parse_id(std::string_view text) {
    std::uint32_t id = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return id;
}

std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return text;
}

/// "3-7", "9"; nullopt where it is neither, or falls.
std::optional<TableKey> parse_range(std::string_view text) {
    const std::size_t dash = text.find('-');
    const auto first = parse_id(trimmed(text.substr(0, dash)));
    const auto last = dash == std::string_view::npos ? first : parse_id(trimmed(text.substr(dash + 1)));
    if (!first || !last || *last < *first) return std::nullopt;
    return TableKey{*first, *last, ""};
}

std::string text_of(const TableKey& key) {
    if (!key.name.empty()) return "'" + key.name + "'";
    if (key.first == key.last) return "object " + std::to_string(key.first);
    return "objects " + std::to_string(key.first) + "-" + std::to_string(key.last);
}

}  // namespace

bool TableKeyReader::is_key(std::string_view word) {
    return std::find(std::begin(kKeys), std::end(kKeys), word) != std::end(kKeys);
}

std::vector<TableKey> TableKeyReader::kept(std::vector<TableKey> keys, const Node& node,
                                           const std::string& label) {
    for (const TableKey& key : keys) found_.push_back({key, label, node.place});
    return keys;
}

std::vector<TableKey> TableKeyReader::read_row(ObjectReader& reader, const Node& node,
                                               const std::string& label) {
    return kept(row_keys(reader, node, label), node, label);
}

std::vector<TableKey> TableKeyReader::read_item(const Node& node, const std::string& label) {
    std::vector<TableKey> keys;
    if (node.kind == Node::Kind::integer) keys = id_key(node.integer, node, label);
    else if (!node.is_string() || node.string.empty())
        diagnostics_.error(node.place,
                           label + ": expected an object's id, a range of ids such as \"3-7\" or a name");
    else if (const auto range = parse_range(node.string)) keys = {*range};
    else keys = {TableKey{0, 0, node.string}};
    return kept(std::move(keys), node, label);
}

std::vector<TableKey> TableKeyReader::row_keys(ObjectReader& reader, const Node& node,
                                               const std::string& label) {
    const auto id = reader.integer("object");
    const auto ranges = reader.text("objects");
    const auto name = reader.text("name");
    const auto count = std::count_if(std::begin(kKeys), std::end(kKeys),
                                     [&](const char* key) { return node.find(key) != nullptr; });
    if (count != 1) {
        diagnostics_.error(node.place, label + ": a row has one of 'object', 'objects' and 'name', not " +
                                           std::to_string(count));
        return {};
    }
    if (id) return id_key(*id, *node.find("object"), label);
    if (ranges) return range_keys(*ranges, *node.find("objects"), label);
    if (name && name->empty()) diagnostics_.error(node.find("name")->place, label + ": 'name' is empty");
    if (name && !name->empty()) return {TableKey{0, 0, *name}};
    return {};
}

std::vector<TableKey> TableKeyReader::id_key(std::int64_t id, const Node& node, const std::string& label) {
    if (id >= 0 && id <= std::int64_t(UINT32_MAX))
        return {TableKey{std::uint32_t(id), std::uint32_t(id), ""}};
    diagnostics_.error(node.place, label + ": " + std::to_string(id) +
                                       " is not an object's id, a number from 0 to 4294967295");
    return {};
}

std::vector<TableKey> TableKeyReader::range_keys(std::string_view text, const Node& node,
                                                 const std::string& label) {
    std::vector<TableKey> keys;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t comma = std::min(text.find(',', start), text.size());
        const std::string piece(trimmed(text.substr(start, comma - start)));
        if (const auto range = parse_range(piece)) keys.push_back(*range);
        else
            diagnostics_.error(node.place, label + ": '" + piece +
                                               "' is no range of ids; write \"3-7,9\", each from 0 to "
                                               "4294967295 and rising");
        start = comma + 1;
    }
    return keys;
}

void TableKeyReader::check_overlaps() {
    std::vector<std::size_t> by_id;
    std::map<std::string, std::size_t> by_name;
    for (std::size_t i = 0; i < found_.size(); ++i) {
        const TableKey& key = found_[i].key;
        if (key.name.empty()) by_id.push_back(i);
        else if (const auto [other, fresh] = by_name.emplace(key.name, i); !fresh)
            report_overlap(i, other->second);
    }
    std::stable_sort(by_id.begin(), by_id.end(),
                     [&](std::size_t a, std::size_t b) { return found_[a].key.first < found_[b].key.first; });
    // The row that reaches furthest so far is the one that a later one may run into.
    for (std::size_t i = 1, reach = 0; i < by_id.size(); ++i) {
        const std::size_t before = by_id[reach], row = by_id[i];
        const std::uint32_t end = found_[before].key.last;
        if (found_[row].key.first <= end) report_overlap(std::max(row, before), std::min(row, before));
        if (found_[row].key.last > end) reach = i;
    }
}

void TableKeyReader::report_overlap(std::size_t later, std::size_t earlier) {
    const Found& here = found_[later];
    const Found& there = found_[earlier];
    diagnostics_.error(here.place, here.label + ": " + text_of(here.key) + " is taken already by " +
                                       text_of(there.key) + " of " + there.label + ", " +
                                       to_string(there.place));
}

}  // namespace aftershade
