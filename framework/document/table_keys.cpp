#include "framework/document/table_keys.h"

#include <algorithm>
#include <map>

#include "framework/base/text.h"

namespace aftershade {

namespace {

constexpr const char* kKeys[] = {"object", "objects", "name"};

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
    return kept(parse_object_keys(node, label, diagnostics_), node, label);
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
    if (id) return object_id_key(*id, *node.find("object"), label, diagnostics_);
    if (ranges) return object_range_keys(*ranges, *node.find("objects"), label, diagnostics_);
    if (name && name->empty()) diagnostics_.error(node.find("name")->place, label + ": 'name' is empty");
    if (name && !name->empty()) return {TableKey{0, 0, *name}};
    return {};
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
    diagnostics_.error(here.place, here.label + ": " + object_text(here.key) + " is taken already by " +
                                       object_text(there.key) + " of " + there.label + ", " +
                                       to_string(there.place));
}

std::string format_key(const TableKey& key) {
    if (!key.name.empty()) return "\"name\": " + json_string(key.name);
    return (key.first == key.last ? "\"object\": " : "\"objects\": ") + format_object_keys({&key, 1});
}

}  // namespace aftershade
