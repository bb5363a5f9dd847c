// Groups of a manifest's entries, and `for`, which makes several of one. Internal to framework/effect.
#pragma once

#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/document/grammar.h"

namespace aftershade {

/// A section whose entries may stand in groups: an object of entries by name, or `passes`, a list.
struct GroupedSection {
    std::string name;   ///< "textures"; a group has its entries under the same key
    std::string thing;  ///< "texture"
    const grammar::Block& (*entry)();
    const grammar::Block& (*group)();  ///< a group; and an entry inside one or with `for`: no key is required
};
const std::vector<GroupedSection>& grouped_sections();
/// The form of the section: with groups in schemas and tables; for a check, as without_groups() leaves it.
grammar::Form section_form(const std::string& name, const std::string& fault_of_none = "");

/// Most values of a variable; most entries of groups in a document, and most bytes of them.
inline constexpr int kMaxTurns = 256;
inline constexpr int kMaxGroupedEntries = 1024;
inline constexpr std::size_t kMaxGroupedBytes = std::size_t(4) << 20;

/// The document with every entry of a group by itself: with the keys that the group gives it, once for each
/// turn of each `for`, and values in the place of variables. A pass that is a name alone becomes an
/// object. An entry with an error, which is reported, is left out.
Node without_groups(Node document, Diagnostics& diagnostics);

}  // namespace aftershade
