// Which objects something is for, as documents write it: 3, "3-7,9" or "Wheel".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"

namespace aftershade {

/// Ids first..last, or the object of that name (Cryptomatte).
struct TableKey {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::string name;  ///< "" for ids
    bool operator==(const TableKey&) const = default;
};

/// An id, a text of ids and ranges of ids, or a name. A text of the form of ids and ranges ("8", "1-8") is
/// never a name. `label` begins every message; after a fault the list is empty or lacks what is wrong.
std::vector<TableKey> parse_object_keys(const Node& node, const std::string& label, Diagnostics& diagnostics);
/// Only an id. `node` is where a fault is reported.
std::vector<TableKey> object_id_key(std::int64_t id, const Node& node, const std::string& label,
                                    Diagnostics& diagnostics);
/// Only ids and ranges of ids: "3-7,9".
std::vector<TableKey> object_range_keys(std::string_view text, const Node& node, const std::string& label,
                                        Diagnostics& diagnostics);

/// As a document writes one entry: 3, "3-7,9", "Wheel" with its quotation marks.
std::string format_object_keys(std::span<const TableKey> keys);
/// For messages: "object 3", "objects 3-7", "'Wheel'".
std::string object_text(const TableKey& key);

}  // namespace aftershade
