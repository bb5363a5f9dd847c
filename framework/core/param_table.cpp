#include "framework/core/param_internal.h"

#include "framework/core/text.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

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

/// Reads one table; `rows` are the value's so far.
class TableReader {
public:
    explicit TableReader(const ValueReader& value) : value_(value), diagnostics_(value.diagnostics) {}

    std::optional<ParamValue> read(const Node& node) {
        if (!node.is_object()) return value_.wrong_kind(node, "an object with 'default' and 'rows'");
        const int errors_before = diagnostics_.error_count();
        for (const ParamSpec& column : value_.spec.columns)
            table_.default_row.push_back(numbers_of(column, column.default_value));
        ObjectReader reader(node, value_.label, diagnostics_);
        if (const Node* row = reader.object("default")) {
            const std::string label = value_.label + ".default";
            ObjectReader row_reader(*row, label, diagnostics_);
            table_.default_row = cells(row_reader, *row, label);
            row_reader.finish();
        }
        if (const Node* rows = reader.array("rows"))
            for (std::size_t i = 0; i < rows->items.size(); ++i)
                read_row(rows->items[i], value_.label + ".rows[" + std::to_string(i) + "]");
        reader.finish();
        check_overlaps();
        if (diagnostics_.error_count() > errors_before) return std::nullopt;
        return std::move(table_);
    }

private:
    struct Origin {
        std::string label;
        Place place;
    };

    /// The default row with the cells that `node` gives.
    TableValue::Row cells(ObjectReader& reader, const Node& node, const std::string& label) {
        TableValue::Row row = table_.default_row;
        for (std::size_t i = 0; i < value_.spec.columns.size(); ++i) {
            const ParamSpec& column = value_.spec.columns[i];
            reader.any(column.name);
            const Node* cell = node.find(column.name);
            if (!cell) continue;
            const auto value = parse_param_value(column, *cell, label + "." + column.name, diagnostics_);
            if (value) row[i] = numbers_of(column, *value);
        }
        return row;
    }

    void read_row(const Node& node, const std::string& label) {
        ObjectReader reader(node, label, diagnostics_);
        if (!reader.is_object()) return;
        const TableValue::Row row = cells(reader, node, label);
        const std::vector<TableKey> keys = read_keys(reader, node, label);
        reader.finish();
        for (const TableKey& key : keys) {
            table_.rows.emplace_back(key, row);
            origins_.push_back({label, node.place});
        }
    }

    std::vector<TableKey> read_keys(ObjectReader& reader, const Node& node, const std::string& label) {
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

    std::vector<TableKey> id_key(std::int64_t id, const Node& node, const std::string& label) {
        if (id >= 0 && id <= std::int64_t(UINT32_MAX))
            return {TableKey{std::uint32_t(id), std::uint32_t(id), ""}};
        diagnostics_.error(node.place, label + ": " + std::to_string(id) +
                                           " is not an object's id, a number from 0 to 4294967295");
        return {};
    }

    std::vector<TableKey> range_keys(std::string_view text, const Node& node, const std::string& label) {
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

    void check_overlaps() {
        std::vector<std::size_t> by_id;
        std::map<std::string, std::size_t> by_name;
        for (std::size_t i = 0; i < table_.rows.size(); ++i) {
            const TableKey& key = table_.rows[i].first;
            if (key.name.empty()) by_id.push_back(i);
            else if (const auto [other, fresh] = by_name.emplace(key.name, i); !fresh)
                report_overlap(i, other->second);
        }
        std::stable_sort(by_id.begin(), by_id.end(), [&](std::size_t a, std::size_t b) {
            return table_.rows[a].first.first < table_.rows[b].first.first;
        });
        // The row that reaches furthest so far is the one that a later one may run into.
        for (std::size_t i = 1, reach = 0; i < by_id.size(); ++i) {
            const std::size_t before = by_id[reach], row = by_id[i];
            const std::uint32_t end = table_.rows[before].first.last;
            if (table_.rows[row].first.first <= end)
                report_overlap(std::max(row, before), std::min(row, before));
            if (table_.rows[row].first.last > end) reach = i;
        }
    }

    void report_overlap(std::size_t later, std::size_t earlier) {
        const Origin& here = origins_[later];
        const Origin& there = origins_[earlier];
        diagnostics_.error(here.place, here.label + ": " + text_of(table_.rows[later].first) +
                                           " is taken already by " + text_of(table_.rows[earlier].first) +
                                           " of " + there.label + ", " + to_string(there.place));
    }

    const ValueReader& value_;
    Diagnostics& diagnostics_;
    TableValue table_;
    std::vector<Origin> origins_;  // of each row
};

}  // namespace

std::optional<ParamValue> ValueReader::table(const Node& node) const {
    return TableReader(*this).read(node);
}

void read_columns(const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    if (node.members.empty())
        diagnostics.error(node.place, "table parameter '" + spec.name + "' has no columns");
    for (const Member& member : node.members) {
        const std::string thing = "column '" + member.key + "' of parameter '" + spec.name + "'";
        if (!is_snake_case(member.key)) diagnostics.error(member.key_place, thing + " " + kMustBeSnakeCase);
        if (std::find(std::begin(kKeys), std::end(kKeys), member.key) != std::end(kKeys))
            diagnostics.error(member.key_place, thing + ": a row says by this key which object it is for");
        auto column = parse_spec(member.key, thing, spec.name + ".columns." + member.key, SpecOwner::table,
                                 member.value, diagnostics);
        if (column) spec.columns.push_back(std::move(*column));
    }
}

}  // namespace aftershade
