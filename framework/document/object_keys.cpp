#include "framework/document/object_keys.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "framework/base/text.h"

namespace aftershade {

namespace {

bool is_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::optional<std::uint32_t> parse_id(std::string_view text) {
    std::uint32_t id = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return id;
}

struct Ends {
    std::string_view first, last;
};

/// Of "3-7" or "9", whatever stands on the two sides of the dash.
Ends ends_of(std::string_view piece) {
    const std::size_t dash = piece.find('-');
    const std::string_view first = trimmed(piece.substr(0, dash));
    return {first, dash == std::string_view::npos ? first : trimmed(piece.substr(dash + 1))};
}

bool has_form_of_ranges(std::string_view text) {
    return std::ranges::all_of(split(text, ','), [](std::string_view piece) {
        const Ends ends = ends_of(piece);
        return is_digits(ends.first) && is_digits(ends.last);
    });
}

/// nullopt where it is no range, or falls.
std::optional<TableKey> parse_range(std::string_view piece) {
    const Ends ends = ends_of(piece);
    const auto first = parse_id(ends.first), last = parse_id(ends.last);
    if (!first || !last || *last < *first) return std::nullopt;
    return TableKey{*first, *last, ""};
}

}  // namespace

std::vector<TableKey> parse_object_keys(const Node& node, const std::string& label,
                                        Diagnostics& diagnostics) {
    if (node.kind == Node::Kind::integer) return object_id_key(node.integer, node, label, diagnostics);
    if (!node.is_string() || node.string.empty()) {
        diagnostics.error(node.place,
                          label + ": expected an object's id, a range of ids such as \"3-7\" or a name");
        return {};
    }
    if (has_form_of_ranges(node.string)) return object_range_keys(node.string, node, label, diagnostics);
    return {TableKey{0, 0, node.string}};
}

std::vector<TableKey> object_id_key(std::int64_t id, const Node& node, const std::string& label,
                                    Diagnostics& diagnostics) {
    if (id >= 0 && id <= std::int64_t(UINT32_MAX))
        return {TableKey{std::uint32_t(id), std::uint32_t(id), ""}};
    diagnostics.error(node.place, label + ": " + std::to_string(id) +
                                      " is not an object's id, a number from 0 to 4294967295");
    return {};
}

std::vector<TableKey> object_range_keys(std::string_view text, const Node& node, const std::string& label,
                                        Diagnostics& diagnostics) {
    std::vector<TableKey> keys;
    for (const std::string_view piece : split(text, ',')) {
        if (const auto range = parse_range(piece)) keys.push_back(*range);
        else
            diagnostics.error(node.place, label + ": '" + std::string(trimmed(piece)) +
                                              "' is not a range of ids; write \"3-7,9\", each from 0 to "
                                              "4294967295 and rising");
    }
    return keys;
}

std::string format_object_keys(std::span<const TableKey> keys) {
    if (keys.size() == 1 && !keys[0].name.empty()) return json_string(keys[0].name);
    std::vector<std::string> pieces;
    for (const TableKey& key : keys)
        pieces.push_back(std::to_string(key.first) +
                         (key.first == key.last ? "" : "-" + std::to_string(key.last)));
    const bool is_id = keys.size() == 1 && keys[0].first == keys[0].last;
    return is_id ? pieces[0] : json_string(joined(pieces, ",", ","));
}

std::string object_text(const TableKey& key) {
    if (!key.name.empty()) return "'" + key.name + "'";
    if (key.first == key.last) return "object " + std::to_string(key.first);
    return "objects " + std::to_string(key.first) + "-" + std::to_string(key.last);
}

}  // namespace aftershade
