#include "framework/document/grammar_table.h"

#include <algorithm>
#include <array>
#include <set>

#include "framework/document/grammar_form.h"

namespace aftershade::grammar {

namespace {

constexpr std::string_view kBegin = "<!-- made by aftershade docs: ";
constexpr std::string_view kBeginEnd = " -->";
constexpr std::string_view kEnd = "<!-- end -->";

constexpr std::size_t kColumns = 8;
using Row = std::array<std::string, kColumns>;
const Row kHeads = {"key", "of", "type", "unit", "range", "default", "animated", ""};
constexpr std::size_t kOf = 1;

/// As a cell of a table.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
    return result;
}

std::string default_of(const Key& key) {
    if (key.required) return "required";
    if (key.default_value && key.default_value->is_string()) return key.default_value->string;
    return key.default_text;
}

Row row_of(const Key& key, const std::string& of) {
    const Words words = key.form.type().words();
    return {"`" + key.name + "`", key.of.empty() ? of : key.of, words.type, words.unit, words.range,
            default_of(key),      words.animated ? "yes" : "",  key.doc};
}

/// One row for what several kinds have alike.
void add_row(std::vector<Row>& rows, const Row& row) {
    for (Row& other : rows) {
        Row same = other;
        same[kOf] = row[kOf];
        if (same != row) continue;
        if (!row[kOf].empty() && other[kOf] != row[kOf]) other[kOf] += ", " + row[kOf];
        return;
    }
    rows.push_back(row);
}

std::string table(const std::vector<Row>& rows) {
    if (rows.empty()) return "";
    std::string head = "|", line = "|", body;
    std::array<bool, kColumns> used{};
    for (std::size_t c = 0; c < kColumns; ++c) {
        used[c] = std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return !row[c].empty(); });
        if (!used[c]) continue;
        head += kHeads[c].empty() ? " |" : " " + kHeads[c] + " |";
        line += "---|";
    }
    for (const Row& row : rows) {
        body += "|";
        for (std::size_t c = 0; c < kColumns; ++c)
            if (used[c]) body += row[c].empty() ? "  |" : " " + escaped(row[c]) + " |";
        body += "\n";
    }
    return head + "\n" + line + "\n" + body;
}

std::string sentences_of(const std::vector<Rule>& rules) {
    std::string text;
    for (const Rule& rule : rules)
        if (const std::string sentence = rule.type().sentence(); !sentence.empty())
            text += (text.empty() ? "" : " ") + sentence;
    return text.empty() ? "" : "\n" + text + "\n";
}

std::vector<Row> own_rows(const Block& block) {
    std::vector<Row> rows;
    if (block.is_document)
        for (const Key& key : head_keys()) rows.push_back(row_of(key, ""));
    if (!block.selector.empty()) rows.push_back(row_of(selector_key(block), ""));
    for (const Key& key : block.keys)
        if (key.has_row) add_row(rows, row_of(key, ""));
    return rows;
}

void add_section(const std::string& heading, const std::string& doc, const std::string& table_text,
                 std::string& out) {
    out += "\n" + heading + "\n\n" + doc + "\n";
    if (!table_text.empty()) out += "\n" + table_text;
}

}  // namespace

std::string table_of(const Block& block) {
    std::vector<Row> rows = own_rows(block);
    for (const Block& kind : block.kinds)
        for (const Key& key : kind.keys) add_row(rows, row_of(key, kind.name));
    return table(rows) + sentences_of(block.rules);
}

std::string table_of_kind(const Block& kind) {
    std::vector<Row> rows;
    for (const Key& key : kind.keys) rows.push_back(row_of(key, ""));
    return table(rows) + sentences_of(kind.rules);
}

std::string reference_of(const Block& document) {
    std::string out;
    for (const Block* block : blocks_of(document)) {
        add_section("## " + block->name, block->doc, table(own_rows(*block)) + sentences_of(block->rules),
                    out);
        for (const Block& kind : block->kinds)
            add_section("### " + block->selector + " \"" + kind.name + "\"", kind.doc, table_of_kind(kind),
                        out);
    }
    return out;
}

Tables tables_of(const std::vector<std::pair<std::string, const Block*>>& documents) {
    Tables tables;
    std::set<const Block*> seen;
    for (const auto& [document, block] : documents)
        for (const Block* one : blocks_of(*block))
            if (seen.insert(one).second) tables[document + "." + one->name] = table_of(*one);
    return tables;
}

std::string with_tables(const std::string& page, const Tables& tables, std::vector<std::string>& faults) {
    std::string result;
    std::size_t at = 0;
    for (std::size_t begin; (begin = page.find(kBegin, at)) != std::string::npos;) {
        const std::size_t name = begin + kBegin.size();
        const std::size_t name_end = page.find(kBeginEnd, name);
        const std::size_t end = page.find(kEnd, name);
        if (name_end == std::string::npos || end == std::string::npos || page.find(kBegin, name) < end) {
            faults.push_back("a region begins that does not end in '" + std::string(kEnd) + "'");
            break;
        }
        const std::string wanted = page.substr(name, name_end - name);
        result += page.substr(at, name_end + kBeginEnd.size() - at) + "\n";
        at = end;
        if (const auto found = tables.find(wanted); found != tables.end()) {
            result += found->second;
            continue;
        }
        std::vector<std::string> known;
        for (const auto& [one, text] : tables) known.push_back(one);
        faults.push_back("no table is named '" + wanted + "'" + did_you_mean(wanted, known));
    }
    return result + page.substr(at);
}

bool shows_table(const std::string& page, const std::string& table) {
    return page.find(std::string(kBegin) + table + std::string(kBeginEnd)) != std::string::npos;
}

}  // namespace aftershade::grammar
