// Tables of declared keys in Markdown, and the pages that show them.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "framework/document/grammar.h"

namespace aftershade::grammar {

/// The keys of one block, those of all its kinds too; an empty column is left out. The text of its rules
/// follows. Ends in a line break; "" for a block without keys.
std::string table_of(const Block& block);
/// A table of the keys of one kind of the block alone.
std::string table_of_kind(const Block& kind);
/// The document and everything that it refers to, a section for each block: heading, what it is, table.
std::string reference_of(const Block& document);

/// Tables by name: "golden.case".
using Tables = std::map<std::string, std::string>;
/// The table of every block that the documents refer to, as "<document>.<block>". A block that two documents
/// share has one table, under the first one's name.
Tables tables_of(const std::vector<std::pair<std::string, const Block*>>& documents);

/// The page with its marked regions written again:
///
///     <!-- made by aftershade docs: golden.case -->
///     ...
///     <!-- end -->
///
/// `faults` has a line for each region that no table has the name of, or that does not end.
std::string with_tables(const std::string& page, const Tables& tables, std::vector<std::string>& faults);

/// Whether a region of the page is the table's.
bool shows_table(const std::string& page, const std::string& table);

}  // namespace aftershade::grammar
