// Manifests with one fault each, and what is said of it.
#pragma once

#include <algorithm>

#include "tests/effect/effect_folder.h"

namespace aftershade::test {

struct BrokenSection {
    int section;  ///< and so the line
    std::string text;
    Lines messages;
};

/// Exactly these messages, in any order.
inline void expect_faults(Sections sections, Lines messages) {
    std::string text;
    for (const auto& [section, part] : sections) text += part + "\n";
    Lines lines = faults_of_manifest(demo_manifest(std::move(sections)));
    std::sort(lines.begin(), lines.end());
    std::sort(messages.begin(), messages.end());
    EXPECT_EQ(lines, messages) << text;
}

}  // namespace aftershade::test
