// Documents from text, and their faults as the lines that a user reads.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"

namespace aftershade::test {

using Lines = std::vector<std::string>;

/// As print() writes them, one string for each.
inline Lines lines_of(const Diagnostics& diagnostics) {
    std::ostringstream text;
    diagnostics.print(text);
    std::istringstream in(text.str());
    Lines lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// The tree of a text that has no faults; the test fails where it has some.
inline Node parsed(const std::string& text) {
    Diagnostics diagnostics;
    std::optional<Node> node = parse_document(text, "doc.json", diagnostics);
    EXPECT_EQ(lines_of(diagnostics), Lines{}) << text;
    return node ? std::move(*node) : Node{};
}

/// What `read(node, diagnostics)` says of a text, which must parse.
template <class Read>
Lines faults_of(const std::string& text, Read&& read) {
    const Node node = parsed(text);
    Diagnostics diagnostics;
    read(node, diagnostics);
    return lines_of(diagnostics);
}

}  // namespace aftershade::test
