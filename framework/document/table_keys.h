// Which objects rows and lists are for. For the types of parameters that shaders look up by object.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "framework/document/param.h"

namespace aftershade {

/// Reads which objects rows and lists are for, and finds those that are named twice.
class TableKeyReader {
public:
    explicit TableKeyReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    static bool is_key(std::string_view word);
    /// Reads the key of a row: one of 'object', 'objects' and 'name'. `label` names the row.
    std::vector<TableKey> read_row(ObjectReader& reader, const Node& node, const std::string& label);
    /// Reads an item of a list: 3, "3-7,9" or "Wheel".
    std::vector<TableKey> read_item(const Node& node, const std::string& label);
    /// Reports what more than one of those read is for. Call once, last.
    void check_overlaps();

private:
    struct Found {
        TableKey key;
        std::string label;
        Place place;
    };

    std::vector<TableKey> kept(std::vector<TableKey> keys, const Node& node, const std::string& label);
    std::vector<TableKey> row_keys(ObjectReader& reader, const Node& node, const std::string& label);
    void report_overlap(std::size_t later, std::size_t earlier);

    Diagnostics& diagnostics_;
    std::vector<Found> found_;
};

/// "\"objects\": \"3-7\"": the member of a row.
std::string format_key(const TableKey& key);

/// Entries that the storage block of a table with these rows, pairs of a TableKey and anything, has room for:
/// one per row, and one more for each name that may take its id out of a range. Depends on what kinds of keys
/// there are, never on what they say, so that content can change without another block.
template <typename Rows>
std::size_t count_entries(const Rows& rows) {
    const auto names = std::size_t(
        std::count_if(rows.begin(), rows.end(), [](const auto& row) { return !row.first.name.empty(); }));
    return rows.size() + (names < rows.size() ? names : 0);
}

}  // namespace aftershade
